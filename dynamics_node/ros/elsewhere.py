"""Topics of the right type under another name: where what is missing may be."""

from .messages import type_name

# A hint names at most so many topics: it shall be read.
MOST = 3


def published_elsewhere(node, subscription):
    """
    Return topics that others publish which are like a subscription's but for their name.

    Parameters
    ----------
    node : rclpy.node.Node
    subscription : rclpy.subscription.Subscription

    Returns
    -------
    list of str
        Resolved names of the same type, in whose last part the own one stands: of
        /joint_states, say /left/joint_states. Sorted, at most three.

    """
    own = subscription.topic_name
    return _like(node, own, type_name(subscription.msg_type), node.count_publishers)


def listened_elsewhere(node, publisher):
    """
    Return topics that others listen to which are like a publisher's but for their name.

    Parameters
    ----------
    node : rclpy.node.Node
    publisher : rclpy.publisher.Publisher

    Returns
    -------
    list of str
        As of `published_elsewhere`.

    """
    own = publisher.topic_name
    return _like(node, own, type_name(publisher.msg_type), node.count_subscribers)


def _like(node, own, kind, count):
    last = own.rpartition('/')[2]
    return sorted(topic for topic, kinds in node.get_topic_names_and_types()
                  if topic != own and kind in kinds and last in topic.rpartition('/')[2]
                  and count(topic))[:MOST]
