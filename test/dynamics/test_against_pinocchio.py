"""D, C and G element by element against Pinocchio: public robots and random trees."""

from dynamics_node import RobotModel
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.pinocchio_oracle import PinocchioOracle
from support.robots import PUBLIC, public_robot, random_state, random_urdf

RELATIVE = 1e-11
# Where a sum cancels, an element can be arbitrarily smaller than its summands, and then its
# relative error says nothing; such an element is held to this part of the natural scale of
# its place instead (see `natural_scales`).
ROUNDING = 1e-12


def assert_elements(name, actual, expected, scale):
    """Hold every element to 1e-11 of itself, or to rounding of what it was summed from."""
    error = np.abs(actual - expected)
    allowed = np.maximum(RELATIVE * np.abs(expected), ROUNDING * scale)
    worst = np.unravel_index(np.argmax(error - allowed), error.shape)
    assert (error <= allowed).all(), (
        f'{name}{list(map(int, worst))}: {actual[worst]!r}, Pinocchio {expected[worst]!r}')


def natural_scales(model, D, qd):
    """
    Return what the elements of D, C and G are summed from, by Cauchy and Schwarz.

    |D_ij| <= sqrt(D_ii D_jj), and |G_i| <= |g| sqrt(m D_ii) with the moving mass m; C is of
    the size of D times a speed.

    """
    diagonal = np.sqrt(np.maximum(np.diag(D), 0.0))
    scale = np.outer(diagonal, diagonal)
    return (scale, scale * np.abs(qd).max(),
            np.linalg.norm(model.gravity) * np.sqrt(model.total_mass) * diagonal)


def assert_agrees(model, oracle, q, qd):
    """Compare D, C, G and the energies at one state; return the pairs compared."""
    actual = model.dynamics(q, qd)
    expected = oracle.dynamics(model.joint_names, q, qd)
    scales = natural_scales(model, expected[0], qd)
    for name, mine, theirs, scale in zip('DCG', actual, expected, scales, strict=True):
        assert_elements(name, mine, theirs, scale)
    T0, V0 = oracle.energies(model.joint_names, q, qd)
    assert model.kinetic_energy(q, qd) == pytest.approx(T0, rel=RELATIVE)
    weight = model.total_mass * np.linalg.norm(model.gravity)
    assert model.potential_energy(q) == pytest.approx(V0, rel=RELATIVE, abs=1e-12 * weight)
    return zip(actual, expected, strict=True)


@pytest.mark.parametrize('name', PUBLIC)
def test_public_robots(name):
    path = public_robot(name)
    model = RobotModel.from_urdf(path)
    oracle = PinocchioOracle(path.read_text())
    rng = np.random.default_rng(len(name))
    for _ in range(20):
        for actual, expected in assert_agrees(model, oracle, *random_state(rng, model)):
            assert np.abs(actual - expected).max() <= RELATIVE * np.abs(expected).max()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_random_trees(seed):
    text = random_urdf(seed)
    model = RobotModel.from_urdf(text)
    assert_agrees(model, PinocchioOracle(text), *random_state(np.random.default_rng(seed), model))


def test_another_gravity_is_the_same_for_both():
    text = random_urdf(11)
    gravity = (1.0, -9.0, 3.0)
    model = RobotModel.from_urdf(text, gravity)
    oracle = PinocchioOracle(text, gravity)
    assert_agrees(model, oracle, *random_state(np.random.default_rng(3), model))
