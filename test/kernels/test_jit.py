"""The compiler: its absence changes no result, and after the warm-up it is not called."""

import os
from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = 10

# Comparisons of two routes on random trees.
TESTS = (
    'test/dynamics/test_identities.py',
    'test/dynamics/test_random_trees.py',
    'test/kernels/test_recursive.py',
    'test/test_pendulum.py',
)

IS_INTERPRETED = """
from dynamics_node.kernels import recursive
from numba.core.dispatcher import Dispatcher
kernels = (recursive.dynamics, recursive.mass_matrix, recursive.gravity_torque)
print([isinstance(kernel, Dispatcher) for kernel in kernels])
"""


@pytest.fixture
def interpreted():
    """Return an environment in which nothing is compiled."""
    return dict(
        os.environ,
        NUMBA_DISABLE_JIT='1',
        HYPOTHESIS_EXAMPLES=str(EXAMPLES),
        PYTHONPATH=os.pathsep.join(filter(None, sys.path)),
    )


def test_the_compiler_can_be_left_out(interpreted):
    for environment, compiled in ((os.environ, True), (interpreted, False)):
        environment = dict(environment, PYTHONPATH=interpreted['PYTHONPATH'])
        run = subprocess.run(
            [sys.executable, '-c', IS_INTERPRETED],
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        assert run.stdout.strip() == str([compiled] * 3)


@pytest.mark.timeout(600)
def test_every_identity_holds_interpreted(interpreted):
    run = subprocess.run(
        [
            sys.executable,
            '-m',
            'pytest',
            '-q',
            '-p',
            'no:cacheprovider',
            *TESTS,
            '-k',
            'not interpreted',
        ],
        cwd=ROOT,
        env=interpreted,
        check=False,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout[-5000:] + run.stderr[-1000:]
    assert 'skipped' not in run.stdout


ALL_QUANTITIES = """
import numpy as np
from dynamics_node import RobotModel, complete_trajectory
from dynamics_node.kernels import recursive, warm_up

def compiled():
    return {name: len(kernel.signatures) for name, kernel in vars(recursive).items()
            if hasattr(kernel, 'signatures')}

warm_up.warm_up()
before = compiled()
assert before['dynamics'] == before['gravity_torque'] == before['body_poses'] == 1, before
robot = RobotModel.from_urdf('config/robots/arm7.urdf')
robot.specialize(with_payload_code=True)
zeros = np.zeros(8)
zeros.flags.writeable = False
many = np.broadcast_to(zeros, (5, 8))
for model in (robot, robot.with_payload('hand', 1.0).with_rotor_inertia(0.1),
              robot.with_gravity((0.0, 9.81, 0.0))):
    for q in (zeros, many, np.zeros((8, 5)).T, [0] * 8, np.zeros(8, dtype=np.float32)):
        model.dynamics(q, q)
        model.mass_matrix(q)
        model.coriolis_matrix(q, q)
        model.gravity_torque(q)
        model.inverse_dynamics(q, q, q)
        model.forward_dynamics(q, q, q)
        model.kinetic_energy(q, q)
        model.potential_energy(q)
        model.jacobian(q, 'hand')
        model.link_pose(q, 'hand')
        model.body_poses(q)
        model.max_payload(q, 'hand')
model.trajectory_effort([0.0, 1.0, 2.0], np.zeros((3, 8)))
after = compiled()
assert after == before, {name: (before[name], count) for name, count in after.items()
                         if count != before[name]}
"""


def test_after_the_warm_up_no_kernel_is_compiled():
    # A second array type would take half a minute, in which the process seems to hang.
    run = subprocess.run(
        [sys.executable, '-c', ALL_QUANTITIES],
        cwd=ROOT,
        text=True,
        capture_output=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
