"""Random trees, all quantities: this library, Pinocchio, MuJoCo, 80-bit arithmetic."""

from dynamics_node import RobotModel
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from support.cross_library import QUANTITIES, Routes
from support.robots import random_urdf

# Pinocchio's own bound, and MuJoCo's: see support/sweep.py.
BOUNDS = {'exact': 1e-11, 'pinocchio': 1e-11, 'mujoco': 1e-9}


@settings(deadline=None)
@given(seed=st.integers(0, 2**32 - 1), prismatic=st.sampled_from([0.3, 0.0, 1.0]))
def test_all_routes_agree_on_a_random_tree(seed, prismatic):
    text = random_urdf(seed, prismatic=prismatic)
    result = Routes(text, RobotModel.from_urdf(text)).compare(np.random.default_rng(seed))
    for judge, bound in BOUNDS.items():
        errors = result.errors['library', judge]
        assert set(errors) == set(QUANTITIES)
        assert {name: error for name, error in errors.items() if not error <= bound} == {}, judge
