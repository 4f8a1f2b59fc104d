"""
A simulated arm is pushed, over DDS: ~/external_torque says with what, and else says nothing.

MuJoCo simulates the arm and judges the estimate by its own Jacobian; all times are stamps.

"""

import bisect

from dynamics_node.demo.missing_values import add_missing_damping
from dynamics_node.demo.mujoco_arm import MujocoArm
from dynamics_node.dynamics.momentum_observer import LONGEST_STEP
import numpy as np
import pytest
from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from soak.rig import Rig
from std_srvs.srv import Trigger
from support.robots import ARM7, public_robot

PUSH = 0.3  # s
# What is asked for: s, and part of the largest joint torque of the push.
RIGHT_WITHIN, RIGHT = 0.05, 0.05
# What may appear where nothing pushes: 10 N at the tool make 2 N m or more.
NOTHING = 0.1  # N m
# A push during which the simulation, in real time, had to let time out tells nothing, s. Nor does
# one during which the node was so late that it began anew.
LONGEST_GAP = 0.03
ATTEMPTS = 8


class PushedRig(Rig):
    """
    The rig with somebody who pushes and listens.

    Attributes
    ----------
    estimates : list of (float, numpy.ndarray)
        Stamp, s, and external efforts of the driven joints, N m or N.
    judge : MujocoArm

    """

    def __init__(self, urdf):
        """Start everything; the node is told of the damping that the simulated robot adds."""
        self.judge = MujocoArm(urdf.read_text())
        parameters = {}
        if add_missing_damping(self.judge):
            by_name = dict(zip(self.judge.names, self.judge.damping().tolist(), strict=True))
            parameters['friction.viscous'] = [by_name[name] for name in self.judge.driven_names]
        super().__init__(
            urdf=urdf,
            state_timeout=0.5,
            stop_ramp=0.2,
            publish_external_torque='true',
            **parameters,
        )
        self.estimates = []
        self.client.node.create_subscription(
            JointState, 'dynamics_node/external_torque', self._heard, QoSProfile(depth=1000)
        )
        self._set('push_duration', type=ParameterType.PARAMETER_DOUBLE, double_value=PUSH)

    def push(self, force):
        """Push the last link, wait until that is over, and return from when to when, s."""
        self._set(
            'push_force', type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=list(force)
        )
        self.until(lambda: self.client.speed < 1e-4)
        self.during(0.3)  # the brakes may have held it until now: that is a push, too
        asked = self.client.now
        assert self.client.call(Trigger, '/simulated_robot/push').success
        # A simulation that lags behind is pushed at a time of its own, before it was asked to.
        time, position, velocity, _ = self.client.truth_between(asked - 0.2, asked + PUSH)
        # Between the last state at rest and the first that moves: at a constant acceleration
        # since then, its way is half its speed times that time.
        first = int(np.argmax(np.abs(velocity).max(axis=1) > 1e-3))
        if first == 0:
            return None  # so late that it let the beginning out
        joint = np.argmax(np.abs(velocity[first]))
        way = position[first, joint] - position[first - 1, joint]
        begin = max(time[first] - 2.0 * way / velocity[first, joint], time[first - 1])
        return begin, begin + PUSH

    def longest_gap(self, begin, end):
        """Return the longest time between two states of the robot, s."""
        times = self.client.truth_between(begin, end)[0]
        return np.diff([begin, *times[times > begin], end]).max()

    def has_begun_anew(self, begin, end):
        """Tell whether the node has missed so many states that the estimate began at zero."""
        self.until(lambda: self.estimates and self.estimates[-1][0] > end)
        times = [time for time, _ in self.estimates if begin < time < end]
        return np.diff([begin, *times, end]).max() > LONGEST_STEP - LONGEST_GAP

    def estimates_between(self, begin, end):
        """Return stamps (k,) and estimates (k, n) within a time, s."""
        self.until(lambda: self.estimates and self.estimates[-1][0] > end)
        times = [time for time, _ in self.estimates]
        chosen = self.estimates[bisect.bisect(times, begin) : bisect.bisect_left(times, end)]
        assert chosen, f'no estimate between {begin} and {end} s, the last ones: {times[-5:]}'
        return tuple(np.array(column) for column in zip(*chosen, strict=True))

    def unseen(self, times):
        """
        Return how much an estimate can be wrong because efforts are only known at some times.

        They change in steps, when a command comes. The observer takes the mean of two states for
        all the time between them, so it is wrong by half of what they differ at most. On a machine
        that has time for every state this is next to nothing.

        """
        stamps, _, _, effort = self.client.truth_between(times[0] - 0.01, times[-1])
        rows = [int(np.argmin(np.abs(stamps - time))) for time in times]
        return 0.5 * np.abs(np.diff(effort[rows], axis=0)).max(initial=0.0)

    def torque_of(self, force, times):
        """Return J^T F by MuJoCo where the arm was at some times, shape (k, n)."""
        stamps, position, _, _ = self.client.truth_between(times[0], times[-1])
        rows = [int(np.argmin(np.abs(stamps - time))) for time in times]
        return np.array([self.judge.last_link_jacobian(position[row]).T @ force for row in rows])

    def _set(self, name, **value):
        self.client.set_parameter('simulated_robot', name, ParameterValue(**value))

    def _heard(self, message):
        assert list(message.name) == self.arm.driven_names
        stamp = message.header.stamp
        self.estimates.append(
            (self.client.time_of(stamp.sec * 10**9 + stamp.nanosec), np.array(message.effort))
        )


