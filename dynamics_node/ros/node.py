"""`DynamicsNode`: joint states in, gravity torque and commands out."""

import math

from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from .change_check import check_change
from .command_output import CommandOutput
from .compensation import Compensation
from .description_source import DescriptionSource
from .diagnostics import Diagnostics
from .enabling import Enabling
from .external_torque import ExternalTorque
from .guard import logged
from .hints import Hints
from .markers import Markers
from .model_settings import PER_JOINT
from .parameter_table import ParameterError
from .parameters import Parameters
from .results import Results
from .rivals import Rivals
from .robot import Robot
from .services import DynamicsServices
from .setting_services import SettingServices
from .state_input import StateInput
from .throttle import Throttle
from .trajectory_services import TrajectoryServices
from ..dynamics import RobotModel
from ..errors import DynamicsError
from ..safety import StampTolerance

# How often the node looks for other sources of efforts and states while output is on, s.
RIVALS_EVERY = 0.2


class DynamicsNode(Node):
    """Computes the dynamics of one robot from its description and its joint states."""

    def __init__(self, raw_states=False, **options):
        """
        Create everything the node consists of; the output is off.

        Parameters
        ----------
        raw_states : bool
            See `StateInput`.
        **options
            Of rclpy.node.Node.

        Raises
        ------
        ParameterError
            If a parameter on the command line or in a file is refused.
        DynamicsError
            If the description given by a parameter is refused.

        """
        super().__init__('dynamics_node', **options)
        self.logger = self.get_logger()
        self._robot = None
        self._has_states = False
        self._not_finite = Throttle(1.0)
        self.parameters = Parameters(self)
        self._results = Results(self, self.parameters)
        self._external_torque = ExternalTorque(self, self.parameters)
        self.output = CommandOutput(self, self.parameters, self._get_robot,
                                    self._output_changed)
        self._markers = Markers(self, self.parameters, self.output.channel,
                                self._ask_for_efforts)
        self.states = StateInput(self, self.parameters, self._get_robot, self.output.channel,
                                 self, raw_states)
        self._rivals = Rivals(self, self.output.topic, self.states,
                              self.parameters['allow_several_state_publishers'])
        self._enabling = Enabling(self, self.parameters, self._get_robot, self.output,
                                  self._rivals)
        self._diagnostics = Diagnostics(self, self.parameters, self._get_robot, self.states,
                                        self.output, self._external_torque)
        self._compensation = Compensation(self, self.parameters)
        self._answering = [
            DynamicsServices(self, self._get_robot, self.parameters),
            SettingServices(self, self._get_robot, self.parameters),
            TrajectoryServices(self, self._get_robot, self.parameters,
                               lambda: self.output.channel.machine.is_on)]
        self._look_for_rivals = self.create_timer(
            RIVALS_EVERY, self._stop_for_rivals, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._look_for_rivals.cancel()
        self._wants_enable = self.parameters['enable_on_start']
        self.source = DescriptionSource(self, self.parameters, self._described)
        self._hints = Hints(self, self._get_robot, self.source, self.states)
        self.parameters.watch(self._reconfigured, self._check_against_robot)
        self.create_timer(1.0, self._every_second, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def on_internal_error(self, message):
        """Stop the output: a callback on the way of the torque has failed."""
        self.output.on_internal_error(message)

    def _get_robot(self):
        return self._robot

    def _described(self, source, origin):
        # True if it was taken, or refused for good; False if it may be offered again.
        if self.output.channel.machine.is_on:
            self.logger.warning(f'new robot description from {origin} ignored: output is on; '
                                'disable it first')
            return False
        try:
            model = RobotModel.from_urdf(source)
            if not model.joint_names:
                raise DynamicsError('the robot has no joint that can be moved')
            robot = Robot(model, self.parameters['joints'])
            self._check_lengths(self.parameters.values, robot)
            robot.configure(self.parameters.values)
        except (DynamicsError, ParameterError) as error:
            if origin.startswith('parameter'):
                raise
            kept = 'the one before stays in force' if self._robot else 'still waiting for one'
            self.logger.error(f'robot description from {origin} refused, {kept}: {error}')
            return True
        # In another process; the general kernel, loaded at the start, answers meanwhile. For
        # payloads too: when one comes, the arm may float, and nothing should be started then.
        model.specialise(wait=False, loads=True)
        is_first = self._robot is None
        self._robot = robot
        self._configure(self.parameters.values)
        self._markers.prepare(robot)
        self._announce(robot, origin)
        if is_first:
            self.output.announce()
        return True

    def _announce(self, robot, origin):
        self.logger.info(f'robot description from {origin}: {robot.model}; joints: '
                         f'{", ".join(robot.joint_names)}')
        for warning in robot.model.warnings:
            self.logger.warning(warning)

    def _check_lengths(self, values, robot):
        count = len(robot.joint_names)
        for name in ('effort_limits', 'effort_rate_limits', 'effort_scale', *PER_JOINT,
                     'friction.smoothing_velocity'):
            allowed = (0, 1, count) if name == 'friction.smoothing_velocity' else (0, count)
            if len(values[name]) not in allowed:
                raise ParameterError(f'{name}: expected {count} numbers for '
                                     f'{", ".join(robot.joint_names)}, or none; got '
                                     f'{len(values[name])}')

    def _check_against_robot(self, values):
        robot, before = self._robot, self.parameters.values
        if robot is None:
            return
        self._check_lengths(values, robot)
        model = robot.configured(values, before)
        if self.output.channel.machine.is_on:
            check_change(robot, model, values, before)

    def _reconfigured(self, values, before):
        if self._robot is not None:
            self._robot.configure(values, before)
        else:
            self.source.offer_again()  # it may have been refused for a parameter
        self._configure(values)

    def _configure(self, values):
        if self._robot is not None:
            self._robot.buffer.tolerance = StampTolerance(values['state_timeout'])
        self.output.configure()
        self._external_torque.configure()
        self._ask_for_efforts()

    def _ask_for_efforts(self):
        self.states.with_effort = self._external_torque.is_on or self._markers.is_on

    def on_state(self, robot, now, stamp):
        """Compute what follows from a state that is fit for use, and publish it."""
        effort = robot.gravity_torque()
        self.output.on_effort(now, self._compensation.effort(robot, effort)
                              if self.output.channel.machine.is_driving else effort)
        if not all(map(math.isfinite, effort.tolist())):
            if self._not_finite.is_due():
                self.logger.warning('gravity torque is not finite at this joint state: not '
                                    'published')
            return
        if not self._has_states:
            # Not `once=True`: rclpy looks through the source files for the caller at every
            # call, and that took longer than everything else in the callback.
            self._has_states = True
            self.logger.info('joint states arrive: publishing gravity torque')
        self._results.publish(robot, stamp, effort)
        if self._external_torque.is_on:
            self._external_torque.on_state(robot, stamp, effort)
        self._markers.on_state(robot, stamp, effort)

    @logged
    def _every_second(self):
        # Somebody's own request, also one to disable, counts more than the parameter.
        if self._wants_enable and not self._enabling.was_asked:
            self._enabling.enable(self._enabled_on_start)
        self._hints.give()
        self.states.adapt_queue()
        self._diagnostics.measure()
        self._diagnostics.publish()

    def _enabled_on_start(self, is_accepted, text):
        self._wants_enable = not is_accepted
        if not is_accepted:
            self.logger.warning(f'enable_on_start: {text}', throttle_duration_sec=10.0)

    @logged
    def _stop_for_rivals(self):
        reasons = self._rivals.found() if self.output.channel.machine.is_driving else []
        if reasons:
            self.output.fault('; '.join(reasons))

    def _output_changed(self):
        if self.output.channel.machine.is_driving:
            # A start that begins again and again must not put the look off.
            if self._look_for_rivals.is_canceled():
                self._look_for_rivals.reset()
        else:
            self._look_for_rivals.cancel()
        self._diagnostics.publish()
