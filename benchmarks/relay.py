"""
The bare nodes that the node is compared with: plain rclpy, as a person would write them first.

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
    """Passes the positions of joint_states on as a command of the same size."""

    def __init__(self):
        """Create one subscription and one publisher."""
        super().__init__('relay')
        self.commands = self.create_publisher(
            Float64MultiArray, 'forward_effort_controller/commands', RELIABLE
        )
        self.create_subscription(JointState, 'joint_states', self.received, BEST_EFFORT)

    def received(self, message):
        """Send what came."""
        self.commands.publish(Float64MultiArray(data=message.position))


class TriggerServer(Node):
    """Answers the smallest service that there is."""

    def __init__(self):
        """Create one service."""
        super().__init__('relay')
        self.create_service(Trigger, '~/trigger', self.answer)

    def answer(self, request, response):
        """Say yes."""
        response.success = True
        response.message = 'triggered'
        return response


class TrajectoryServer(Node):
    """Answers with the trajectory that it was sent, and that is all."""

    def __init__(self):
        """Create one service."""
        super().__init__('relay')
        self.create_service(ComputeTrajectoryEffort, '~/trajectory', self.answer)

    def answer(self, request, response):
        """Send what came."""
        response.success = True
        response.trajectory = request.trajectory
        return response


class TorqueSource(Node):
    """Publishes a torque as soon as it runs: what starting a node costs at the least."""

    def __init__(self):
        """Create one publisher, and begin."""
        super().__init__('relay')
        self.torques = self.create_publisher(JointState, '~/gravity_torque', RELIABLE)
        self.create_timer(0.01, self.publish)

    def publish(self):
        """Send eight zeros."""
        self.torques.publish(JointState(effort=[0.0] * 8))


def main():
    """Run the node that the first argument names until SIGINT or SIGTERM."""
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
