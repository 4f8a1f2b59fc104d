"""`DynamicsNode`: joint states in, gravity torque and commands out."""

from __future__ import annotations

from collections.abc import Mapping
import math
import time
from typing import Any, TYPE_CHECKING

import numpy as np
from rclpy.node import Node

from .context import NodeContext
from .parameters.live_change_check import check_change
from .parameters.parameters import Parameters
from .parameters.table import check_lengths
from .publishers.diagnostics import Diagnostics
from .publishers.external_torque import ExternalTorque
from .publishers.result_publishers import ResultPublishers
from .services.payload_gravity_services import PayloadGravityServices
from .services.state_services import StateServices
from .services.trajectory_services import TrajectoryServices
from .support.callback_errors import logged
from .support.callback_groups import ServiceGroup
from .support.description_source import DescriptionSource
from .support.hints import Hints
from .support.throttling import Throttle
from .torque_path.active_robot import ActiveRobot, read_robot
from .torque_path.command_output import CommandOutput, output_settings
from .torque_path.controller_check import Controllers
from .torque_path.enabling import Enabling
from .torque_path.joint_state_input import JointStateInput
from .torque_path.protection import Protection
from .torque_path.publisher_monitor import PublisherMonitor
from ..errors import DynamicsError
from ..safety import EffortLimiter, GravityChange

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

# Period of the search for other publishers and controllers, s. It runs after a joint state,
# because a separate wake-up costs as much as a state, or else at the next tick of the output.
CHECK_EVERY = 0.2
# Period of diagnostics and hints, s.
SECOND = 1.0
# Shortest time between two warnings about joints that are not measured, s.
SILENT_EVERY = 10.0


