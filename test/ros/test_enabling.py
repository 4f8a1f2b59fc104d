"""What speaks against enabling, and what happens while the controllers are asked."""

from pathlib import Path
import time
from types import SimpleNamespace

from dynamics_node import RobotModel
from dynamics_node.ros.enabling import Enabling
from dynamics_node.ros.robot import Robot
from dynamics_node.safety import EffortOutput
from dynamics_node.safety.effort_output import OutputSettings
import numpy as np
import pytest
from support.robots import PENDULUM


class Output:
    """A command output that notes what it is told to do."""

    topic = '/efforts'

    def __init__(self):
        self.channel = EffortOutput(OutputSettings(0.5, 1.0, 1.0, 'ramp_to_zero'))
        self.channel.set_limiter(np.ones(1), np.ones(1), np.ones(1))
        self.begun = []

    def begin(self, notes):
        """Enable."""
        self.begun.append(notes)
        self.channel.enable(time.monotonic())
        return 'enabled'

    def stop(self, reason):
        """Stop."""
        self.channel.stop(time.monotonic(), reason)


@pytest.fixture
def parts(client):
    """Return an `Enabling` whose controllers answer when the test says so, and what it uses."""
    robot = Robot(RobotModel.from_urdf(PENDULUM), ())
    parts = SimpleNamespace(robot=robot, output=Output(), rivals=[], asked=[])
    parameters = {'state_timeout': 60.0, 'effort_limits': ()}
    parts.enabling = Enabling(client.node, parameters, lambda: parts.robot, parts.output,
                              SimpleNamespace(found=lambda: parts.rivals))
    parts.enabling._controllers = SimpleNamespace(
        is_busy=False, begin=lambda names, done: parts.asked.append((names, done)))
    parts.fresh = lambda: robot.buffer.update(time.monotonic(), ['hinge'], [0.0])
    parts.fresh()
    return parts


def answers():
    """Return an empty list and a callable that fills it."""
    given = []
    return given, lambda success, text: given.append((success, text))


def test_the_output_begins_when_the_controllers_have_nothing_against_it(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    [(names, done)] = parts.asked
    assert names == ('hinge',)
    assert given == parts.output.begun == []
    done([], ['the deaf one said nothing'])
    assert given == [(True, 'enabled')]
    assert parts.output.begun == [['the deaf one said nothing']]
    parts.enabling.enable(answer)
    assert given[-1] == (True, 'already enabled: STARTING')


def test_joints_whose_speed_has_no_limit_are_named(parts):
    given, answer = answers()
    parts.robot.joints_without_velocity_limit = lambda: ['hinge']
    parts.enabling.enable(answer)
    parts.asked[0][1]([], [])
    assert given == [(True, 'enabled')]
    assert parts.output.begun == [['jumps and runaway are not noticed of hinge: the URDF has no '
                                   'velocity limit there']]


def test_every_reason_against_it_is_said_at_once(parts):
    given, answer = answers()
    parts.rivals.append('1 other publisher')
    parts.robot.buffer.forget()
    parts.robot.buffer.rejected['stamp'] = 7
    parts.enabling.enable(answer)
    assert given == [(False, 'refused: no joint state within 60 s for hinge (dropped so far: '
                             '7 for stamp); 1 other publisher')]
    assert parts.asked == []


def test_a_mass_matrix_that_is_not_positive_definite_is_refused(parts):
    given, answer = answers()
    parts.robot.is_mass_matrix_positive_definite = lambda: False
    parts.enabling.enable(answer)
    assert given[0][1].startswith('refused: the mass matrix is not positive definite')


def test_what_the_controllers_say_is_refused(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    parts.asked[0][1](['another order'], [])
    assert given == [(False, 'refused: another order')]
    assert parts.output.begun == []


def test_what_has_changed_while_they_were_asked_counts(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    parts.robot = None
    parts.asked[0][1]([], [])
    assert given == [(False, 'refused: no robot description yet')]


def test_a_robot_with_other_joints_than_the_controllers_were_asked_about_is_refused(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    description = Path(PENDULUM).read_text()
    parts.robot = Robot(RobotModel.from_urdf(description.replace('"hinge"', '"pivot"')), ())
    parts.robot.buffer.update(time.monotonic(), ['pivot'], [0.0])
    parts.asked[0][1]([], [])
    assert parts.output.begun == []
    assert given == [(False, 'refused: the robot description has changed its joints while the '
                             'controllers were asked: ask again')]
    parts.enabling.enable(answer)
    assert parts.asked[1][0] == ('pivot',)
    parts.asked[1][1]([], [])
    assert given[-1] == (True, 'enabled')


def test_several_requests_at_once_get_one_answer_each(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    parts.enabling._controllers.is_busy = True
    parts.enabling.enable(answer)
    assert len(parts.asked) == 1
    parts.asked[0][1]([], [])
    assert given == [(True, 'enabled')] * 2
    assert len(parts.output.begun) == 1


def test_a_request_to_disable_is_the_last_word(parts):
    given, answer = answers()
    parts.enabling.enable(answer)
    parts.enabling.disable(answer)
    assert given == [(False, 'disabled on request before it was enabled'),
                     (True, 'already off: READY')]
    parts.asked[0][1]([], [])
    assert parts.output.begun == []
    assert len(given) == 2
