"""D, C and G element by element against Pinocchio: another gravity, and links far away."""

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.comparison import assert_terms_agree
from support.pinocchio_oracle import PinocchioOracle
from support.robots import public_robot, random_state, random_urdf

RELATIVE = 1e-11


def assert_agrees(model, oracle, q, qd):
    """Compare D, C, G and the energies at one state."""
    actual = model.dynamics(q, qd)
    expected = oracle.dynamics(model.joint_names, q, qd)
    assert_terms_agree(model, qd, actual, expected, RELATIVE)
    T0, V0 = oracle.energies(model.joint_names, q, qd)
    assert model.kinetic_energy(q, qd) == pytest.approx(T0, rel=RELATIVE)
    weight = model.moving_mass * np.linalg.norm(model.gravity)
    assert model.potential_energy(q) == pytest.approx(V0, rel=RELATIVE, abs=1e-12 * weight)


def test_another_gravity_is_the_same_for_both():
    text = random_urdf(11)
    gravity = (1.0, -9.0, 3.0)
    model = RobotModel.from_urdf(text, gravity)
    oracle = PinocchioOracle(text, gravity)
    assert_agrees(model, oracle, *random_state(np.random.default_rng(3), model))


# Light links far from the base. Moments about the base are up to 1e8 times larger than their own
# inertia there, and Pinocchio's Coriolis matrix, which it sums in the base frame, loses as many
# digits (docs/accuracy.md holds both against 80-bit arithmetic). So D and G are compared with
# Pinocchio, and C with the same robot near the base.

FINGER = (
    '<inertial><origin xyz="0.01 0.02 0.03"/><mass value="0.02"/><inertia ixx="1e-6" '
    'ixy="1e-8" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial>'
)


def fingers(distance, carrier):
    """Return two light links on an arm without mass, some way from the base."""
    return (
        f'<robot name="far"><link name="world"/><link name="arm"/><joint name="way" '
        f'type="{carrier}"><parent link="world"/><child link="arm"/><axis xyz="0 1 0"/>'
        f'</joint><link name="a">{FINGER}</link><joint name="j" type="continuous">'
        f'<parent link="arm"/><child link="a"/><origin xyz="{distance} 2 3" rpy="1 2 3"/>'
        f'<axis xyz="0 0 1"/></joint><link name="b">{FINGER}</link><joint name="k" '
        'type="continuous"><parent link="a"/><child link="b"/>'
        '<origin xyz="0.05 0 0" rpy="0 1 0"/><axis xyz="1 0 0"/></joint></robot>'
    )


def assert_d_and_g_agree(text):
    """Compare D and G with Pinocchio at one state."""
    model = RobotModel.from_urdf(text)
    q, qd = random_state(np.random.default_rng(1), model)
    D, C, G = model.dynamics(q, qd)
    D0, _, G0 = PinocchioOracle(text).dynamics(model.joint_names, q, qd)
    assert_terms_agree(model, qd, (D, C, G), (D0, C, G0), RELATIVE)


@pytest.mark.parametrize('carrier', ['fixed', 'continuous'])
@pytest.mark.parametrize('distance', [1.0, 100.0, 10_000.0])
def test_a_light_finger_far_from_the_base_keeps_its_digits(distance, carrier):
    assert_d_and_g_agree(fingers(distance, carrier))


def test_the_wrist_of_tiago_keeps_its_digits():
    assert_d_and_g_agree(public_robot('tiago_description/robots/tiago_no_hand.urdf').read_text())


@pytest.mark.parametrize('distance', [100.0, 10_000.0])
def test_a_base_far_away_changes_neither_d_nor_c_nor_g(distance):
    near = RobotModel.from_urdf(fingers(0.0, 'fixed'))
    far = RobotModel.from_urdf(fingers(distance, 'fixed'))
    q, qd = random_state(np.random.default_rng(1), near)
    for expected, actual in zip(near.dynamics(q, qd), far.dynamics(q, qd), strict=True):
        np.testing.assert_array_equal(actual, expected)
