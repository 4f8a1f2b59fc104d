"""The robot in force: limits, measured states, and the model that the parameters describe."""

from dynamics_node import RobotModel
from dynamics_node.errors import ParameterError
from dynamics_node.ros.parameters.live_change_check import check_change
from dynamics_node.ros.parameters.model_settings import configured
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot, StateUnavailableError
from dynamics_node.safety import GravityChange
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM

TEXT = PENDULUM.read_text()
ARM = RobotModel.from_urdf(ARM7)
CHOSEN = tuple(ARM.joint_names[i] for i in (3, 1))
QD = np.linspace(2.0, -3.0, 8)
PAYLOAD = {'payload.link': 'hand', 'payload.mass': 2.0}
OTHERS = [0, 2, 4, 5, 6, 7]
NO_LIMIT = PENDULUM.read_text().replace('effort="20"', '')
N = 8
DOWN = (0.0, 0.0, -9.81)
Q = [0.02, 0.8, 0.02, 0.8, 0.02, 0.02, 0.02, 0.01]


def test_a_mass_matrix_that_is_not_positive_definite_is_noticed():
    assert ActiveRobot(RobotModel.from_urdf(TEXT), ()).is_mass_matrix_positive_definite()
    # A rod without mass, whose acceleration is undefined.
    massless = TEXT.replace('<mass value="3"/>', '<mass value="0"/>')
    for axis in ('ixx', 'iyy', 'izz'):
        start = massless.index(f'{axis}="') + len(axis) + 2
        massless = massless[:start] + '0' + massless[massless.index('"', start) :]
    robot = ActiveRobot(RobotModel.from_urdf(massless), ())
    assert robot.model.mass_matrix(np.zeros(1)) == [[0.0]]
    assert not robot.is_mass_matrix_positive_definite()


def test_joints_without_an_effort_limit_are_named_unless_one_is_given():
    robot = ActiveRobot(RobotModel.from_urdf(TEXT.replace('effort="20"', '')), ())
    assert robot.unlimited_joints(()) == ['hinge']
    assert robot.unlimited_joints((5.0,)) == []
    np.testing.assert_array_equal(robot.effort_limits((5.0,)), [5.0])


def test_joints_without_a_velocity_limit_are_named():
    assert ActiveRobot(RobotModel.from_urdf(TEXT), ()).joints_without_velocity_limit() == []
    slow = RobotModel.from_urdf(TEXT.replace('velocity="20"', 'velocity="0"'))
    assert ActiveRobot(slow, ()).joints_without_velocity_limit() == ['hinge']


def test_the_measured_position_is_refused_while_a_chosen_joint_is_not_fresh():
    model = RobotModel.from_urdf(ARM7)
    chosen = model.joint_names[2], model.joint_names[0]
    robot = ActiveRobot(model, chosen)
    robot.buffer.update(0.0, [chosen[0]], [0.25])
    with pytest.raises(StateUnavailableError, match=f'within 0.1 s for {chosen[1]}'):
        robot.measured_position(0.05, 0.1)
    robot.state_publishers = 2
    with pytest.raises(
        StateUnavailableError,
        match=(r'; 2 nodes publish joint_states: if .* set allow_several_state_publishers'),
    ):
        robot.measured_position(0.05, 0.1)
    robot.buffer.update(0.05, [chosen[1]], [0.5])
    q = robot.measured_position(0.05, 0.1)
    assert (q[2], q[0]) == (0.25, 0.5)
    np.testing.assert_array_equal(q[3:], model.neutral_position[3:])


@pytest.mark.filterwarnings('ignore:overflow')  # numbers that no payload has
def test_a_torque_that_is_not_finite_is_above_every_limit():
    robot, values = ActiveRobot(RobotModel.from_urdf(ARM7), ()), check_all({})
    robot.buffer.update(0.0, list(robot.joint_names), [0.02] * len(robot.joint_names))
    assert robot.over_limits(values) == ''
    heavy = robot.model.with_payload('hand', 1e308, (0.0, 0.0, 0.06))
    for before in (None, values):
        assert 'shoulder_pitch: nan, limit 90' in robot.over_limits(values, heavy, before)


# Parameters of the model -----------------------------------------------------------------------


def model_with(values):
    """Return the model of an arm with some parameters."""
    return configured(ActiveRobot(ARM, CHOSEN), check_all(values))


def test_the_defaults_are_the_robot_of_the_urdf():
    model = model_with({})
    assert np.array_equal(model.mass_matrix(Q), ARM.mass_matrix(Q))
    assert np.array_equal(model.friction_torque(QD), ARM.friction_torque(QD))
    assert model.payload is None