class DynamicsNode(Node):
    """Computes the dynamics of one robot from its description and its joint states."""

    def __init__(self, raw_states: bool = False, **options: Any) -> None:
        """
        Create all parts of the node; the output is off.

        Parameters
        ----------
        raw_states : bool
            See `JointStateInput`.
        **options
            Of rclpy.node.Node.

        Raises
        ------
        ParameterError
            If a parameter on the command line or in a file is refused.
        DynamicsError
            If the description given by a parameter is refused.

        """
        # Needed when rclpy creates the parameter services, inside its constructor.
        self.service_group = ServiceGroup(self._is_driving)
        super().__init__('dynamics_node', **options)
        self.logger = self.get_logger()
        self._has_states = False
        self._next_check = self._next_second = 0.0
        self._not_finite, self._silent = Throttle(1.0), Throttle(SILENT_EVERY)
        self._gravity_change = GravityChange()
        self.parameters = Parameters(self)
        self._shared = context = NodeContext(self, self.parameters)
        self._results = ResultPublishers(context)
        self._external_torque = ExternalTorque(context)
        self.output = CommandOutput(context, self._output_changed, self._check_if_due)
        self.path = self.output.path
        self.states = JointStateInput(context, self.output, self, raw_states)
        self._wants_enable = self.parameters['enable_on_start']
        self.source = DescriptionSource(context, self._described)
        monitor = PublisherMonitor(context, self.output.topic, self.states, self.source)
        controllers = Controllers(self, self.output.topic)
        self._enabling = Enabling(context, self.output, monitor, controllers, self.source)
        self._diagnostics = Diagnostics(context, self.states, self.output, self._external_torque)
        self._robot_services = [
            StateServices(context),
            PayloadGravityServices(context),
            TrajectoryServices(context, self.path),
        ]
        self._hints = Hints(context, self.source, self.states)
        self.parameters.watch(self._reconfigured, self._check_against_robot)
        self._protection = Protection(context, self.output, monitor, controllers)
        self.source.begin()

    def create_service(self, *arguments: Any, callback_group: Any = None, **options: Any) -> Any:
        """Create a service as rclpy does, by default in the `ServiceGroup` of the node."""
        return super().create_service(
            *arguments, callback_group=callback_group or self.service_group, **options
        )

    def on_internal_error(self, message: str) -> None:
        """Stop the output after an exception in a callback of the torque path."""
        self.output.on_internal_error(message)

    def _is_driving(self):
        return self.path.is_driving

    def _described(self, source: str | bytes, origin: str) -> bool:
        # Returns True if the description was accepted or refused, False if it has to wait.
        if self.path.is_on:
            self.logger.warning(
                f'new robot description from {origin} waits until the output is '
                'off: disable it to take the description'
            )
            return False
        try:
            robot = read_robot(source, self.parameters.values)
            check_lengths(self.parameters.values, robot.joint_names)
            robot.configure(self.parameters.values)
        except DynamicsError as error:
            if origin.startswith('parameter'):
                raise
            kept = 'still waiting for one'
            if self._shared.robot is not None:
                kept = 'the one before stays in force'
                self._shared.robot.refused_since = str(error)
            self.logger.error(f'robot description from {origin} refused, {kept}: {error}')
            return True
        if self.parameters['machine_code']:
            # In another process; until then the general kernel answers. Also for payloads, because
            # no process should be started when one is set and the arm floats.
            robot.model.specialize(wait=False, with_payload_code=True)
        is_first = self._shared.robot is None
        self._shared.robot = robot
        self.path.use(robot.buffer)
        self._configure(self.parameters.values)
        self._announce(robot, origin)
        if is_first:
            self.output.announce()
        return True

    def _announce(self, robot: ActiveRobot, origin: str) -> None:
        self.logger.info(
            f'robot description from {origin}: {robot.model}; joints: '
            f'{", ".join(robot.joint_names)}'
        )
        for warning in robot.model.warnings:
            self.logger.warning(warning)

    def _check_against_robot(self, values: Mapping[str, Any]) -> None:
        robot, before = self._shared.robot, self.parameters.values
        if robot is None:
            return
        check_lengths(values, robot.joint_names)
        model = robot.configured(values, before)
        if self.path.is_on:
            check_change(robot, model, values, before, self._gravity_change, time.monotonic())

    def _reconfigured(self, values: Mapping[str, Any], before: Mapping[str, Any]) -> None:
        if self._shared.robot is not None:
            self._shared.robot.configure(values, before)
            if values['gravity'] != before['gravity']:
                self._gravity_change.accept(time.monotonic(), values['gravity'])
        else:
            self.source.offer_again()  # a parameter may have been the reason for its refusal
        self._configure(values)

    def _configure(self, values: Mapping[str, Any]) -> None:
        robot = self._shared.robot
        if robot is not None:
            self.path.configure(
                time.monotonic(),
                output_settings(values),
                robot.compensation(values),
                effort_limiter(robot, values),
                robot.motion_limits(values['velocity_limits']),
            )
        self.output.configured()
        self._external_torque.configure()

    def on_state(self, stamp: Time) -> None:
        """
        Publish the results of a joint state, after its command.

        Parameters
        ----------
        stamp : builtin_interfaces.msg.Time
            Of the joint state, or of its arrival.

        """
        robot, effort = self._shared.robot, self.path.gravity_torque
        assert robot is not None  # without a robot there is no state
        if not all(map(math.isfinite, effort.tolist())):
            if self._not_finite.is_due():
                self.logger.warning(
                    'gravity torque is not finite at this joint state: not published'
                )
            return
        if not self._has_states:
            # Not `once=True`: rclpy searches the source files for the caller at every call, which
            # took longer than the rest of the callback.
            self._has_states = True
            self.logger.info('joint states arrive: publishing gravity torque')
        self._results.publish(robot, stamp, effort)
        if self._external_torque.is_on:
            self._external_torque.on_state(robot, stamp, effort)
        self._check_if_due()

    def _check_if_due(self):
        now = time.monotonic()
        # A new controller receives the whole effort until the check has found it.
        if now < self._next_check and not self.output.has_new_listener():
            return
        self._next_check = now + CHECK_EVERY
        self._protection.check()
        if now >= self._next_second:
            self._next_second = max(self._next_second, now - CHECK_EVERY) + SECOND
            self._every_second()

    @logged
    def _every_second(self):
        # A request to ~/enable, also to disable, overrides the parameter.
        if self._wants_enable and not self._enabling.was_asked and self.executor is not None:
            self.executor.create_task(self._enable_on_start)
        if not self.path.is_on:
            self.source.offer_pending()  # a description received while the output was on
        self._hints.give()
        self.states.adapt_queue()
        if self._shared.robot is not None:
            self._shared.robot.state_publishers = self.states.publishers
            self._warn_of_silent_joints(self._shared.robot)
        self._diagnostics.measure()
        self._diagnostics.publish()

    def _warn_of_silent_joints(self, robot: ActiveRobot) -> None:
        # They get no effort, but gravity depends on their positions.
        silent = self.path.is_driving and robot.stale_others(
            robot.selection.index, time.monotonic(), self.parameters['state_timeout']
        )
        if silent and self._silent.is_due():
            self.logger.warning(
                f'joint_states do not contain {", ".join(silent)}: the efforts '
                'take such a joint where it was last measured, or neutral'
            )

    async def _enable_on_start(self):
        try:
            is_accepted, text = await self._enabling.enable()
        except Exception as error:
            is_accepted, text = False, f'internal error: {error}'
            self.on_internal_error(text)
        self._wants_enable = not is_accepted
        if not is_accepted:
            self.logger.warning(f'enable_on_start: {text}', throttle_duration_sec=10.0)

    def _output_changed(self):
        if self.path.is_driving:
            self._gravity_change.begin(time.monotonic(), self.parameters['gravity'])
        self._diagnostics.publish()


def effort_limiter(robot: ActiveRobot, values: Mapping[str, Any]) -> EffortLimiter:
    """
    Return the `EffortLimiter` of the parameters; without rate limits, full effort takes 0.1 s.

    Parameters
    ----------
    robot : ActiveRobot
    values : mapping of str to Any
        Of the parameters.

    """
    limits = robot.effort_limits(values['effort_limits'])
    rates, scale = values['effort_rate_limits'], values['effort_scale']
    offset = values['effort_offset']
    return EffortLimiter(
        limits,
        np.array(rates) if rates else limits / 0.1,
        np.array(scale) if scale else np.ones(len(limits)),
        robot.joint_names,
        np.array(offset) if offset else None,
    )
