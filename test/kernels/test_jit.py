"""Without the compiler the kernels are the same Python: every identity holds there too."""

import os
from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = 10

# Everything about random trees that compares two routes.
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
