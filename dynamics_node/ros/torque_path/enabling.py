"""The service ~/enable: all checks before efforts are sent to the arm."""

from __future__ import annotations

from collections.abc import Mapping
import time
import traceback
from typing import Any, TYPE_CHECKING

import numpy as np
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.task import Future
from std_srvs.srv import SetBool

from .controller_check import ANSWER_WITHIN, Controllers
from ..context import NodeContext
from ..support.hints import no_subscriber_hint
from ...safety import OutputState, self_compensating

if TYPE_CHECKING:
    from .active_robot import ActiveRobot
    from .command_output import CommandOutput
    from .publisher_monitor import PublisherMonitor
    from ..support.description_source import DescriptionSource

# Period of the check for answers of the controllers, s.
ANSWER_PERIOD = 0.02
# Share of the effort limit above which a measured effort comes from another source.
IN_FORCE = 0.05


class Enabling:
    """
    Switches the output on if every check passes, and off.

    Attributes
    ----------
    was_asked : bool
        Whether ~/enable has been called, with true or false.

    """

    def __init__(
        self,
        context: NodeContext,
        output: CommandOutput,
        monitor: PublisherMonitor,
        controllers: Controllers,
        source: DescriptionSource,
    ) -> None:
        """
        Create the service.

        Parameters
        ----------
        context : NodeContext
        output : CommandOutput
        monitor : PublisherMonitor
        controllers : Controllers
        source : DescriptionSource

        """
        self.logger = context.logger
        self.was_asked = False
        self._context = context
        self._node = context.node
        self._parameters = context.parameters
        self._output = output
        self._path = output.path
        self._monitor = monitor
        self._controllers = controllers
        self._source = source
        self._answers: Future | None = None
        self._canceled = 0
        # Not in the group of the joint states, which continue while the answer waits for the
        # controllers. Nor in that of the other services, which may wait: this one stops the arm.
        context.node.create_service(
            SetBool, '~/enable', self._requested, callback_group=ReentrantCallbackGroup()
        )

    async def enable(self) -> tuple[bool, str]:
        """
        Switch the output on if every check passes.

        Returns
        -------
        success : bool
        message : str
            The result with its notes, or every reason for the refusal.

        """
        if answer := self._already():
            return answer
        self._source.offer_pending()  # a description received while the output was on
        if reasons := self.refusals():
            return False, _refused(reasons)
        robot_before, canceled = self._context.robot, self._canceled
        await self._ask_controllers()
        if canceled != self._canceled:
            return False, 'disabled on request before it was enabled'
        if answer := self._already():  # by another request meanwhile
            return answer
        # All checks again: time has passed.
        robot = self._context.robot
        reasons = self.refusals()
        if robot is not robot_before:
            reasons.append(
                'the robot description has changed while the controllers were asked: ask again'
            )
        elif robot is not None:
            reasons += self._controllers.refusals(robot.joint_names)
        if reasons or robot is None:
            return False, _refused(reasons)
        return True, self._begin(robot)

    def disable(self) -> tuple[bool, str]:
        """
        Switch the output off, or release the efforts in force.

        Returns
        -------
        success : bool
        message : str

        """
        self._canceled += 1
        state = self._path.state
        lost = [
            reason for item in self._controllers.listeners.values() for reason in item.inactive()
        ]
        if not self._path.is_on and self._path.output.has_effort_in_force and lost:
            return False, (
                'the last efforts may be in force at the hardware ('
                + self._path.output.limiter.describe_last()
                + '), and '
                + '; '.join(lost)
            )
        if not self._path.disable(time.monotonic(), 'disabled on request'):
            if state == OutputState.STOPPING:
                return True, 'stopping already'
            return True, f'already off: {state.name}'
        was_off = state in (OutputState.HOLDING, OutputState.FAULT)
        return True, 'releasing the efforts in force' if was_off else 'stopping'

    def refusals(self) -> list[str]:
        """Return every reason against enabling the output now."""
        if self._path.is_closed:
            return ['the node is shutting down']
        robot, values = self._context.robot, self._parameters.values
        if robot is None:
            return ['no robot description yet']
        return (
            self._about_states(robot, values)
            + self._about_limits(robot, values)
            + self._about_robot(robot, values)
            + self._monitor.conflicts()
            + self._monitor.description_conflicts()
        )

    def _about_states(self, robot: ActiveRobot, values: Mapping[str, Any]) -> list[str]:
        timeout = values['state_timeout']
        stale = robot.buffer.stale_joints(time.monotonic(), timeout)
        if stale:
            dropped = ', '.join(
                f'{count} for {kind}' for kind, count in robot.buffer.rejected.most_common()
            )
            return [
                f'no joint state within {timeout:g} s for {", ".join(stale)}'
                + (f' (dropped so far: {dropped})' if dropped else '')
            ]
        if not robot.is_mass_matrix_positive_definite():
            return [
                'the mass matrix is not positive definite: check the <inertial> of the '
                'moving links'
            ]
        over = robot.over_limits(values) if values['compensate.gravity'] else ''
        reasons = (
            [
                f'the arm cannot hold itself where it is, gravity torque is above the effort '
                f'limit: {over}; move it, or raise effort_limits'
            ]
            if over
            else []
        )
        if fast := robot.buffer.runaway():
            reasons.append(f'the arm moves faster than velocity_limits: {fast}')
        return reasons

    def _about_limits(self, robot: ActiveRobot, values: Mapping[str, Any]) -> list[str]:
        reasons = []
        unlimited = robot.unlimited_joints(values['effort_limits'])
        if unlimited:
            reasons.append(
                f'no effort limit for {", ".join(unlimited)}: set the parameter effort_limits'
            )
        above = robot.above_urdf(values)
        if above and not values['allow_limits_above_urdf']:
            reasons.append(f'{above}: lower it, or set allow_limits_above_urdf')
        return reasons

    def _about_robot(self, robot: ActiveRobot, values: Mapping[str, Any]) -> list[str]:
        reasons = []
        plugins = self_compensating(robot.model.tree.hardware_plugins)
        if plugins and not values['allow_self_compensating_arm']:
            reasons.append(
                f'the URDF names the hardware plugin {", ".join(plugins)}, which compensates '
                'gravity itself: a second gravity torque would push the arm up; use '
                '~/gravity_torque and the services there, or set allow_self_compensating_arm if '
                'this arm floats only with an effort'
            )
        if values['gravity'][2] > 0.0 and not values['allow_upward_gravity']:
            reasons.append(
                f'gravity {list(values["gravity"])} points up in the frame of '
                f'{robot.model.tree.root}: turn it (it must point to the earth), or '
                'set allow_upward_gravity if the arm hangs from a ceiling'
            )
        return reasons

    async def _requested(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        self.was_asked = True
        try:
            answer = await self.enable() if request.data else self.disable()
        except Exception as error:
            self.logger.error(f'~/enable: {error}\n{traceback.format_exc()}')
            self._output.on_internal_error(f'internal error in ~/enable: {error}')
            answer = False, f'internal error: {error}'
        response.success, response.message = answer
        return response

    def _already(self) -> tuple[bool, str] | None:
        state = self._path.state
        if self._path.is_driving:
            return True, f'already enabled: {state.name}'
        if self._path.is_on:
            return False, 'still stopping: ask again when the state is READY'
        return None

    async def _ask_controllers(self) -> None:
        # One query serves all requests that wait.
        if self._answers is None:
            self._controllers.ask_again()
            self._answers = answers = Future()
            timer = self._node.create_timer(
                ANSWER_PERIOD, self._check_answers, clock=Clock(clock_type=ClockType.STEADY_TIME)
            )
            self._until = time.monotonic() + ANSWER_WITHIN
            self._check_answers()
            try:
                await answers
            finally:
                self._answers = None
                self._node.destroy_timer(timer)
        else:
            await self._answers

    def _check_answers(self) -> None:
        answers = self._answers
        if answers is None or answers.done():
            return
        try:
            self._controllers.update()
            if time.monotonic() < self._until and self._controllers.is_waiting():
                return
            answers.set_result(None)
        except Exception as error:
            answers.set_exception(error)

    def _begin(self, robot: ActiveRobot) -> str:
        notes = self._controllers.notes() + self._notes(robot)
        topic = self._output.topic
        if not self._controllers.has_listener() and not self._output.has_listener():
            # Before the output is on, because the search through all topics takes time.
            notes.append(no_subscriber_hint(self._node, self._output.publisher))
        if not self._output.enable():
            return 'the node is shutting down'
        if notes:
            self.logger.warning('; '.join(notes))
        ramp = self._parameters['start_ramp']
        return (
            f'enabled: full effort in {ramp:g} s (start_ramp), on {topic}; release brakes '
            'when ~/state is ACTIVE, not before' + ''.join(f'; but {note}' for note in notes)
        )

    def _notes(self, robot: ActiveRobot) -> list[str]:
        values, notes = self._parameters.values, []
        names = robot.joints_without_velocity_limit(values['velocity_limits'])
        if names:
            notes.append(
                f'jumps and runaway of {", ".join(names)} are not detected: the URDF has '
                'no velocity limit there; set velocity_limits'
            )
        if names := robot.buffer.joints_without_velocity():
            notes.append(
                f'joint_states have no velocity of {", ".join(names)}: a runaway is '
                'detected only by jumps of the position'
            )
        notes += [
            text.lstrip('; ')
            for text in (
                robot.unseen_others(
                    robot.selection.index, time.monotonic(), values['state_timeout']
                ),
            )
            if text
        ]
        if robot.refused_since:
            notes.append(
                f'a newer robot description was refused ({robot.refused_since}): the '
                'model before is used'
            )
        return notes + self._in_force(robot, values)

    def _in_force(self, robot: ActiveRobot, values: Mapping[str, Any]) -> list[str]:
        # Efforts of another process may hold the arm now; the first command, which is near zero,
        # replaces them.
        if self._path.output.limiter.last.any():
            return []  # efforts of this node, from which the ramp begins
        effort, limits = robot.buffer.needed_effort, robot.effort_limits(values['effort_limits'])
        applied = [
            f'{name}: {value:.4g}'
            for name, value, limit in zip(robot.joint_names, effort, limits, strict=True)
            if np.abs(value) > IN_FORCE * limit
        ]
        return (
            [
                f'joint_states report efforts that this node has not sent ({", ".join(applied)}): '
                'if a controller still holds them, they drop to zero with the first command, so '
                'keep the brakes on until ~/state is ACTIVE'
            ]
            if applied
            else []
        )


def _refused(reasons: list[str]) -> str:
    return 'refused: ' + '; '.join(reasons)
