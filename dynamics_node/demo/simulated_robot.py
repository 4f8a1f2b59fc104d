"""
A simulated robot with the ROS interface of an arm behind ros2_control, driven by efforts.

It behaves like joint_state_broadcaster and forward_command_controller: joint states in
alphabetical order, the last command stays in force, commands are not clamped.

"""

import math
from pathlib import Path
import signal
import sys
import time
from typing import Any

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import SetBool, Trigger

from .missing_values import add_missing_damping
from .mujoco_arm import MujocoArm, UnstableError
from .mujoco_model import TIME_STEP
from .poses import plan_push, start_pose
from .processes import arm7_path, read_robot
from .robot_text import robot_name, RobotRefusedError
from .timing import ClockOffset, Pacer
from .viewer import add_scenery, check_display, open_viewer

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
VIEWER_PERIOD = 1 / 30  # [s]


class SimulatedRobot(Node):
    """Runs the simulation in real time, with topics and services."""

    def __init__(self, view: bool = False) -> None:
        """Load the robot, engage the brakes, start publishing."""
        super().__init__('simulated_robot')
        self._declare_parameters(view)
        text = read_robot(Path(self._value('robot_description_file') or arm7_path()))
        self.arm = self._build(text)
        self._start = self._start_pose(text)
        self.arm.place(self._start)
        self._command_rows = self._rows_of(self._value('joints') or self.arm.driven_names)
        self._connect(text)
        self._pacer = Pacer(TIME_STEP, time.monotonic())
        self._clock_offset = ClockOffset(
            lambda: self.get_clock().now().nanoseconds, time.monotonic_ns
        )
        self._viewer = self._open_viewer()
        self._next_view = 0.0
        self.get_logger().info(
            f'{robot_name(text)} is on its brakes; command order: '
            f'{", ".join(self._command_names())}'
        )

    def _declare_parameters(self, view: bool) -> None:
        """Declare the parameters; arrays without a default are empty."""
        self.declare_parameter('robot_description_file', '')
        self.declare_parameter('rate', 500.0)
        self.declare_parameter('view', view)
        self.declare_parameter('push_duration', 0.25)
        self.declare_parameter('start_pose', Parameter.Type.DOUBLE_ARRAY)
        self.declare_parameter('push_force', Parameter.Type.DOUBLE_ARRAY)
        self.declare_parameter('joints', Parameter.Type.STRING_ARRAY)

    def _value(self, name: str) -> Any:
        """Return a parameter's value; an empty list for an unset array."""
        value = self.get_parameter_or(name, None)
        return [] if value is None or value.value is None else value.value

    def _build(self, text: str) -> MujocoArm:
        """Return the robot; log damping that its URDF lacks."""
        is_viewed = self._value('view')
        if is_viewed:
            check_display()
        arm = MujocoArm(text, add_scenery if is_viewed else None)
        added = add_missing_damping(arm)
        if added:
            self.get_logger().warning(
                'the URDF states practically no damping for these joints, '
                f'added some viscous friction: {"; ".join(added)}'
            )
        return arm

    def _start_pose(self, text: str) -> Any:
        """Return the start pose: the parameter's, or one chosen for the robot."""
        pose = self._value('start_pose')
        if not len(pose):
            return start_pose(self.arm, robot_name(text))
        names = self.arm.driven_names
        if len(pose) != len(names) or not all(map(math.isfinite, pose)):
            raise RobotRefusedError(
                f'start_pose: expected {len(names)} finite numbers for '
                f'{", ".join(names)}, got {list(pose)}'
            )
        return list(pose)

    def _rows_of(self, joints: list[str]) -> list[int]:
        """Return the row of each commanded joint among the driven ones."""
        names = self.arm.driven_names
        wrong = [joint for joint in joints if joint not in names]
        if wrong or len(set(joints)) != len(joints):
            raise RobotRefusedError(
                f'joints: expected different ones out of {", ".join(names)}, '
                f'got {", ".join(joints)}'
            )
        return [names.index(joint) for joint in joints]

    def _command_names(self) -> list[str]:
        """Return the joints of a command in its order."""
        return [self.arm.driven_names[row] for row in self._command_rows]

    def _connect(self, text: str) -> None:
        """Create publishers, the subscription, services and the timer."""
        self._order = sorted(range(len(self.arm.joints)), key=lambda i: self.arm.names[i])
        self._names = [self.arm.names[i] for i in self._order]
        self._description = self.create_publisher(String, 'robot_description', LATCHED)
        self._description.publish(String(data=text))
        self._states = self.create_publisher(JointState, 'joint_states', 10)
        self.create_subscription(
            Float64MultiArray, 'forward_effort_controller/commands', self._on_command, 1
        )
        self.create_service(SetBool, '~/set_brakes', self._on_set_brakes)
        self.create_service(Trigger, '~/reset', self._on_reset)
        self.create_service(Trigger, '~/push', self._on_push)
        rate = self._value('rate')
        if not 1.0 <= rate <= 1000.0:
            raise RobotRefusedError(f'rate: expected 1 to 1000 Hz, got {rate}')
        # Steady: a clock correction or a paused /clock does not stop the physics.
        self.create_timer(1.0 / rate, self._tick, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _open_viewer(self) -> Any | None:
        """Return the viewer if the parameter asks for it."""
        return open_viewer(self.arm) if self._value('view') else None

    def _tick(self) -> None:
        """Advance the simulation to the current time and publish."""
        now = time.monotonic()
        steps = self._pacer.steps_due(now)
        try:
            self.arm.step(steps)
        except UnstableError as error:
            self.get_logger().error(str(error))
        if steps:
            self._publish()
        if self._viewer is not None and now >= self._next_view:
            self._viewer.sync()
            self._next_view = now + VIEWER_PERIOD

    def _publish(self) -> None:
        """Publish the joint states in alphabetical order."""
        message = JointState(name=self._names)
        message.header.stamp = self._simulated_time().to_msg()
        message.position = self.arm.position[self._order].tolist()
        message.velocity = self.arm.velocity[self._order].tolist()
        message.effort = self.arm.effort[self._order].tolist()
        self._states.publish(message)

    def _simulated_time(self) -> Time:
        """
        Return the time of the simulated state, not that of its publication.

        Accelerations and momenta derived from the states need the arm's own time: an error of
        half a millisecond is a quarter of the time between two states.

        """
        nanoseconds = round(self._pacer.simulated_to * 1e9) + self._clock_offset.now()
        return Time(nanoseconds=nanoseconds, clock_type=self.get_clock().clock_type)

    def _on_command(self, message: Float64MultiArray) -> None:
        """Apply a command until the next one."""
        command, wanted = message.data, len(self._command_rows)
        if len(command) != wanted or not all(map(math.isfinite, command)):
            self.get_logger().error(
                f'command ignored: expected {wanted} finite numbers for '
                f'{", ".join(self._command_names())}, got {len(command)} values: '
                f'{list(command[:wanted])}',
                throttle_duration_sec=1.0,
            )
            return
        effort = [0.0] * len(self.arm.driven)
        for row, value in zip(self._command_rows, command):
            effort[row] = value
        self.arm.set_effort(effort)

    def _on_set_brakes(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        """Engage or release the brakes."""
        if self.arm.gliding:
            response.message = 'the robot is on its way to the start pose; try again when it is'
            return response
        self.arm.set_brakes(request.data)
        response.success = True
        response.message = 'brakes engaged' if request.data else 'brakes released'
        return response

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Start a motion to the start pose, within the velocity limits."""
        duration = self.arm.glide_to(self._start)
        response.success = True
        response.message = f'brakes engaged, at the start pose in {duration:.1f} s'
        return response

    def _on_push(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Push the last link."""
        if self.arm.braked:
            response.message = 'the brakes are engaged; release them with ~/set_brakes first'
            return response
        duration, force = self._value('push_duration'), self._value('push_force')
        if not len(force):
            force = plan_push(self.arm, self.arm.driven_position, duration)
        self.arm.push(force, duration)
        response.success = True
        response.message = (
            f'pushed with ({force[0]:.1f}, {force[1]:.1f}, {force[2]:.1f}) N for {duration:.2f} s'
        )
        return response

    def close(self) -> None:
        """Close the viewer."""
        if self._viewer is not None:
            self._viewer.close()


class StopRequest:
    """Notes SIGINT or SIGTERM: the main loop then ends, with exit code 0."""

    def __init__(self) -> None:
        """Replace the signal handlers of Python."""
        self.came = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._on_signal)

    def _on_signal(self, number: int, frame: Any) -> None:
        """Note the first signal; ignore the second one that launch sends after Ctrl-C."""
        self.came = True
        for other in (signal.SIGINT, signal.SIGTERM):
            signal.signal(other, signal.SIG_IGN)


def main(args: list[str] | None = None) -> int:
    """Run the simulated robot until SIGINT or SIGTERM; return the exit code."""
    stop = StopRequest()
    arguments = sys.argv if args is None else args
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    try:
        robot = SimulatedRobot(view='--view' in remove_ros_args(arguments))
        executor = SingleThreadedExecutor()
        executor.add_node(robot)
        while not stop.came:
            executor.spin_once(timeout_sec=0.1)
        robot.close()
    except RobotRefusedError as error:
        print(f'simulated_robot: {error}', file=sys.stderr)
        return 1
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
