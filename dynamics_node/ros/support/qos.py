"""Quality of service of every topic, in one place."""

from __future__ import annotations

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


# Depth of the queue of joint_states for one publisher.
SINGLE_DEPTH = 1
# Depth of that queue for several publishers.
SHARED_DEPTH = 8
# Policies that parameters may override; rclpy's default set lacks the durability.
JOINT_STATES_OVERRIDES = QoSOverridingOptions(
    (
        QoSPolicyKind.HISTORY,
        QoSPolicyKind.DEPTH,
        QoSPolicyKind.RELIABILITY,
        QoSPolicyKind.DURABILITY,
    )
)


def joint_states(several_publishers: bool) -> QoSProfile:
    """
    Return the quality of service of joint_states.

    Only the newest joint state is useful: lost ones are not repeated, and a queue of depth 1 keeps
    the newest. Several publishers share the queue: at depth 1, the state of a gripper would
    replace the state of the arm right before it, so the queue is deeper then.

    Parameters
    ----------
    several_publishers : bool

    Returns
    -------
    rclpy.qos.QoSProfile

    """
    return _newest(
        QoSReliabilityPolicy.BEST_EFFORT,
        depth=SHARED_DEPTH if several_publishers else SINGLE_DEPTH,
    )


# As robot_state_publisher publishes it: late subscribers receive it, too.
ROBOT_DESCRIPTION = _newest(QoSReliabilityPolicy.RELIABLE, QoSDurabilityPolicy.TRANSIENT_LOCAL)
OUTPUT_STATE = ROBOT_DESCRIPTION
COMMAND = _newest(QoSReliabilityPolicy.RELIABLE)
RESULT = COMMAND

# rclpy waits for two events of every publisher and subscription, only to warn of incompatible
# partners; each costs a twentieth of the processor time of a joint state. The partners warn, too,
# and `hints.py` reports the mismatch when a message is missing.
NO_EVENTS = PublisherEventCallbacks(use_default_callbacks=False)
NO_SUBSCRIPTION_EVENTS = SubscriptionEventCallbacks(use_default_callbacks=False)
