"""Random trees by four routes: ours, Pinocchio, MuJoCo and 80 bits; everything they can say."""

from dynamics_node import RobotModel
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.robots import random_urdf
from support.routes import QUANTITIES, Routes

# Pinocchio's own bound, and MuJoCo's: see support/sweep.py.
BOUNDS = {'exact': 1e-11, 'pinocchio': 1e-11, 'mujoco': 1e-9}


@pytest.mark.parametrize('options', [{}, {'prismatic': 1.0}, {'prismatic': 0.0}],
                         ids=['mixed', 'sliding', 'turning'])
@settings(deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_all_routes_agree_on_a_random_tree(options, seed):
    text = random_urdf(seed, **options)
    found = Routes(text, RobotModel.from_urdf(text)).compare(np.random.default_rng(seed))
    for judge, bound in BOUNDS.items():
        errors = found.errors['library', judge]
        assert set(errors) == set(QUANTITIES)
        assert {name: error for name, error in errors.items() if not error <= bound} == {}, judge
