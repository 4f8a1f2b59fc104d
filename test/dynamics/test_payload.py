"""A payload on any link, against Pinocchio and MuJoCo with an additional link."""

from dynamics_node import ArgumentError, InertiaError, RobotModel
import numpy as np
import pytest
from support.comparison import assert_terms_agree
from support.mujoco_oracle import MujocoOracle
from support.pinocchio_oracle import PinocchioOracle
from support.random_payload import random_body, with_payload_link
from support.robots import ARM7, public_robot, random_state, random_urdf

RELATIVE = 1e-11


def assert_agrees(text, link, body, gravity, seed):
    """Compare D, C, G, inverse and forward dynamics with both judges at one state."""
    model = RobotModel.from_urdf(text, gravity).with_payload(link, *body)
    q, qd = random_state(np.random.default_rng(seed), model)
    qdd = np.random.default_rng(seed + 1).normal(size=q.size)
    loaded = with_payload_link(text, link, *body)
    for judge in (PinocchioOracle(loaded, gravity), MujocoOracle(loaded, gravity)):
        expected = judge.dynamics(model.joint_names, q, qd)
        assert_terms_agree(model, qd, model.dynamics(q, qd), expected, RELATIVE)
        effort = judge.inverse_dynamics(model.joint_names, q, qd, qdd)
        tolerance = RELATIVE * np.abs(effort).max()
        assert model.inverse_dynamics(q, qd, qdd) == pytest.approx(effort, abs=tolerance)


@pytest.mark.parametrize('seed', range(8))
def test_a_payload_on_a_random_link_of_random_trees(seed):
    rng = np.random.default_rng(100 + seed)
    text = random_urdf(seed)
    links = RobotModel.from_urdf(text).link_names
    link = links[int(rng.integers(len(links)))]
    assert_agrees(text, link, random_body(rng), rng.normal(0.0, 6.0, 3), seed)


@pytest.mark.parametrize(
    ('name', 'link'),
    [
        ('panda_description/urdf/panda.urdf', 'panda_hand'),
        ('ur_description/urdf/ur5_robot.urdf', 'tool0'),
        ('kinova_description/robots/kinova.urdf', 'j2s6s200_link_finger_1'),
    ],
)
def test_a_payload_at_the_tool_of_public_robots(name, link):
    body = random_body(np.random.default_rng(1))
    # On the ceiling, a little askew.
    assert_agrees(public_robot(name).read_text(), link, body, (0.5, 1.0, 9.7), 3)


def test_a_mass_on_a_lever_adds_the_textbook_torque():
    text = (
        '<robot name="r"><link name="world"/><link name="arm"/><joint name="j" '
        'type="continuous"><parent link="world"/><child link="arm"/><axis xyz="0 -1 0"/>'
        '</joint></robot>'
    )
    robot = RobotModel.from_urdf(text).with_payload('arm', 2.0, (0.5, 0.0, 0.0))
    for q in (0.0, 0.4, 2.0):
        assert robot.gravity_torque([q])[0] == pytest.approx(2.0 * 9.81 * 0.5 * np.cos(q))
        assert robot.mass_matrix([q])[0, 0] == pytest.approx(2.0 * 0.25)
    # On the wall, x downwards.
    on_wall = robot.with_gravity((9.81, 0.0, 0.0))
    assert on_wall.gravity_torque([0.4])[0] == pytest.approx(2.0 * 9.81 * 0.5 * np.sin(0.4))
    assert on_wall.payload is robot.payload


def test_a_payload_of_zero_mass_changes_no_bit():
    robot = RobotModel.from_urdf(ARM7)
    link, states = 'hand', np.random.default_rng(1).uniform(-2.0, 2.0, (50, 8))
    before = robot.dynamics(states, states)
    loaded = robot.with_payload(link, 3.0, (0.01, 0.02, 0.1))
    removed = loaded.with_payload(link, 0.0)
    assert removed.payload is None
    for old, new, other in zip(
        before, removed.dynamics(states, states), loaded.dynamics(states, states), strict=True
    ):
        assert np.array_equal(old, new)
        assert not np.array_equal(old, other)


def test_a_second_payload_replaces_the_first():
    robot = RobotModel.from_urdf(ARM7)
    q = np.linspace(-1.0, 1.0, 8)
    moved = robot.with_payload('hand', 3.0).with_payload('forearm', 1.0, (0.0, 0.1, 0.0))
    expected = robot.with_payload('forearm', 1.0, (0.0, 0.1, 0.0))
    assert np.array_equal(moved.gravity_torque(q), expected.gravity_torque(q))
    assert moved.payload.link == 'forearm'
    assert moved.moving_mass == pytest.approx(robot.moving_mass + 1.0)


def test_a_payload_on_the_base_has_no_effect():
    robot = RobotModel.from_urdf(ARM7)
    loaded = robot.with_payload(robot.tree.root, 5.0)
    q = np.linspace(-1.0, 1.0, 8)
    assert np.array_equal(loaded.gravity_torque(q), robot.gravity_torque(q))
    assert loaded.payload.mass == 5.0


def test_a_physically_impossible_payload_is_refused():
    robot = RobotModel.from_urdf(ARM7)
    with pytest.raises(InertiaError, match='mass is -1 kg'):
        robot.with_payload('hand', -1.0)
    with pytest.raises(InertiaError, match='triangle inequality'):
        robot.with_payload('hand', 1.0, inertia=np.diag([0.1, 0.1, 0.5]))
    with pytest.raises(InertiaError, match='smallest principal moment'):
        robot.with_payload('hand', 1.0, inertia=np.diag([0.1, 0.1, -0.1]))
    with pytest.raises(InertiaError, match='not symmetric'):
        robot.with_payload('hand', 1.0, inertia=np.eye(3) + np.triu(np.ones((3, 3)), 1))


@pytest.mark.parametrize(
    ('arguments', 'message'),
    [
        (('gripper', 1.0), "link: 'gripper' is not a link of the robot; expected one of .*hand"),
        (('hand', 'heavy'), 'payload mass: expected a number'),
        (('hand', np.nan), 'payload mass: expected a finite number'),
        (('hand', 1.0, (0.0, 0.0)), r'payload com: expected finite numbers of shape \(3,\)'),
        (('hand', 1.0, (0.0, 0.0, np.inf)), 'payload com'),
        (('hand', 1.0, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), r'payload inertia: .* \(3, 3\)'),
    ],
)
def test_wrong_arguments_are_refused_with_a_message(arguments, message):
    with pytest.raises(ArgumentError, match=message):
        RobotModel.from_urdf(ARM7).with_payload(*arguments)


def test_an_overflowing_center_of_mass_is_refused_with_a_reason():
    # Warnings are errors here: numpy must not warn of the overflow.
    with pytest.raises(ArgumentError, match=r'finite second moments, .*1e\+200'):
        RobotModel.from_urdf(ARM7).with_payload('hand', 1.0, (1e200, 0.0, 0.0))
