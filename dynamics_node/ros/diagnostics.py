"""What the node says on /diagnostics: model, joint states, output."""

import math
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from .qos import NO_EVENTS, RESULT


class Diagnostics:
    """Publishes the node's health once a second and on every change of the output."""

    def __init__(self, node, parameters, get_robot, output):
        """
        Create the publisher.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        get_robot : callable() -> Robot or None
        output : CommandOutput

        """
        self._node = node
        self._parameters = parameters
        self._get_robot = get_robot
        self._output = output
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', RESULT,
                                                event_callbacks=NO_EVENTS)
        self._counted = (time.monotonic(), 0)
        self._rate = 0.0

    def measure(self):
        """Update the rate of joint states; called once a second."""
        robot = self._get_robot()
        now, accepted = time.monotonic(), robot.buffer.accepted if robot else 0
        before, earlier = self._counted
        self._rate = max(accepted - earlier, 0) / max(now - before, 1e-6)
        self._counted = (now, accepted)

    def publish(self):
        """Publish the present health."""
        message = DiagnosticArray(status=[self._model(), self._states(), self._command()])
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _model(self):
        robot = self._get_robot()
        if robot is None:
            return self._status('model', DiagnosticStatus.WARN, 'no robot description', {})
        warnings = robot.model.warnings
        level = DiagnosticStatus.WARN if warnings else DiagnosticStatus.OK
        text = f'{len(warnings)} warning(s)' if warnings else 'ok'
        return self._status('model', level, text, {
            'joints': ', '.join(robot.joint_names),
            'moving mass [kg]': f'{robot.model.total_mass:.6g}',
            'gravity [m/s^2]': ', '.join(f'{g:g}' for g in robot.model.gravity),
            **{f'warning {i + 1}': text for i, text in enumerate(warnings)}})

    def _states(self):
        robot = self._get_robot()
        if robot is None:
            return self._status('joint states', DiagnosticStatus.WARN, 'no robot description',
                                {})
        now, timeout = time.monotonic(), self._parameters['state_timeout']
        stale = robot.buffer.stale_joints(now, timeout)
        level = DiagnosticStatus.STALE if stale else DiagnosticStatus.OK
        age = robot.buffer.age(now)
        return self._status(
            'joint states', level, f'stale: {", ".join(stale)}' if stale else 'ok', {
                'rate [Hz]': f'{self._rate:.1f}',
                'age [s]': 'never received' if math.isinf(age) else f'{age:.3f}',
                'accepted': str(robot.buffer.accepted),
                **{f'rejected: {kind}': str(count)
                   for kind, count in sorted(robot.buffer.rejected.items())}})

    def _command(self):
        machine, limiter = self._output.channel.machine, self._output.channel.limiter
        level = DiagnosticStatus.ERROR if machine.name == 'FAULT' else DiagnosticStatus.OK
        return self._status('output', level, f'{machine.name}: {machine.reason}', {
            'state': machine.name, 'reason': machine.reason, 'topic': self._output.topic,
            'commands': str(self._output.commands),
            'saturated commands': str(limiter.saturations)})

    def _status(self, part, level, message, values):
        return DiagnosticStatus(
            name=f'{self._node.get_name()}: {part}', level=level, message=message,
            hardware_id=self._node.get_fully_qualified_name(),
            values=[KeyValue(key=key, value=value) for key, value in values.items()])
