"""The terms of the command, each on or off: in one process, and over DDS while output is on."""

import types

from dynamics_node import RobotModel
from dynamics_node.ros.compensation import Compensation
from dynamics_node.ros.parameter_table import check_all
from dynamics_node.ros.robot import Robot
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
Q = np.clip(np.linspace(0.5, -0.4, N), *ARM.position_limits.T)
QD = np.array([-0.5, -0.35, -0.2, -0.1, 0.1, 0.25, 0.4, 0.05])


class Log:
    """Collects warnings."""

    def __init__(self):
        self.warnings = []

    def warning(self, text):
        """Keep it."""
        self.warnings.append(text)


def effort(velocities, joints=(), **switches):
    """Return the effort of the chosen joints, and the warnings."""
    robot, log = Robot(ARM, joints), Log()
    robot.buffer.update(0.0, list(ARM.joint_names), Q, velocities)
    values = check_all({f'compensate.{name}': value for name, value in switches.items()})
    compensation = Compensation(types.SimpleNamespace(get_logger=lambda: log),
                                types.SimpleNamespace(values=values))
    return compensation.effort(robot, robot.gravity_torque()), log.warnings


def test_every_term_is_on_or_off():
    G, C, f = ARM.gravity_torque(Q), ARM.coriolis_matrix(Q, QD) @ QD, ARM.friction_torque(QD)
    assert min(np.abs(G).max(), np.abs(C).max(), np.abs(f).max()) > 1e-3
    for gravity in (True, False):
        for coriolis in (True, False):
            for friction in (True, False):
                actual, warnings = effort(QD, gravity=gravity, coriolis=coriolis,
                                          friction=friction)
                expected = gravity * G + coriolis * C + friction * f
                assert actual == pytest.approx(expected, rel=1e-13, abs=1e-13)
                assert not warnings


def test_only_the_chosen_joints_move():
    chosen = [ARM.joint_names[i] for i in (3, 1)]
    qd = np.zeros(N)
    qd[[3, 1]] = QD[[3, 1]]
    actual, _ = effort(QD, chosen, gravity=False, coriolis=True, friction=True)
    expected = ARM.coriolis_matrix(Q, qd) @ qd + ARM.friction_torque(qd)
    assert actual == pytest.approx(expected[[3, 1]], rel=1e-13, abs=1e-13)


def test_joints_of_unknown_velocity_stand_still_and_it_is_said():
    qd = QD.copy()
    qd[2] = np.nan
    actual, warnings = effort(qd, gravity=False, friction=True)
    assert actual == pytest.approx(ARM.friction_torque(np.nan_to_num(qd)), abs=1e-13)
    assert 'no velocities of all joints' in warnings[0]
    actual, warnings = effort([], friction=True)
    assert np.array_equal(actual, ARM.gravity_torque(Q))
    # Gravity needs no velocities.
    assert not effort([])[1]


def test_the_command_follows_the_switches_without_a_jump(client, start):
    client.record_commands()
    start(robot_description_file=ARM7, state_timeout=0.5, start_ramp=0.0)

    def moving():
        client.publish(ARM.joint_names, Q, QD)

    def put(name, value):
        assert client.call(SetParameters, '/dynamics_node/set_parameters', SetParameters.Request(
            parameters=[Parameter(name=name, value=ParameterValue(type=1, bool_value=value))]),
            moving).results[0].successful

    def reaches(expected):
        client.until(lambda: client.commands
                     and client.commands[-1][1] == pytest.approx(expected, abs=1e-9), moving)

    client.until_heard(moving)
    assert client.enable(True, moving).success
    G, C, f = ARM.gravity_torque(Q), ARM.coriolis_matrix(Q, QD) @ QD, ARM.friction_torque(QD)
    reaches(G)
    put('compensate.friction', True)
    reaches(G + f)
    put('compensate.coriolis', True)
    reaches(G + C + f)
    put('compensate.gravity', False)
    reaches(C + f)
    steps = np.diff([efforts for _, efforts in client.commands], axis=0)
    gaps = np.diff([time for time, _ in client.commands])
    # The default rate limit is the effort limit per 0.1 s; the clock here is the receiver's.
    assert (np.abs(steps).max(axis=0) <= ARM.effort_limits / 0.1 * max(gaps.max(), 0.05)).all()
    assert client.outputs[-1].name == 'ACTIVE'
    assert client.enable(False, moving).success
