"""The command topic: output state, watchdog and the publisher itself."""

import math
import time

from dynamics_interfaces.msg import OutputState as OutputStateMessage
import numpy as np
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from std_msgs.msg import Float64MultiArray

from .guard import guarded
from .hints import unheard
from .messages import to_field
from .qos import COMMAND, NO_EVENTS, OUTPUT_STATE
from .throttle import Throttle
from ..safety import EffortOutput
from ..safety.effort_output import OutputSettings, STOP_STEP


class CommandOutput:
    """
    Connects an `EffortOutput` to ROS.

    Attributes
    ----------
    channel : EffortOutput
    commands : int
        Commands published so far.

    """

    def __init__(self, node, parameters, get_robot, on_change):
        """
        Create publishers and watchdog; the output is off.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        get_robot : callable() -> Robot or None
        on_change : callable()
            Called after every change of the output's state.

        """
        self.logger = node.get_logger()
        self._node = node
        self._parameters = parameters
        self._get_robot = get_robot
        self._on_change = on_change
        self.commands = 0
        self._message = Float64MultiArray()
        self._saturated = Throttle(1.0)
        self._publisher = node.create_publisher(
            Float64MultiArray, parameters['command_topic'], COMMAND,
            event_callbacks=NO_EVENTS)
        self._state_publisher = node.create_publisher(OutputStateMessage, '~/state', OUTPUT_STATE,
                                                      event_callbacks=NO_EVENTS)
        self.channel = EffortOutput(self._settings(), self._changed)
        # On the steady clock: it must watch while simulation time stands still.
        self._watchdog = node.create_timer(STOP_STEP, self._tick,
                                           clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._watchdog.cancel()

    @property
    def topic(self):
        """Resolved name of the command topic."""
        return self._publisher.topic_name

    def on_effort(self, now, effort):
        """Publish the command for a model effort of the chosen joints, if output is on."""
        command = self.channel.on_effort(now, effort)
        if command is not None:
            self._publish(command)
            if self.channel.limiter.is_saturated and self._saturated.is_due():
                self.logger.warning(
                    f'effort above its limit: {self.channel.limiter.saturation()}')

    def announce(self):
        """Publish the state that the output starts in: READY means that there is a model."""
        self._changed(self.channel.machine.state, self.channel.machine.reason)

    def configure(self):
        """Take over parameters and the limits of the robot in force."""
        self.channel.settings = self._settings()
        if self.channel.machine.is_on:
            self._look_within(STOP_STEP)  # the timeout may have become shorter
        robot = self._get_robot()
        if robot is None:
            return
        count = len(robot.joint_names)
        limits = robot.effort_limits(self._parameters['effort_limits'])
        self._warn_above(robot, limits)
        rates = self._parameters['effort_rate_limits']
        scale = self._parameters['effort_scale']
        self.channel.set_limiter(limits, np.array(rates) if rates else limits / 0.1,
                                 np.array(scale) if scale else np.ones(count),
                                 robot.joint_names)

    def _warn_above(self, robot, limits):
        of_urdf = robot.effort_limits(())
        above = [f'{name}: {limit:g}, in the URDF {most:g}' for name, limit, most in zip(
            robot.joint_names, limits, of_urdf, strict=True) if limit > most]
        if above:
            self.logger.warning('effort_limits are above those of the URDF: ' + '; '.join(above))

    def stop(self, reason, is_fault=False, within=None):
        """Begin to stop; see `EffortOutput.stop`."""
        self.channel.stop(time.monotonic(), reason, is_fault, within)

    def fault(self, reason):
        """Stop an output that is on, because the arm must not be driven any further."""
        self.channel.fault(time.monotonic(), reason)

    def on_internal_error(self, message):
        """Stop after an exception in a callback of the torque path."""
        self.stop(message, is_fault=True)

    def flush(self, timeout):
        """Wait until everybody who listens has the last command, at most `timeout` seconds."""
        self._publisher.wait_for_all_acked(Duration(seconds=timeout))

    def begin(self, notes=()):
        """
        Switch the output on; whether it may be has been found out before.

        Parameters
        ----------
        notes : sequence of str
            What there is to know besides.

        Returns
        -------
        str
            What was done, for people.

        """
        notes = list(notes)
        if self._publisher.get_subscription_count() == 0:
            # Before the output is on: to look through all topics takes time.
            notes.append(unheard(self._node, self._publisher))
        self.channel.enable(time.monotonic())
        if notes:
            self.logger.warning('; '.join(notes))
        return f'enabled: efforts go to {self.topic}' + ''.join(f', but {n}' for n in notes)

    @guarded
    def _tick(self):
        now = time.monotonic()
        robot = self._get_robot()
        age = robot.buffer.age(now) if robot else math.inf
        command = self.channel.tick(now, age)
        if command is not None:
            self._publish(command)
        if self.channel.machine.is_on:
            self._look_again_in(self.channel.next_look(age))

    def _look_within(self, seconds):
        # Never later than was planned: what comes again and again, like a flood of parameters,
        # would otherwise put the look off for ever.
        planned = self._watchdog.time_until_next_call()
        if planned is None or planned > seconds * 1e9:
            self._look_again_in(seconds)

    def _look_again_in(self, seconds):
        # Only when a state can have become stale, or a stop goes on: a timer that runs at a
        # fixed rate instead costs as much as a stream of joint states of that rate.
        self._watchdog.timer_period_ns = math.ceil(seconds * 1e9)
        self._watchdog.reset()

    def _publish(self, command):
        self._message.data = to_field(command)
        self._publisher.publish(self._message)
        self.channel.published(time.monotonic())
        self.commands += 1

    def _changed(self, state, reason):
        if self.channel.machine.is_on:
            self._look_within(STOP_STEP)
        else:
            self._watchdog.cancel()
        message = OutputStateMessage(state=int(state), name=state.name, reason=reason)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._state_publisher.publish(message)
        # Two lines, because rclpy ties the severity to the line that logs.
        if state.name == 'FAULT':
            self.logger.error(f'output FAULT: {reason}; ~/enable tries again')
        else:
            self.logger.info(f'output {state.name}: {reason}')
        self._on_change()

    def _settings(self):
        return OutputSettings(**{name: self._parameters[name] for name in (
            'state_timeout', 'start_ramp', 'stop_ramp', 'stop_behavior')})
