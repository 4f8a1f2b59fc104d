"""Quality of service of every topic, in one place."""

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import (
    QoSDurabilityPolicy,
    QoSHistoryPolicy,
    QoSPolicyKind,
    QoSProfile,
    QoSReliabilityPolicy,
)
from rclpy.qos_overriding_options import QoSOverridingOptions


def _newest(reliability, durability=QoSDurabilityPolicy.VOLATILE, depth=1):
    return QoSProfile(
        history=QoSHistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=reliability,
        durability=durability,
    )


# Depth of the queue of joint_states, for one publisher and for several.
SINGLE_DEPTH, SHARED_DEPTH = 1, 8
# rclpy's default policies leave out the durability.
JOINT_STATES_OVERRIDES = QoSOverridingOptions(
    (
        QoSPolicyKind.HISTORY,
        QoSPolicyKind.DEPTH,
        QoSPolicyKind.RELIABILITY,
        QoSPolicyKind.DURABILITY,
    )
)


def joint_states(several_publishers):
    """
    Return the quality of service of joint_states.

    An old joint state is worth nothing: lost ones are not asked for again, and one place in the
    queue lets the newest win. Several publishers share that queue, though, and an arm's state
    would be lost whenever the gripper's comes right behind it; so then there are more places.

    """
    return _newest(
        QoSReliabilityPolicy.BEST_EFFORT,
        depth=SHARED_DEPTH if several_publishers else SINGLE_DEPTH,
    )


# As robot_state_publisher publishes it: late subscribers still receive it.
ROBOT_DESCRIPTION = _newest(QoSReliabilityPolicy.RELIABLE, QoSDurabilityPolicy.TRANSIENT_LOCAL)
OUTPUT_STATE = ROBOT_DESCRIPTION
COMMAND = _newest(QoSReliabilityPolicy.RELIABLE)
RESULT = COMMAND

# rclpy waits for two events of every publisher and subscription, only to warn of incompatible
# partners; each costs 5 % of the processor time of a joint state. The partners warn, too, and
# `hints.py` reports it when an input is missing.
NO_EVENTS = PublisherEventCallbacks(use_default_callbacks=False)
NO_SUBSCRIPTION_EVENTS = SubscriptionEventCallbacks(use_default_callbacks=False)
