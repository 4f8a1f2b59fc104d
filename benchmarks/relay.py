"""
Minimal nodes in plain rclpy, as a reference for the node.

    python -m benchmarks.relay states | trigger | trajectory | torque [--ros-args ...]

"""

import sys

from dynamics_interfaces.srv import ComputeTrajectoryEffort
import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

BEST_EFFORT = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE)


class StatesRelay(Node):
    """Publishes the positions of joint_states as a command."""

    def __init__(self):
        super().__init__('relay')
        self.commands = self.create_publisher(
            Float64MultiArray, 'forward_effort_controller/commands', RELIABLE
        )
        self.create_subscription(JointState, 'joint_states', self.received, BEST_EFFORT)

    def received(self, message):
        """Publish the positions."""
        self.commands.publish(Float64MultiArray(data=message.position))


class TriggerServer(Node):
    """Serves std_srvs/Trigger."""

    def __init__(self):
        super().__init__('relay')
        self.create_service(Trigger, '~/trigger', self.answer)

    def answer(self, request, response):
        """Return success."""
        response.success = True
        response.message = 'triggered'
        return response


class TrajectoryServer(Node):
    """Serves ComputeTrajectoryEffort by returning the request."""

    def __init__(self):
        super().__init__('relay')
        self.create_service(ComputeTrajectoryEffort, '~/trajectory', self.answer)

    def answer(self, request, response):
        """Return the received trajectory."""
        response.success = True
        response.trajectory = request.trajectory
        return response


class TorqueSource(Node):
    """Publishes a torque as soon as it runs: the least start time of a node."""

    def __init__(self):
        super().__init__('relay')
        self.torques = self.create_publisher(JointState, '~/gravity_torque', RELIABLE)
        self.create_timer(0.01, self.publish)

    def publish(self):
        """Publish eight zeros."""
        self.torques.publish(JointState(effort=[0.0] * 8))


def main():
    """Run the node of the first argument until SIGINT or SIGTERM."""
    kind = {
        'states': StatesRelay,
        'trigger': TriggerServer,
        'trajectory': TrajectoryServer,
        'torque': TorqueSource,
    }[sys.argv[1]]
    rclpy.init(args=sys.argv)
    try:
        rclpy.spin(kind())
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
