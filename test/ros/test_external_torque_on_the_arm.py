"""
A simulated arm is pushed, over DDS: ~/external_torque is the torque of the push, otherwise zero.

MuJoCo simulates the arm; its own Jacobian gives the expected torque. All times are stamps.

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
# Required: rise time, s, and error as a part of the largest joint torque of the push.
RISE_TIME, TOLERANCE = 0.05, 0.05
# Largest estimate without a push, N m: 10 N at the tool are 2 N m or more.
NOISE = 0.1
# A push with a longer gap in the simulation, s, or with a restart of the observer, is repeated.
LONGEST_GAP = 0.03
ATTEMPTS = 8


def nearest(stamps, times):
    """Return the rows of the stamps nearest to some times."""
    return [int(np.argmin(np.abs(stamps - time))) for time in times]


class PushedRig(Rig):
    """
    The rig, with pushes and the estimates of the node.

    Attributes
    ----------
    estimates : list of (float, numpy.ndarray)
        Stamp, s, and external efforts of the driven joints, N m or N.
    oracle : MujocoArm

    """

    def __init__(self, urdf):
        """Start all processes; the node gets the damping that the simulated robot adds."""
        self.oracle = MujocoArm(urdf.read_text())
        parameters = {}
        if add_missing_damping(self.oracle):
            by_name = dict(zip(self.oracle.names, self.oracle.damping().tolist(), strict=True))
            parameters['friction.viscous'] = [by_name[name] for name in self.oracle.driven_names]
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
        """Push the last link, wait for the end, and return begin and end, s."""
        self._set(
            'push_force', type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=list(force)
        )
        self.until(lambda: self.client.speed < 1e-4)
        self.during(0.3)  # the brakes may have held it until now, which is a push, too
        requested = self.client.now
        assert self.client.call(Trigger, '/simulated_robot/push').success
        # A simulation that lags behind has an earlier time than the request.
        time, position, velocity, _ = self.client.truth_between(requested - 0.2, requested + PUSH)
        # The push begins between the last state at rest and the first in motion. At constant
        # acceleration, the distance is half the speed times the time since then.
        first = int(np.argmax(np.abs(velocity).max(axis=1) > 1e-3))
        if first == 0:
            return None  # the states at the beginning are missing
        joint = np.argmax(np.abs(velocity[first]))
        distance = position[first, joint] - position[first - 1, joint]
        begin = max(time[first] - 2.0 * distance / velocity[first, joint], time[first - 1])
        return begin, begin + PUSH

    def longest_gap(self, begin, end):
        """Return the longest time between two states of the robot, s."""
        times = self.client.truth_between(begin, end)[0]
        return np.diff([begin, *times[times > begin], end]).max()

    def has_restarted(self, begin, end):
        """Tell whether missing states have restarted the estimate at zero."""
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

    def sampling_error(self, times):
        """
        Return the largest error of an estimate due to efforts known only at some times.

        Efforts change in steps, with every command. The observer uses the mean of two states for
        the time between them: wrong by at most half of their difference. On a machine with time
        for every state this is negligible.

        """
        stamps, _, _, effort = self.client.truth_between(times[0] - 0.01, times[-1])
        return 0.5 * np.abs(np.diff(effort[nearest(stamps, times)], axis=0)).max(initial=0.0)

    def torque_of(self, force, times):
        """Return J^T F by MuJoCo at the positions at some times, shape (k, n)."""
        stamps, position, _, _ = self.client.truth_between(times[0], times[-1])
        rows = nearest(stamps, times)
        return np.array([self.oracle.last_link_jacobian(q).T @ force for q in position[rows]])

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
    """Return the rig of one robot."""
    rig = PushedRig(request.param)
    yield rig
    rig.close()


@pytest.fixture
def rig(shared):
    """Return the rig, the arm ACTIVE and floating at its start pose."""
    float_at_start(shared)
    return shared


def to_start_pose(rig):
    """Bring the arm to its start pose, with its brakes on."""
    rig.until(lambda: rig.client.set_brakes(True))
    rig.until(rig.client.reset)
    rig.until(lambda: rig.client.set_brakes(True))


def float_at_start(rig):
    """Bring the arm back to its start pose, and let it float there."""
    if rig.distance > 1e-3:
        to_start_pose(rig)
    rig.float()
    if rig.client.set_brakes(False):
        rig.during(0.1)


def without_gap(rig, action, before_repetition=lambda rig: None):
    """Repeat an action until no gap of the busy machine disturbs it; return begin and end, s."""
    for _ in range(ATTEMPTS):
        window = action()
        if window is not None:
            begin, end = window[0] - 0.1, window[1] + 0.5
            if rig.longest_gap(begin, end) < LONGEST_GAP and not rig.has_restarted(begin, end):
                return window
        before_repetition(rig)
    # The test of the arm at rest shows that there are estimates.
    pytest.skip('robot or node were silent for too long in every attempt: the machine is too busy')


@pytest.mark.parametrize(
    'force',
    [(0.0, 10.0, 0.0), (10.0, 0.0, 0.0), (0.0, 6.0, -8.0)],
    ids=['sideways', 'forwards', 'down'],
)
def test_a_push_appears_with_its_joint_torques(rig, force):
    # From the start pose again: a push from elsewhere has other joint torques.
    begin, end = without_gap(rig, lambda: rig.push(force), float_at_start)
    times, estimates = rig.estimates_between(begin + RISE_TIME, end)
    expected = rig.torque_of(np.array(force), times)
    largest = np.abs(expected).max()
    assert largest > 20 * NOISE
    assert len(times) > 2
    assert np.abs(estimates - expected).max() < TOLERANCE * largest + rig.sampling_error(times)
    # Neither before the push nor after it.
    for quiet in ((begin - 0.1, begin), (end + 2 * RISE_TIME, end + 0.5)):
        times, estimates = rig.estimates_between(*quiet)
        assert np.abs(estimates).max() < NOISE + rig.sampling_error(times)


def test_the_estimate_is_zero_while_the_arm_floats_at_rest(rig):
    rig.until(lambda: rig.client.speed < 1e-4)
    rig.during(0.3)
    begin = rig.client.now
    rig.during(1.0)
    times, estimates = rig.estimates_between(begin, begin + 1.0)
    assert len(times) > 10
    assert np.abs(estimates).max() < NOISE / 10


def test_the_estimate_is_zero_while_the_arm_falls(rig):
    # Far and fast, without efforts, and not to the end of a joint, which would push it.
    def fall():
        to_start_pose(rig)
        rig.during(0.1)  # after the braking
        begin = rig.client.now
        assert rig.client.set_brakes(False)
        rig.until(lambda: rig.client.truth[-1][0] > begin + 0.2 and rig.client.speed > 2.0)
        time, _, velocity, _ = rig.client.truth_between(begin, rig.client.now)
        return begin + 0.1, time[np.argmax(np.abs(velocity).max(axis=1) > 2.0)]

    rig.client.set_brakes(True)
    assert rig.client.enable(False).success
    rig.until(lambda: rig.client.output == 'READY')
    begin, end = without_gap(rig, fall)
    lower, upper = np.array([(joint.lower, joint.upper) for joint in rig.arm.driven]).T
    _, position, velocity, effort = rig.client.truth_between(begin, end)
    turns = [joint.turns for joint in rig.arm.driven]
    assert ((lower + 0.05 < position) & (position < upper - 0.05))[:, turns].all()
    assert np.abs(velocity).max() > 1.5 and not effort.any()
    assert np.abs(rig.estimates_between(begin, end)[1]).max() < NOISE
