"""The command topic: publishes the commands of the torque path, ticks it, reports its state."""

from __future__ import annotations

from collections.abc import Callable
import math
import time
from typing import Any

from dynamics_interfaces.msg import OutputState as OutputStateMessage
import numpy as np
from numpy.typing import NDArray
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from std_msgs.msg import Float64MultiArray

from ..context import NodeContext
from ..support.callback_errors import guarded, logged
from ..support.callback_groups import TorqueGroup
from ..support.messages import to_field
from ..support.qos import COMMAND, NO_EVENTS, OUTPUT_STATE
from ..support.throttling import Throttle
from ...safety import OutputSettings, OutputState, TorquePath
from ...safety.effort_output import STOP_PERIOD

# Shortest time between two counts of the subscriptions of the command topic, s.
COUNT_EVERY = 0.02
# Longest time between two ticks, s.
IDLE_TICK = 0.25
# Shortest time between two log messages of the same state, s; ~/state has every change.
LOG_EVERY = 0.5


class CommandOutput:
    """
    Connects a `TorquePath` to ROS.

    Attributes
    ----------
    path : TorquePath
    commands : int
        Commands published so far.
    publisher : rclpy.publisher.Publisher
        Of the command topic.

    """

    def __init__(
        self,
        context: NodeContext,
        on_change: Callable[[], object],
        on_tick: Callable[[], object] = lambda: None,
    ) -> None:
        """
        Create publishers and watchdog; the output is off.

        Parameters
        ----------
        context : NodeContext
        on_change : callable()
            Called after every change of the state of the output.
        on_tick : callable()
            Called at every tick, in every state, at least every IDLE_TICK.

        """
        self.logger = context.logger
        self._node = node = context.node
        parameters = context.parameters
        self._on_change, self._on_tick = on_change, on_tick
        self.commands = self._listeners = 0
        self._count_due = Throttle(COUNT_EVERY)
        self._message = Float64MultiArray()
        self._saturated = Throttle(1.0)
        self._state_log = {state: Throttle(LOG_EVERY) for state in OutputState}
        self.publisher = node.create_publisher(
            Float64MultiArray, parameters['command_topic'], COMMAND, event_callbacks=NO_EVENTS
        )
        self._state_publisher = node.create_publisher(
            OutputStateMessage, '~/state', OUTPUT_STATE, event_callbacks=NO_EVENTS
        )
        self.path = TorquePath(output_settings(parameters), self._changed)
        # On the steady clock, which also runs while simulation time stands still. It is the only
        # timer of the node, because each timer costs time in every wait of the executor.
        self._watchdog = node.create_timer(
            IDLE_TICK,
            self._ticked,
            clock=Clock(clock_type=ClockType.STEADY_TIME),
            callback_group=TorqueGroup(),
        )

    @property
    def topic(self) -> str:
        """Resolved name of the command topic."""
        return self.publisher.topic_name

    def has_listener(self) -> bool:
        """Whether the command topic has a subscription."""
        return self.publisher.get_subscription_count() > 0

    def has_new_listener(self) -> bool:
        """Whether subscriptions were added since the last count, at most every COUNT_EVERY."""
        if not self._count_due.is_due():
            return False
        before, self._listeners = self._listeners, self.publisher.get_subscription_count()
        return self._listeners > before

    def publish(self, command: NDArray[np.float64]) -> None:
        """Publish a command that the torque path has just returned, unless it is too late."""
        if not self.path.is_timely(time.monotonic()):
            return
        self._message.data = to_field(command)
        self.publisher.publish(self._message)
        self.path.published(time.monotonic())
        self.commands += 1
        if self.path.output.limiter.is_saturated and self._saturated.is_due():
            self.logger.warning(f'effort above its limit: {self.path.output.limiter.saturation()}')

    def announce(self) -> None:
        """Publish the initial state of the output: READY means that there is a model."""
        machine = self.path.output.machine
        self._changed(machine.state, machine.reason)

    def configured(self) -> None:
        """Tick soon after a change of parameters: the state timeout may have become shorter."""
        if self.path.is_on:
            self._tick_within(STOP_PERIOD)

    def enable(self) -> bool:
        """Start to send efforts; return False if the process is about to end."""
        return self.path.enable(time.monotonic())

    def fault(self, reason: str) -> None:
        """Stop the output if it is on, and end in FAULT."""
        self.path.fault(time.monotonic(), reason)

    def on_internal_error(self, message: str) -> None:
        """Stop after an exception in a callback of the torque path."""
        self.path.fail(time.monotonic(), message)

    def tick(self) -> None:
        """Check the age of the joint state; send the next command of a ramp or a stop."""
        command = self.path.tick(time.monotonic())
        if command is not None:
            self.publish(command)

    def flush(self, timeout: float) -> None:
        """Wait until every subscriber has the last command, at most `timeout` seconds."""
        self.publisher.wait_for_all_acked(Duration(seconds=timeout))

    @guarded
    def _ticked(self):
        try:
            if self.path.is_on:
                self.tick()
        finally:
            due = self.path.next_tick_in(time.monotonic()) if self.path.is_on else IDLE_TICK
            self._tick_in(min(due, IDLE_TICK))
        self._on_tick()

    def _tick_within(self, seconds: float) -> None:
        # Never later than planned: repeated calls, as by a flood of parameters, would otherwise
        # postpone the tick forever.
        planned = self._watchdog.time_until_next_call()
        if planned is None or planned > seconds * 1e9:
            self._tick_in(seconds)

    def _tick_in(self, seconds: float) -> None:
        # Scheduled for the moment at which a state becomes stale or a ramp continues: a timer of a
        # fixed rate would cost as much as a stream of joint states of that rate.
        self._watchdog.timer_period_ns = math.ceil(seconds * 1e9)
        self._watchdog.reset()

    @logged
    def _changed(self, state: OutputState, reason: str) -> None:
        if self.path.is_on:
            self._tick_within(STOP_PERIOD)
        message = OutputStateMessage(state=int(state), name=state.name, reason=reason)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._state_publisher.publish(message)
        self._log(state, reason)
        self._on_change()

    def _log(self, state: OutputState, reason: str) -> None:
        if not self._state_log[state].is_due():
            return
        # Two lines, because rclpy ties the severity to the line that logs.
        if state == OutputState.FAULT:
            self.logger.error(f'output FAULT: {reason}; ~/enable tries again')
        else:
            self.logger.info(f'output {state.name}: {reason}')


def output_settings(parameters: Any) -> OutputSettings:
    """Return the `OutputSettings` of the parameters, a mapping or `Parameters`."""
    return OutputSettings(
        **{
            name: parameters[name]
            for name in ('state_timeout', 'start_ramp', 'stop_ramp', 'stop_behavior')
        }
    )
