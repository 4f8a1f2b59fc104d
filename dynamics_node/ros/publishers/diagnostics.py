"""The topic /diagnostics: model, joint states, output, state machine, external torque."""

from collections.abc import Mapping
import math
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from .external_torque import ExternalTorque
from ..context import NodeContext
from ..support.qos import NO_EVENTS, RESULT
from ..support.throttling import Rate
from ..torque_path.command_output import CommandOutput
from ..torque_path.joint_state_input import JointStateInput


class Diagnostics:
    """Publishes the health of the node once a second and on every change of the output."""

    def __init__(
        self,
        context: NodeContext,
        states: JointStateInput,
        output: CommandOutput,
        external_torque: ExternalTorque,
    ) -> None:
        """
        Create the publisher.

        Parameters
        ----------
        context : NodeContext
        states : JointStateInput
        output : CommandOutput
        external_torque : ExternalTorque

        """
        self._context = context
        self._node = context.node
        self._parameters = context.parameters
        self._states = states
        self._output = output
        self._external_torque = external_torque
        self._publisher = context.node.create_publisher(
            DiagnosticArray, '/diagnostics', RESULT, event_callbacks=NO_EVENTS
        )
        self._state_rate = Rate()
        self._command_rate = Rate()

    def measure(self) -> None:
        """Update the rates; called once a second."""
        now, robot = time.monotonic(), self._context.robot
        self._state_rate.measure(now, robot.buffer.accepted if robot else 0)
        self._command_rate.measure(now, self._output.commands)

    def publish(self) -> None:
        """Publish the present health."""
        message = DiagnosticArray(
            status=[
                self._model(),
                self._joint_states(),
                self._command(),
                self._state_machine(),
                self._external(),
            ]
        )
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _model(self):
        robot = self._context.robot
        if robot is None:
            return self._status('model', DiagnosticStatus.WARN, 'no robot description', {})
        warnings = robot.model.warnings
        level = DiagnosticStatus.WARN if warnings else DiagnosticStatus.OK
        text = f'{len(warnings)} warning(s)' if warnings else 'ok'
        return self._status(
            'model',
            level,
            text,
            {
                'joints': ', '.join(robot.joint_names),
                'moving mass [kg]': f'{robot.model.moving_mass:.6g}',
                'gravity [m/s^2]': ', '.join(f'{g:g}' for g in robot.model.gravity),
                'payload': _payload_in_words(robot.model.payload),
                **{f'warning {i + 1}': text for i, text in enumerate(warnings)},
            },
        )

    def _joint_states(self):
        robot = self._context.robot
        if robot is None:
            return self._status('joint states', DiagnosticStatus.WARN, 'no robot description', {})
        now, timeout = time.monotonic(), self._parameters['state_timeout']
        buffer, publishers = robot.buffer, self._states.publishers
        level, text = DiagnosticStatus.OK, 'ok'
        if stale := buffer.stale_joints(now, timeout):
            level, text = DiagnosticStatus.STALE, f'stale: {", ".join(stale)}'
        elif publishers > 1 and not self._parameters['allow_several_state_publishers']:
            level, text = DiagnosticStatus.WARN, f'{publishers} publishers, expected 1'
        elif outside := buffer.outside():
            level, text = DiagnosticStatus.WARN, f'beyond the position limits: {outside}'
        elif silent := robot.stale_others(robot.selection.index, now, timeout):
            level, text = DiagnosticStatus.WARN, f'taken where last seen: {", ".join(silent)}'
        age = buffer.age(now)
        return self._status(
            'joint states',
            level,
            text,
            {
                'rate [Hz]': f'{self._state_rate.value:.1f}',
                'age [s]': 'never received' if math.isinf(age) else f'{age:.3f}',
                'publishers': str(publishers),
                'accepted': str(buffer.accepted),
                'skipped': str(self._states.skipped),
                'rejected': str(buffer.rejected.total()),
                **{
                    f'rejected: {kind}': str(count)
                    for kind, count in sorted(buffer.rejected.items())
                },
            },
        )

    def _command(self):
        machine, limiter = self._output.path.output.machine, self._output.path.output.limiter
        level, text = DiagnosticStatus.OK, 'on' if machine.is_on else 'off'
        if machine.is_on and limiter.is_saturated:
            level, text = DiagnosticStatus.WARN, f'above the limit: {limiter.saturation()}'
        robot = self._context.robot
        names = robot.joint_names if robot else ()
        return self._status(
            'output',
            level,
            text,
            {
                'topic': self._output.topic,
                'command rate [Hz]': f'{self._command_rate.value:.1f}',
                'commands': str(self._output.commands),
                'rate limited commands': str(limiter.rate_limited),
                **{
                    f'limit hit: {name}': str(count)
                    for name, count in zip(names, limiter.saturations, strict=False)
                },
            },
        )

    def _state_machine(self):
        machine = self._output.path.output.machine
        level = {
            'FAULT': DiagnosticStatus.ERROR,
            'STOPPING': DiagnosticStatus.WARN,
            'HOLDING': DiagnosticStatus.WARN,
        }.get(machine.name, DiagnosticStatus.OK)
        return self._status(
            'state machine',
            level,
            f'{machine.name}: {machine.reason}',
            {'state': machine.name, 'reason': machine.reason, 'latched fault': machine.fault},
        )

    def _external(self):
        if not self._external_torque.is_on:
            return self._status('external torque', DiagnosticStatus.OK, 'off', {})
        problem, values = self._external_torque.health()
        level = DiagnosticStatus.WARN if problem else DiagnosticStatus.OK
        return self._status('external torque', level, problem or 'on', values)

    def _status(
        self, part: str, level: bytes, message: str, values: Mapping[str, str]
    ) -> DiagnosticStatus:
        return DiagnosticStatus(
            name=f'{self._node.get_name()}: {part}',
            level=level,
            message=message,
            hardware_id=self._node.get_fully_qualified_name(),
            values=[KeyValue(key=key, value=value) for key, value in values.items()],
        )


def _payload_in_words(payload):
    return f'{payload.mass:g} kg on {payload.link}' if payload else 'none'
