"""The robot in force: limits, measured states and refusals."""

from dynamics_node import RobotModel
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot, StateUnavailableError
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM

TEXT = PENDULUM.read_text()


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
