"""`DynamicsNode`: joint states in, gravity torque and commands out."""

import math
import time

from dynamics_interfaces.msg import JointDynamics
import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from .command_output import CommandOutput
from .description_source import DescriptionSource
from .diagnostics import Diagnostics
from .guard import guarded, logged
from .joint_state_reader import JointStateReader
from .listened import Listened
from .messages import to_field
from .mismatch import mismatches
from .parameter_table import ParameterError
from .parameters import Parameters
from .qos import joint_states, NO_EVENTS, NO_SUBSCRIPTION_EVENTS, RESULT
from .robot import Robot
from .services import DynamicsServices
from .throttle import Throttle
from ..dynamics import RobotModel
from ..errors import DynamicsError
from ..output import RejectedStateError

# Seconds without a description or without joint states after which the log says what to do.
PATIENCE = 5.0


class DynamicsNode(Node):
    """Computes the dynamics of one robot from its description and its joint states."""

    def __init__(self, raw_states=False, **options):
        """
        Create everything the node consists of; the output is off.

        Parameters
        ----------
        raw_states : bool
            Read joint_states by `JointStateReader` instead of rclpy.
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
        self._dropped, self._not_finite = Throttle(1.0), Throttle(1.0)
        self._start = time.monotonic()
        self.parameters = Parameters(self)
        self._gravity_publisher = self.create_publisher(JointState, '~/gravity_torque', RESULT,
                                                        event_callbacks=NO_EVENTS)
        self._dynamics_publisher = self.create_publisher(JointDynamics, '~/dynamics', RESULT,
                                                         event_callbacks=NO_EVENTS)
        self._is_gravity_wanted = Listened(self._gravity_publisher)
        self._is_dynamics_wanted = Listened(self._dynamics_publisher)
        self._states = self.create_subscription(
            JointState, 'joint_states',
            self._bytes_received if raw_states else self._joint_state_received,
            joint_states(self.parameters['allow_several_state_publishers']),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            event_callbacks=NO_SUBSCRIPTION_EVENTS, raw=raw_states)
        self._reader = JointStateReader()
        self._state_topic = self._states.topic_name
        self.output = CommandOutput(self, self.parameters, self._get_robot, self._state_topic,
                                    self._output_changed)
        self._diagnostics = Diagnostics(self, self.parameters, self._get_robot, self.output)
        self._answers = DynamicsServices(self, self._get_robot, self.parameters)
        self._wants_enable = self.parameters['enable_on_start']
        self.source = DescriptionSource(self, self.parameters, self._described)
        self.parameters.watch(self._reconfigured, self._check_against_robot)
        self.create_timer(1.0, self._every_second, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def on_internal_error(self, message):
        """Stop the output: a callback of the torque path has failed."""
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
            model = RobotModel.from_urdf(source, self.parameters['gravity'])
            if not model.joint_names:
                raise DynamicsError('the robot has no joint that can be moved')
            robot = Robot(model, self.parameters['joints'])
            self._check_against_robot(self.parameters.values, robot)
        except (DynamicsError, ParameterError) as error:
            if origin.startswith('parameter'):
                raise
            kept = 'the one before stays in force' if self._robot else 'still waiting for one'
            self.logger.error(f'robot description from {origin} refused, {kept}: {error}')
            return True
        # In another process; the general kernel, loaded at the start, answers meanwhile.
        model.specialise(wait=False)
        is_first = self._robot is None
        self._robot = robot
        self.output.configure()
        self._announce(model, robot, origin)
        if is_first:
            self.output.announce()
        return True

    def _announce(self, model, robot, origin):
        self.logger.info(f'robot description from {origin}: {model}; joints: '
                         f'{", ".join(robot.joint_names)}')
        for warning in model.warnings:
            self.logger.warning(warning)

    def _check_against_robot(self, values, robot=None):
        robot = robot or self._robot
        if robot is None:
            return
        count = len(robot.joint_names)
        for name in ('effort_limits', 'effort_rate_limits', 'effort_scale'):
            if len(values[name]) not in (0, count):
                raise ParameterError(f'{name}: expected {count} numbers for '
                                     f'{", ".join(robot.joint_names)}, or none; got '
                                     f'{len(values[name])}')
        if self.output.channel.machine.is_on and robot.unlimited_joints(values['effort_limits']):
            raise ParameterError('effort_limits: expected a limit for every joint while output '
                                 'is on, got none for '
                                 + ', '.join(robot.unlimited_joints(values['effort_limits'])))

    def _reconfigured(self, values):
        if self._robot is not None:
            self._robot.model = self._robot.model.with_gravity(values['gravity'])
        self.output.configure()

    @guarded
    def _bytes_received(self, data):
        try:
            message = self._reader.read(data)
        except Exception as error:  # no joint state: several of rclpy's exceptions say so
            self._drop(error)
            return
        self._joint_state_received(message)

    @guarded
    def _joint_state_received(self, message):
        robot = self._robot
        if robot is None:
            return
        now = time.monotonic()
        try:
            robot.buffer.update(now, message.name, message.position, message.velocity)
        except RejectedStateError as error:
            self._drop(error)
            return
        if robot.buffer.age(now) > self.parameters['state_timeout']:
            return
        effort = robot.gravity_torque()
        self.output.on_effort(now, effort)
        if not all(map(math.isfinite, effort.tolist())):
            if self._not_finite.is_due():
                self.logger.warning('gravity torque is not finite at this joint state: not '
                                    'published')
            return
        stamp = message.header.stamp
        if stamp.sec == 0 and stamp.nanosec == 0:
            stamp = self.get_clock().now().to_msg()
        if not self._has_states:
            self._first_state(stamp is not message.header.stamp)
        if self._is_gravity_wanted:
            self._publish_gravity(robot, stamp, effort)
        if self._is_dynamics_wanted and self.parameters['publish_dynamics']:
            self._publish_dynamics(robot, stamp)

    def _drop(self, error):
        if self._dropped.is_due():
            self.logger.warning(f'joint state dropped: {error}')

    def _first_state(self, has_no_stamp):
        # Not `once=True`: rclpy looks through the source files for the caller at every call,
        # and that took longer than everything else in the callback.
        self._has_states = True
        self.logger.info('joint states arrive: publishing gravity torque')
        if has_no_stamp:
            self.logger.info('joint_states has no stamp, arrival time is used')

    def _publish_gravity(self, robot, stamp, effort):
        result = JointState(name=list(robot.joint_names), effort=to_field(effort),
                            position=to_field(robot.buffer.position[robot.selection.index]))
        result.header.stamp = stamp
        self._gravity_publisher.publish(result)

    def _publish_dynamics(self, robot, stamp):
        index = robot.selection.index
        q, qd = robot.buffer.position, np.zeros(len(robot.model.joint_names))
        velocity = robot.buffer.velocity[index]
        is_known = bool(np.isfinite(velocity).all())
        if is_known:
            qd[index] = velocity
        terms = robot.model.dynamics(q, qd)
        coriolis_torque = terms.coriolis_matrix @ qd
        if not (np.isfinite(terms.mass_matrix).all() and np.isfinite(coriolis_torque).all()):
            return
        block = np.ix_(index, index)
        result = JointDynamics(
            joint_names=list(robot.joint_names), position=to_field(q[index]),
            mass_matrix=to_field(terms.mass_matrix[block]),
            gravity_torque=to_field(terms.gravity_torque[index]))
        if is_known:
            result.velocity = to_field(velocity)
            result.coriolis_matrix = to_field(terms.coriolis_matrix[block])
            result.coriolis_torque = to_field(coriolis_torque[index])
        result.header.stamp = stamp
        result.header.frame_id = robot.model.tree.root
        self._dynamics_publisher.publish(result)

    @logged
    def _every_second(self):
        # Somebody's own request, also one to disable, counts more than the parameter.
        if self._wants_enable and not self.output.was_asked:
            self._try_enable()
        self._give_hints()
        self._diagnostics.measure()
        self._diagnostics.publish()

    def _try_enable(self):
        is_accepted, text = self.output.enable()
        self._wants_enable = not is_accepted
        if not is_accepted:
            self.logger.warning(f'enable_on_start: {text}', throttle_duration_sec=10.0)

    def _give_hints(self):
        if time.monotonic() - self._start < PATIENCE:
            return
        if self._robot is None:
            self.logger.warning(
                f'no robot description on {self.source.topic} yet: start robot_state_publisher, '
                'or run with --ros-args -p robot_description_file:=robot.urdf'
                + self._unheard(self.source.subscription), throttle_duration_sec=10.0)
            return
        missing = self._robot.buffer.stale_joints(time.monotonic(), PATIENCE)
        if missing:
            self.logger.warning(
                f'no joint state on {self._state_topic} for {", ".join(missing)}: does the '
                'joint_state_broadcaster run, and are these the names of its joints? '
                '(parameter joints chooses others)' + self._unheard(self._states),
                throttle_duration_sec=10.0)

    def _unheard(self, subscription):
        return ''.join(f'; {text}' for text in mismatches(self, subscription))

    def _output_changed(self):
        self._diagnostics.publish()
