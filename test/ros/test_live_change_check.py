"""Accepted and refused changes of parameters while the output is on."""

from dynamics_node import RobotModel
from dynamics_node.errors import ParameterError
from dynamics_node.ros.parameters.live_change_check import check_change
from dynamics_node.ros.parameters.model_settings import configured
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.safety import GravityChange
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM

NO_LIMIT = PENDULUM.read_text().replace('effort="20"', '')
N = 8
DOWN = (0.0, 0.0, -9.81)
Q = [0.02, 0.8, 0.02, 0.8, 0.02, 0.02, 0.02, 0.01]


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


def test_the_payload_above_reverses_the_torque():
    model = RobotModel.from_urdf(ARM7)
    G = [
        model.with_payload('hand', 500.0, com).gravity_torque(Q)[1]
        for com in ((0.03, 0.0, 0.0), (0.0, 0.0, -3.0))
    ]
    assert G[0] < -90.0 and G[1] > 90.0


def test_a_torque_of_nan_is_above_every_limit():
    robot, values = ActiveRobot(RobotModel.from_urdf(ARM7), ()), check_all({})
    robot.buffer.update(0.0, list(robot.joint_names), Q)
    with np.errstate(over='ignore'):
        heavy = robot.model.with_payload('hand', 1e308, (0.0, 0.0, 0.06))
    with pytest.raises(ParameterError, match=r'above the limit: .*shoulder_pitch: nan'):
        check_change(robot, heavy, values, values, GravityChange(), 0.0)