@pytest.mark.parametrize('name', ['viscous', 'coulomb', 'smoothing_velocity'])
def test_friction_changes_for_the_chosen_joints_only(name):
    changed = getattr(model_with({f'friction.{name}': [0.7, 0.2]}).friction, name)
    before = getattr(ARM.friction, name)
    assert changed[[3, 1]].tolist() == [0.7, 0.2]
    assert changed[OTHERS].tolist() == before[OTHERS].tolist()
    assert changed.tolist() != before.tolist()


def test_only_differences_are_applied():
    robot, before = ActiveRobot(ARM, ()), check_all(PAYLOAD)
    robot.configure(before)
    loaded = robot.model
    robot.configure({**before, 'state_timeout': 0.5}, before)
    assert robot.model is loaded
    robot.configure(check_all({}), before)
    assert robot.model.payload is None
    assert np.array_equal(robot.model.gravity_torque(Q), ARM.gravity_torque(Q))


# Changes while the output is on ----------------------------------------------------------------


def payload(mass, link='hand', com=(0.03, 0.0, 0.0)):
    """Return the parameters of a payload."""
    return {'payload.link': link, 'payload.mass': mass, 'payload.com': com}


def change(before, after, urdf=ARM7):
    """Check a change between two sets of parameters, each given by its differences to default."""
    robot = ActiveRobot(RobotModel.from_urdf(urdf), ())
    before = check_all(before)
    robot.configure(before)
    robot.buffer.update(0.0, list(robot.joint_names), Q[: len(robot.joint_names)])
    values = check_all(after)
    gravity = GravityChange()
    gravity.begin(0.0, before['gravity'])
    check_change(robot, configured(robot, values, before), values, before, gravity, 0.0)


LIMITS = {'effort_limits': [1.0] * N}
SCALED = {'effort_scale': [4.0] * N}


@pytest.mark.parametrize(
    'before, after',
    [
        ({}, payload(1.0)),
        (payload(1.0), {}),
        ({}, LIMITS),
        (payload(1.0), LIMITS | payload(1.0)),
        # A joint at its limit: the efforts still follow a tilting base, and less load.
        (payload(500.0), payload(499.0)),
        (payload(500.0), {}),
        (payload(500.0), payload(501.0)),
        ({}, {'gravity': (4.0, 0.0, -9.0)}),
        ({'gravity': (0.0,) * 3}, {'gravity': (0.0,) * 3}),
        ({}, {'effort_scale': [1.1] * N}),
        (SCALED, {}),
        ({}, {'effort_offset': [0.1] * N}),
        ({'effort_offset': [100.0] * N}, {}),
    ],
    ids=str,
)
def test_a_change_within_the_limits_is_accepted(before, after):
    change(before, after)


@pytest.mark.parametrize(
    'before, after, message',
    [
        ({}, payload(500.0), 'above the limit: shoulder_pitch'),
        # Another joint at its limit does not permit it.
        (
            {'effort_limits': [90.0] * 5 + [1e-3] + [90.0] * 2},
            {'effort_limits': [90.0] * 5 + [1e-3] + [90.0] * 2} | payload(500.0),
            'shoulder_pitch',
        ),
        # A reversal at the limit: the effort would go from one limit to the other.
        (
            payload(500.0),
            payload(500.0, com=(0.0, 0.0, -3.0)),
            'above the limit: shoulder_pitch: 109',
        ),
        ({}, SCALED, 'above the limit: shoulder_pitch'),
        ({}, {'effort_offset': [100.0] + [0.0] * (N - 1)}, 'above the limit: shoulder_yaw: 100'),
        ({}, {'gravity': (0.0, 0.0, 9.81)}, 'points up .* set allow_upward_gravity'),
        (
            {'allow_upward_gravity': True},
            {'allow_upward_gravity': True, 'gravity': (0.0, 0.0, 9.81)},
            'at most 30 degrees at once',
        ),
        ({}, {'effort_limits': [91.0] * N}, 'effort_limits of shoulder_yaw: 91, in the URDF 90'),
        ({}, {'gravity': (9.81, 0.0, 0.0)}, 'at most 30 degrees at once'),
        ({}, {'gravity': (0.0, 0.0, -15.0)}, 'at most 2 m/s'),
        ({}, {'gravity': (0.0, 0.0, 0.0)}, 'not zero while output is on'),
        ({'gravity': (0.0,) * 3}, {'gravity': DOWN}, 'not zero while output is on'),
    ],
    ids=str,
)
def test_a_change_that_would_throw_or_drop_the_arm_is_refused(before, after, message):
    with pytest.raises(ParameterError, match=message):
        change(before, after)


def test_a_joint_cannot_lose_its_limit():
    change({'effort_limits': [5.0]}, {'effort_limits': [4.0]}, NO_LIMIT)
    with pytest.raises(ParameterError, match='got none for hinge'):
        change({'effort_limits': [5.0]}, {}, NO_LIMIT)
