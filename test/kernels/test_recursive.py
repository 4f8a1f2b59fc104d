"""The recursion is the textbook: element by element, compiled and interpreted."""

import os
import subprocess
import sys

from dynamics_node import RobotModel
from dynamics_node.kernels import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.comparison import assert_terms_agree
from support.robots import random_state, random_urdf

RELATIVE = 1e-12


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_the_recursion_agrees_with_the_textbook_on_random_trees(seed):
    model = RobotModel.from_urdf(random_urdf(seed))
    q, qd = random_state(np.random.default_rng(seed), model)
    expected = (
        textbook.mass_matrix(model.tree, q),
        textbook.coriolis_matrix(model.tree, q, qd),
        textbook.gravity_torque(model.tree, q, model.gravity),
    )
    assert_terms_agree(model, qd, model.dynamics(q, qd), expected, RELATIVE)
    assert model.potential_energy(q) == pytest.approx(
        textbook.potential_energy(model.tree, q, model.gravity), rel=RELATIVE, abs=1e-11
    )


@pytest.mark.parametrize('seed', range(5))
def test_the_single_kernels_agree_with_the_combined_one(seed):
    model = RobotModel.from_urdf(random_urdf(seed))
    q, qd = random_state(np.random.default_rng(seed), model)
    D, C, G = model.dynamics(q, qd)
    np.testing.assert_array_equal(model.mass_matrix(q), D)
    np.testing.assert_array_equal(model.coriolis_matrix(q, qd), C)
    np.testing.assert_array_equal(model.gravity_torque(q), G)
    np.testing.assert_array_equal(D, D.T)


INTERPRETED = """
import sys
import numpy as np
from support.comparison import assert_terms_agree
from support.robots import random_state, random_urdf
from dynamics_node import RobotModel
for seed in range(4):
    model = RobotModel.from_urdf(random_urdf(seed))
    q, qd = random_state(np.random.default_rng(seed), model)
    D, C, G = model.dynamics(q, qd)
    np.savetxt(sys.stdout, np.concatenate([D.ravel(), C.ravel(), G]), fmt='%.17g')
"""


def test_interpreted_kernels_give_the_same_numbers_as_compiled_ones():
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    answers = []
    for disable in ('0', '1'):
        environment['NUMBA_DISABLE_JIT'] = disable
        run = subprocess.run(
            [sys.executable, '-c', INTERPRETED],
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        answers.append(np.array(run.stdout.split(), dtype=float))
    # Compiled code may fuse a multiplication and an addition, so the last bits may differ.
    np.testing.assert_allclose(
        answers[0], answers[1], rtol=0, atol=1e-13 * np.abs(answers[1]).max()
    )
