"""`EffortGuardNode`: commands in, the same commands out, or a fade to zero."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
import math
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from dynamics_interfaces.msg import OutputState as OutputStateMessage
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks, UnsupportedEventTypeError
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

from .controller_parameters import ControllerParameters
from .parameters import check_all, GUARD_PARAMETERS
from ..parameters.declaration import declare
from ..support.callback_errors import logged
from ..support.qos import COMMAND, NO_EVENTS, OUTPUT_STATE, RESULT
from ..support.throttling import Throttle
from ...errors import ParameterError
from ...safety import OutputState
from ...safety.effort_guard import EffortGuard, GuardSettings, MAX_TICK, PERIODS

# Period of the search for publishers and listeners, s.
GRAPH_EVERY = 0.5
# Period of a repeated warning, s.
WARN_EVERY = 10.0
# Shortest time between two log messages of the same state, s.
LOG_STATE_EVERY = 1.0


class EffortGuardNode(Node):
    """
    Passes commands to the effort controller, and fades the last one to zero when they end.

    Attributes
    ----------
    guard : EffortGuard

    """

    def __init__(self, **options: Any) -> None:
        """
        Create all parts; the output topic is silent until a command arrives.

        Parameters
        ----------
        **options
            Of rclpy.node.Node.

        Raises
        ------
        ParameterError
            If a parameter on the command line or in a file is refused.

        """
        super().__init__('effort_guard', **options)
        self.logger = self.get_logger()
        values = check_all(declare(self, GUARD_PARAMETERS))
        self._settings = GuardSettings(
            **{
                name: values[name]
                for name in ('timeout', 'stop_ramp', 'rate_limits', 'effort_limits')
            }
        )
        self._input = self.resolve_topic_name(values['input_topic'])
        self._output = self.resolve_topic_name(values['output_topic'])
        if self._input == self._output:
            raise ParameterError(
                f'input_topic, output_topic: both are {self._input}, and the '
                'guard would hear itself; expected two topics'
            )
        self.guard = EffortGuard(self._settings, self._changed, self._obstacle)
        self._changes: list[tuple[OutputState, str]] = []
        self._remarks: list[str] = []
        self._layout = Float64MultiArray().layout
        self._warned = Throttle(WARN_EVERY)
        self._logged: dict[Any, Throttle] = {}
        self._refused_before = 0
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._publisher = self.create_publisher(
            Float64MultiArray, self._output, COMMAND, event_callbacks=NO_EVENTS
        )
        self._state_publisher = self.create_publisher(
            OutputStateMessage, '~/state', OUTPUT_STATE, event_callbacks=NO_EVENTS
        )
        self._diagnostics = self.create_publisher(
            DiagnosticArray, '/diagnostics', RESULT, event_callbacks=NO_EVENTS
        )
        self._controller = ControllerParameters(self, self._output)
        # On the steady clock, which also runs while simulation time stands still.
        self._look_timer = self.create_timer(MAX_TICK, self._look, clock=steady)
        self.create_timer(GRAPH_EVERY, self._look_at_graph, clock=steady)
        self.create_timer(1.0, self._every_second, clock=steady)
        self._reset_service = self.create_service(Trigger, '~/reset', self._reset)
        self._subscription = self._subscribe()
        self._publish_state()
        self.logger.info(
            f'guarding {self._input} -> {self._output}: timeout {self._settings.timeout:g} s, '
            f'stop_ramp {self._settings.stop_ramp:g} s'
        )

    def end(self, within: float, reason: str) -> None:
        """Accept no more commands, and fade to zero; see `EffortGuard.end`."""
        self.guard.end(time.monotonic(), within, reason)
        self._report_changes()

    def drop(self) -> None:
        """Publish zero at once."""
        self._publish(self.guard.drop())
        self._report_changes()

    def flush(self, timeout: float) -> bool:
        """Wait up to `timeout` s for the controller to acknowledge; return whether it has."""
        return self._publisher.wait_for_all_acked(Duration(seconds=timeout))

    def _subscribe(self) -> Any:
        def subscribe(**events: Any) -> Any:
            return self.create_subscription(
                Float64MultiArray,
                self._input,
                self._on_command,
                COMMAND,
                event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False, **events),
            )

        try:
            return subscribe(matched=self._matched)
        except UnsupportedEventTypeError:  # some middlewares have no such event
            self.guard.source_appeared(time.monotonic())
            return subscribe()

    @logged
    def _matched(self, info):
        if info.current_count_change > 0:
            self.guard.source_appeared(time.monotonic())

    @logged
    def _on_command(self, message):
        output = self.guard.on_command(time.monotonic(), message.data)
        if output is not None:
            if output is not message.data:
                message.data = array('d', output)
            self._publisher.publish(message)
            self._layout = message.layout
        if self._changes:
            self._report_changes()

    @logged
    def _look(self):
        try:
            output = self.guard.tick(time.monotonic())
            if output is not None:
                self._publish(output)
        finally:
            self._schedule_look()
        self._report_changes()

    def _publish(self, output: Sequence[float]) -> None:
        self._publisher.publish(Float64MultiArray(layout=self._layout, data=array('d', output)))

    def _schedule_look(self) -> None:
        self._look_timer.timer_period_ns = math.ceil(
            self.guard.next_tick_in(time.monotonic()) * 1e9
        )
        self._look_timer.reset()

    def _changed(self, state: OutputState, reason: str) -> None:
        # Reported after the command has been published, which must not be delayed.
        self._changes.append((state, reason))

    def _report_changes(self) -> None:
        changes, self._changes = self._changes, []
        if not changes:
            return
        self._schedule_look()
        for state, reason in changes:
            self._publish_state(state, reason)
            if not self._logged.setdefault(state, Throttle(LOG_STATE_EVERY)).is_due():
                continue
            # Three lines, because rclpy ties the severity to the line that logs.
            if state.name == 'FAULT':
                self.logger.error(f'FAULT: {reason}')
            elif state.name == 'STOPPING':
                self.logger.warning(f'STOPPING: {reason}')
            else:
                self.logger.info(f'{state.name}: {reason}')

    def _publish_state(self, state: OutputState | None = None, reason: str | None = None) -> None:
        state = self.guard.state if state is None else state
        reason = '; but '.join([reason or self.guard.reason, *self._remarks])
        message = OutputStateMessage(state=int(state), name=state.name, reason=reason)
        message.header.stamp = self.get_clock().now().to_msg()
        self._state_publisher.publish(message)

    # The graph -------------------------------------------------------------------------------

    def _obstacle(self) -> str:
        """Return the reason against an effort that begins now, '' if there is none."""
        if self._publisher.get_subscription_count() == 0:
            return (
                f'nothing listens on {self._output}: start the effort controller, or set '
                'output_topic to its topic'
            )
        return self._other_publishers()

    def _other_publishers(self) -> str:
        others = self.count_publishers(self._output) - 1
        if others <= 0:
            return ''
        return (
            f'{others} other publisher(s) on {self._output}'
            f'{self._names(self._output)}: two sources of effort would fight; the '
            f'guarded one must publish on {self._input}'
        )

    def _names(self, topic: str) -> str:
        own = (self.get_name(), self.get_namespace())
        names = {
            f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            for info in self.get_publishers_info_by_topic(topic)
            if (info.node_name, info.node_namespace) != own
        }
        return f' ({", ".join(sorted(names))})' if names else ''

    @logged
    def _look_at_graph(self):
        if not self.guard.has_effort:
            self._controller.ask()
            self.guard.joint_count = self._controller.joint_count
        remarks = self._find_remarks()
        if remarks != self._remarks:
            self._remarks = remarks
            self._publish_state()
        if remarks and self._warned.is_due():
            self.logger.warning('; '.join(remarks))

    def _find_remarks(self) -> list[str]:
        remarks = [self._other_publishers()]
        sources = self.count_publishers(self._input)
        if sources > 1:
            remarks.append(
                f'{sources} publishers on {self._input}{self._names(self._input)}: '
                'commands of all of them pass'
            )
        if self.guard.has_effort and not self._publisher.get_subscription_count():
            remarks.append(f'nothing listens on {self._output} any more')
        if self.guard.slow_period() is not None:
            # Without the measured period: a changing text would be published at every search.
            remarks.append(
                f'commands come too slowly: fewer than {PERIODS} within the timeout of '
                f'{self._settings.timeout:g} s; raise timeout, or the rate of the '
                'joint states'
            )
        return [remark for remark in remarks if remark]

    # Once a second, and on request -----------------------------------------------------------

    @logged
    def _every_second(self):
        refused = self.guard.refused.total()
        if (
            refused != self._refused_before
            and self._logged.setdefault('refused', Throttle(WARN_EVERY)).is_due()
        ):
            counts = ', '.join(
                f'{count} {kind}' for kind, count in self.guard.refused.most_common()
            )
            self.logger.warning(f'commands that did not pass so far: {counts}')
        self._refused_before = refused
        self._diagnostics.publish(self._health())

    def _health(self) -> DiagnosticArray:
        guard, period = self.guard, self.guard.slow_period()
        level = {'FAULT': DiagnosticStatus.ERROR, 'STOPPING': DiagnosticStatus.WARN}.get(
            guard.state.name, DiagnosticStatus.WARN if self._remarks else DiagnosticStatus.OK
        )
        values = {
            'state': guard.state.name,
            'input': self._input,
            'output': self._output,
            'passed': guard.passed,
            'clamped': guard.clamped,
            'fades': guard.fades,
            'silences bridged': guard.bridged,
            'own standstills': guard.stalls,
            **({'slow period [s]': f'{period:.4f}'} if period is not None else {}),
            **{f'refused: {kind}': count for kind, count in sorted(guard.refused.items())},
        }
        message = DiagnosticArray(
            status=[
                DiagnosticStatus(
                    name=f'{self.get_name()}: guard',
                    level=level,
                    message='; but '.join([f'{guard.state.name}: {guard.reason}', *self._remarks]),
                    hardware_id=self.get_fully_qualified_name(),
                    values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
                )
            ]
        )
        message.header.stamp = self.get_clock().now().to_msg()
        return message

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            response.success, response.message = self.guard.reset(time.monotonic())
            self._report_changes()
        except Exception as error:
            self.logger.error(f'~/reset: {error}')
            response.success, response.message = False, f'internal error: {error}'
        return response
