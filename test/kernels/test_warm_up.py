"""After the warm-up nobody waits for a compiler, whatever is asked."""

from pathlib import Path
import subprocess
import sys

ROOT = Path(__file__).parents[2]
ALL_THAT_COMPUTES = """
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
still = np.zeros(8)
still.flags.writeable = False
many = np.broadcast_to(still, (5, 8))
for model in (robot, robot.with_payload('hand', 1.0).with_rotor_inertia(0.1),
              robot.with_gravity((0.0, 9.81, 0.0))):
    for q in (still, many, np.zeros((8, 5)).T, [0] * 8, np.zeros(8, dtype=np.float32)):
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


def test_nothing_is_compiled_for_a_second_type():
    # It would take half a minute, in which the process seems to hang.
    run = subprocess.run(
        [sys.executable, '-c', ALL_THAT_COMPUTES],
        cwd=ROOT,
        text=True,
        capture_output=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
