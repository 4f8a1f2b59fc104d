"""Quality of service of every topic, in one place."""

from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy


def _newest(reliability, durability=QoSDurabilityPolicy.VOLATILE):
    return QoSProfile(history=QoSHistoryPolicy.KEEP_LAST, depth=1, reliability=reliability,
                      durability=durability)


# An old joint state is worth nothing, so lost ones are not asked for again.
JOINT_STATES = _newest(QoSReliabilityPolicy.BEST_EFFORT)
# As robot_state_publisher publishes it: whoever comes later still gets it.
ROBOT_DESCRIPTION = _newest(QoSReliabilityPolicy.RELIABLE, QoSDurabilityPolicy.TRANSIENT_LOCAL)
OUTPUT_STATE = ROBOT_DESCRIPTION
COMMAND = _newest(QoSReliabilityPolicy.RELIABLE)
RESULT = COMMAND
