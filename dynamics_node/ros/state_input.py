"""The joint states: from the topic into the buffer, and what they say about arm and clock."""

import time

from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from .guard import guarded
from .joint_state_reader import JointStateReader
from .qos import joint_states, NO_SUBSCRIPTION_EVENTS
from .throttle import Throttle
from ..output import RejectedStateError
from ..output.motion_limits import VELOCITY_MARGIN

# The shortest time between two warnings about the same thing, s.
WARN_EVERY = 1.0


class StateInput:
    """
    Takes every joint state that is fit for use, and says when the arm must not be driven.

    Attributes
    ----------
    subscription : rclpy.subscription.Subscription
    publishers : int
        How many nodes publish joint states; see `count_publishers`.
    skipped : int
        States that were published and never looked at: a newer one was there before, or they
        were lost on the way. Counted while there is one publisher.

    """

    def __init__(self, node, parameters, get_robot, listener, raw):
        """
        Subscribe.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        get_robot : callable() -> Robot or None
        listener : object
            With `on_state(robot, now, stamp)` for every usable state, `on_bad_motion(reason)`,
            `on_clock_back(reason)` and `on_internal_error(message)`.
        raw : bool
            Read the states by `JointStateReader` instead of rclpy.

        """
        self.logger = node.get_logger()
        self._node = node
        self._clock = node.get_clock()
        self._parameters = parameters
        self._get_robot = get_robot
        self._listener = listener
        self.on_internal_error = listener.on_internal_error
        self._reader = JointStateReader()
        self._newest = 0
        self._sequence_number = 0
        self._has_unstamped = False
        self._warnings: dict[str, Throttle] = {}
        self.publishers = self.skipped = 0
        self.subscription = node.create_subscription(
            JointState, 'joint_states', self._bytes_received if raw else self._received,
            joint_states(parameters['allow_several_state_publishers']),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=NO_SUBSCRIPTION_EVENTS, raw=raw)

    @property
    def topic(self):
        """Resolved name of the topic."""
        return self.subscription.topic_name

    def count_publishers(self):
        """Look how many publishers there are; called now and then, because it takes time."""
        self.publishers = self._node.count_publishers(self.topic)
        return self.publishers

    @guarded
    def _bytes_received(self, data, info):
        robot = self._get_robot()
        try:
            message = self._reader.read(data)
        except Exception as error:  # no joint state: several of rclpy's exceptions say so
            if robot is not None:
                self._reject(robot, RejectedStateError('unreadable', str(error)))
            return
        self._take(robot, message, info)

    @guarded
    def _received(self, message, info):
        self._take(self._get_robot(), message, info)

    def _take(self, robot, message, info):
        self._count_skipped(info['publication_sequence_number'])
        if robot is None:
            return
        now = time.monotonic()
        clock = self._clock.now().nanoseconds if self._clock.ros_time_is_active else time.time_ns()
        header_stamp = message.header.stamp
        stamp = header_stamp.sec * 1_000_000_000 + header_stamp.nanosec
        buffer = robot.buffer
        try:
            self._check_clock(robot, clock)
            buffer.update(now, message.name, message.position, message.velocity, stamp, clock)
        except RejectedStateError as error:
            self._reject(robot, error)
            return
        fast = buffer.runaway()
        if fast:
            self._listener.on_bad_motion(f'runaway: {fast}, more than {VELOCITY_MARGIN:g} times '
                                         'the velocity limit')
        if not buffer.is_complete or buffer.age(now) > self._parameters['state_timeout']:
            return
        outside = buffer.outside()
        if outside and self._is_due('outside'):
            self.logger.warning(f'beyond the position limits: {outside}')
        if not stamp:
            header_stamp = self._arrival_time()
        self._listener.on_state(robot, now, header_stamp)

    def _check_clock(self, robot, clock):
        # Of simulated time that was set back, and of a system clock that was.
        if not clock:
            raise RejectedStateError('no clock', 'use_sim_time is true, but there was nothing on '
                                     '/clock yet: start the simulation, or set it to false')
        back = (self._newest - clock) * 1e-9
        self._newest = clock
        if back > robot.buffer.tolerance.seconds:
            robot.buffer.forget()
            reason = f'the clock went back by {back:.3f} s: measured states dropped'
            self.logger.warning(reason)
            self._listener.on_clock_back(reason)

    def _reject(self, robot, error):
        # The buffer has counted what it has refused itself.
        if error.kind in ('unreadable', 'no clock'):
            robot.buffer.rejected[error.kind] += 1
        if self._is_due(error.kind):
            self.logger.warning(f'joint state dropped: {error}')
        if error.is_fault:
            self._listener.on_bad_motion(str(error))

    def _is_due(self, kind):
        return self._warnings.setdefault(kind, Throttle(WARN_EVERY)).is_due()

    def _arrival_time(self):
        if not self._has_unstamped:
            self._has_unstamped = True
            self.logger.info('joint_states has no stamp, arrival time is used')
        return self._clock.now().to_msg()

    def _count_skipped(self, number):
        # Each publisher counts for itself, and which one it was rclpy does not say.
        if number is not None and self._sequence_number and self.publishers == 1:
            self.skipped += max(number - self._sequence_number - 1, 0)
        self._sequence_number = number or 0
