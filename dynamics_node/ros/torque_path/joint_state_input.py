"""Joint states: from the topic into the torque path."""

from __future__ import annotations

import time
from typing import Any, Protocol, TYPE_CHECKING

from rclpy.qos import QoSHistoryPolicy
from sensor_msgs.msg import JointState

from .joint_state_cdr import JointStateReader
from ..context import NodeContext
from ..support.callback_errors import guarded
from ..support.callback_groups import TorqueGroup
from ..support.qos import (
    joint_states,
    JOINT_STATES_OVERRIDES,
    NO_SUBSCRIPTION_EVENTS,
    SHARED_DEPTH,
    SINGLE_DEPTH,
)
from ..support.throttling import Throttle
from ...safety import RejectedStateError

if TYPE_CHECKING:
    from .command_output import CommandOutput

# Shortest time between two warnings of the same kind, s.
WARN_EVERY = 1.0
# The same for positions beyond their limits, s: an arm may rest at its stop for hours.
WARN_OF_LIMITS_EVERY = 30.0
# The same for missing velocities, s.
WARN_OF_VELOCITY_EVERY = 10.0


class StateListener(Protocol):
    """Receiver of the usable joint states."""

    def on_state(self, stamp: Any) -> None:
        """Receive the stamp of a usable state, after its command has been published."""

    def on_internal_error(self, message: str) -> None:
        """Receive the message of an exception in the callback."""


class JointStateInput:
    """
    Subscribes to the joint states and publishes the command of each.

    Attributes
    ----------
    subscription : rclpy.subscription.Subscription
    publishers : int
        Number of publishers of joint states; see `count_publishers`.
    skipped : int
        Number of published states that were not processed: replaced by a newer one in the queue,
        or lost in transport. Counted while there is one publisher.

    """

    def __init__(
        self, context: NodeContext, output: CommandOutput, listener: StateListener, raw: bool
    ) -> None:
        """
        Subscribe.

        Parameters
        ----------
        context : NodeContext
        output : CommandOutput
        listener : StateListener
        raw : bool
            Read the states by `JointStateReader` instead of rclpy.

        """
        self.logger = context.logger
        self._node = context.node
        self._clock: Any = context.node.get_clock()
        self._output = output
        self._path = output.path
        self._listener = listener
        self.on_internal_error = listener.on_internal_error
        self._reader = JointStateReader()
        self._sequence_number = 0
        self._has_unstamped = False
        self._warnings: dict[str, Throttle] = {}
        self.publishers = self.skipped = 0
        self._callback, self._raw = self._bytes_received if raw else self._received, raw
        # rclpy applies the overrides of the parameters to this object.
        self._profile = joint_states(context.parameters['allow_several_state_publishers'])
        self.subscription = self._subscribe(qos_overriding_options=JOINT_STATES_OVERRIDES)
        # Queue settings of the parameters are never changed.
        self._adapts = (
            self._profile.depth == SINGLE_DEPTH
            and self._profile.history == QoSHistoryPolicy.KEEP_LAST
        )

    def _subscribe(self, **options):
        return self._node.create_subscription(
            JointState,
            'joint_states',
            self._callback,
            self._profile,
            event_callbacks=NO_SUBSCRIPTION_EVENTS,
            raw=self._raw,
            callback_group=TorqueGroup(),
            **options,
        )

    def adapt_queue(self) -> None:
        """
        Count the publishers, and adapt the depth of the queue while the output is off.

        A queue of depth 1 keeps the newest state, but only one of the states of an arm and a
        gripper that arrive together. A new subscription may miss its first states, so none is
        created while efforts are sent.

        """
        several = self.count_publishers() > 1
        depth = SHARED_DEPTH if several else SINGLE_DEPTH
        if not self._adapts or depth == self._profile.depth or self._path.is_on:
            return
        self._profile.depth = depth
        before, self.subscription = self.subscription, self._subscribe()
        self._node.destroy_subscription(before)
        self._sequence_number = 0

    @property
    def topic(self) -> str:
        """Resolved name of the topic."""
        return self.subscription.topic_name

    def count_publishers(self) -> int:
        """Query the number of publishers and return it; too slow for every state."""
        self.publishers = self._node.count_publishers(self.topic)
        return self.publishers

    @guarded
    def _bytes_received(self, data, info):
        self._count_skipped(info)
        if self._path.compensation is None:
            return  # no robot yet
        try:
            message = self._reader.read(data)
        except Exception as error:
            # Any exception of rclpy means that the message is unusable.
            if not isinstance(error, RejectedStateError):
                error = RejectedStateError('unreadable', str(error))
            self._path.buffer.rejected[error.kind] += 1
            self._warn(error)
            return
        self._take(message)

    @guarded
    def _received(self, message, info):
        self._count_skipped(info)
        if self._path.compensation is not None:
            self._take(message)

    def _take(self, message):
        path = self._path
        clock = self._clock.now().nanoseconds if self._clock.ros_time_is_active else time.time_ns()
        header_stamp = message.header.stamp
        stamp = header_stamp.sec * 1_000_000_000 + header_stamp.nanosec
        try:
            command = path.process_joint_state(
                time.monotonic(),
                message.name,
                message.position,
                message.velocity,
                stamp,
                clock,
                message.effort,
            )
        except RejectedStateError as error:
            self._warn(error)
            return
        if command is not None:
            self._output.publish(command)
        if not path.is_usable:
            return
        self._warn_of_state()
        self._listener.on_state(header_stamp if stamp else self._arrival_time())

    def _warn_of_state(self):
        buffer = self._path.buffer
        outside = buffer.outside()
        if outside and self._is_due('outside', WARN_OF_LIMITS_EVERY):
            self.logger.warning(f'beyond the position limits: {outside}')
        compensation = self._path.compensation
        if compensation is not None and compensation.needs_velocity and self._path.is_driving:
            names = buffer.joints_without_velocity()
            if names and self._is_due('velocity', WARN_OF_VELOCITY_EVERY):
                self.logger.warning(
                    f'joint_states have no velocity of {", ".join(names)}: '
                    'compensate.coriolis and compensate.friction take zero'
                )

    def _warn(self, error):
        if self._is_due(error.kind):
            self.logger.warning(f'joint state dropped: {error}')

    def _is_due(self, kind, period=WARN_EVERY):
        return self._warnings.setdefault(kind, Throttle(period)).is_due()

    def _arrival_time(self):
        if not self._has_unstamped:
            self._has_unstamped = True
            self.logger.info('joint_states has no stamp, arrival time is used')
        return self._clock.now().to_msg()

    def _count_skipped(self, info):
        # Sequence numbers are per publisher, and rclpy does not identify the publisher.
        number = info['publication_sequence_number']
        if number is not None and self._sequence_number and self.publishers == 1:
            self.skipped += max(number - self._sequence_number - 1, 0)
        self._sequence_number = number or 0
