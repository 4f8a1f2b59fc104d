"""D, C and G element by element against Pinocchio: public robots and random trees."""

from dynamics_node import RobotModel
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.comparison import assert_terms_agree
from support.pinocchio_oracle import PinocchioOracle
from support.robots import PUBLIC, public_robot, random_state, random_urdf

RELATIVE = 1e-11


def assert_agrees(model, oracle, q, qd):
    """Compare D, C, G and the energies at one state; return the pairs compared."""
    actual = model.dynamics(q, qd)
    expected = oracle.dynamics(model.joint_names, q, qd)
    assert_terms_agree(model, qd, actual, expected, RELATIVE)
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


@settings(deadline=None)
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


@pytest.mark.parametrize('distance', [1.0, 100.0, 10_000.0])
@pytest.mark.parametrize('carrier', ['fixed', 'continuous'])
def test_a_light_finger_far_from_the_base_keeps_its_digits(distance, carrier):
    # Twenty grams at the end of a long way: the moments about the base are 1e8 times larger.
    inertial = ('<inertial><origin xyz="0.01 0.02 0.03"/><mass value="0.02"/><inertia ixx="1e-6" '
                'ixy="1e-8" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial>')
    text = ('<robot name="far"><link name="world"/>'
            f'<link name="arm"/><joint name="way" type="{carrier}"><parent link="world"/>'
            '<child link="arm"/><axis xyz="0 1 0"/></joint>'
            f'<link name="a">{inertial}</link><joint name="j" type="continuous">'
            f'<parent link="arm"/><child link="a"/><origin xyz="{distance} 2 3" rpy="1 2 3"/>'
            '<axis xyz="0 0 1"/></joint>'
            f'<link name="b">{inertial}</link><joint name="k" type="continuous">'
            '<parent link="a"/><child link="b"/><origin xyz="0.05 0 0" rpy="0 1 0"/>'
            '<axis xyz="1 0 0"/></joint></robot>')
    model = RobotModel.from_urdf(text)
    q, qd = random_state(np.random.default_rng(1), model)
    assert_agrees(model, PinocchioOracle(text), q, qd)