@pytest.fixture(
    scope='module',
    params=[ARM7, public_robot('ur_description/urdf/ur5_robot.urdf')],
    ids=lambda path: path.stem,
)
def shared(request):
    """Return the rig of all tests with a robot."""
    rig = PushedRig(request.param)
    yield rig
    rig.close()


@pytest.fixture
def rig(shared):
    """Return the rig, the arm ACTIVE and floating at its start pose."""
    float_at_start(shared)
    return shared


def float_at_start(rig):
    """Bring the arm back to its start pose, and let it float there."""
    if rig.distance > 1e-3:
        rig.until(lambda: rig.client.set_brakes(True))
        rig.until(rig.client.reset)
        rig.until(lambda: rig.client.set_brakes(True))
    rig.float()
    if rig.client.set_brakes(False):
        rig.during(0.1)


def in_one_go(rig, action, before_another=lambda rig: None):
    """Do something again until the machine has not stopped all in the middle of it."""
    for _ in range(ATTEMPTS):
        window = action()
        if window is not None:
            begin, end = window[0] - 0.1, window[1] + 0.5
            if rig.longest_gap(begin, end) < LONGEST_GAP and not rig.has_begun_anew(begin, end):
                return window
        before_another(rig)
    # That estimates come at all, the arm at rest shows.
    pytest.skip('robot or node were silent for too long in every attempt: the machine is too busy')


@pytest.mark.parametrize(
    'force',
    [(0.0, 10.0, 0.0), (10.0, 0.0, 0.0), (0.0, 6.0, -8.0)],
    ids=['sideways', 'forwards', 'down'],
)
def test_a_push_appears_with_its_joint_torques(rig, force):
    # From where one push has left it, the next would be another one.
    begin, end = in_one_go(rig, lambda: rig.push(force), float_at_start)
    times, estimates = rig.estimates_between(begin + RIGHT_WITHIN, end)
    expected = rig.torque_of(np.array(force), times)
    largest = np.abs(expected).max()
    assert largest > 20 * NOTHING
    assert len(times) > 2
    assert np.abs(estimates - expected).max() < RIGHT * largest + rig.unseen(times)
    # Not before it begins, and not when it has been over for a while.
    for quiet in ((begin - 0.1, begin), (end + 2 * RIGHT_WITHIN, end + 0.5)):
        times, estimates = rig.estimates_between(*quiet)
        assert np.abs(estimates).max() < NOTHING + rig.unseen(times)


def test_nothing_appears_while_the_arm_floats_at_rest(rig):
    rig.until(lambda: rig.client.speed < 1e-4)
    rig.during(0.3)
    begin = rig.client.now
    rig.during(1.0)
    times, estimates = rig.estimates_between(begin, begin + 1.0)
    assert len(times) > 10
    assert np.abs(estimates).max() < NOTHING / 10


def test_nothing_appears_while_the_arm_falls(rig):
    # Far and fast, without efforts; until it comes near the end of a joint, which does push it.
    def fall():
        rig.until(lambda: rig.client.set_brakes(True))
        rig.until(rig.client.reset)
        rig.until(lambda: rig.client.set_brakes(True))
        rig.during(0.1)  # what it was braked from is over
        begin = rig.client.now
        assert rig.client.set_brakes(False)
        rig.until(lambda: rig.client.truth[-1][0] > begin + 0.2 and rig.client.speed > 2.0)
        time, _, velocity, _ = rig.client.truth_between(begin, rig.client.now)
        return begin + 0.1, time[np.argmax(np.abs(velocity).max(axis=1) > 2.0)]

    rig.client.set_brakes(True)
    assert rig.client.enable(False).success
    rig.until(lambda: rig.client.output == 'READY')
    begin, end = in_one_go(rig, fall)
    lower, upper = np.array([(joint.lower, joint.upper) for joint in rig.arm.driven]).T
    _, position, velocity, effort = rig.client.truth_between(begin, end)
    turns = [joint.turns for joint in rig.arm.driven]
    assert ((lower + 0.05 < position) & (position < upper - 0.05))[:, turns].all()
    assert np.abs(velocity).max() > 1.5 and not effort.any()
    assert np.abs(rig.estimates_between(begin, end)[1]).max() < NOTHING
