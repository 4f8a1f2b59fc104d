"""Topics of the right type under another name: where what is missing may be."""

from .messages import type_name

# A hint names at most so many topics: it shall be read.
MOST = 3
# Controllers take arrays of numbers on topics of the same name, whatever the numbers mean.
_NO_EFFORT = ('position', 'velocity', 'acceleration', 'trajectory')


def published_elsewhere(node, subscription, endings=('',)):
    """
    Return topics that others publish which are like a subscription's but for their name.

    Parameters
    ----------
    node : rclpy.node.Node
    subscription : rclpy.subscription.Subscription
    endings : sequence of str
        What may stand behind the last part of its name.

    Returns
    -------
    list of str
        Resolved names of the same type with the same last part: of /joint_states, say
        /left/joint_states. Sorted, at most three.

    """
    return _like(
        node,
        subscription.topic_name,
        type_name(subscription.msg_type),
        endings,
        node.count_publishers,
    )


def listened_elsewhere(node, publisher):
    """
    Return topics of efforts that others listen to which are like a publisher's but for their name.

    Parameters
    ----------
    node : rclpy.node.Node
    publisher : rclpy.publisher.Publisher

    Returns
    -------
    list of str
        As of `published_elsewhere`; none whose name says that it is of other numbers.

    """
    found = _like(
        node, publisher.topic_name, type_name(publisher.msg_type), ('',), node.count_subscribers
    )
    return [topic for topic in found if not any(word in topic for word in _NO_EFFORT)]


def _like(node, own, kind, endings, count):
    last = own.rpartition('/')[2]
    names = {last + ending for ending in endings}
    return sorted(
        topic
        for topic, kinds in node.get_topic_names_and_types()
        if topic != own and kind in kinds and topic.rpartition('/')[2] in names and count(topic)
    )[:MOST]
