"""Publishers that a subscription cannot hear, said in words."""

from rclpy.qos import qos_check_compatible, QoSCompatibility

from .messages import type_name


def mismatches(node, subscription):
    """
    Return why publishers on a topic are not heard.

    rclpy would notice by itself, but only by waiting for two more events together with every
    message; so the node looks when a message is missing.

    Parameters
    ----------
    node : rclpy.node.Node
    subscription : rclpy.subscription.Subscription

    Returns
    -------
    list of str
        One sentence for each publisher of another type or with a quality of service that does
        not fit; empty if there is none.

    """
    own = type_name(subscription.msg_type)
    # What is really in force: it may have been overridden by parameters.
    wanted = [
        info.qos_profile
        for info in node.get_subscriptions_info_by_topic(subscription.topic_name)
        if info.node_name == node.get_name() and info.node_namespace == node.get_namespace()
    ]
    found = []
    for publisher in node.get_publishers_info_by_topic(subscription.topic_name):
        name = f'{publisher.node_namespace.rstrip("/")}/{publisher.node_name}'
        if publisher.topic_type != own:
            found.append(f'{name} publishes {publisher.topic_type} there, expected {own}')
            continue
        for profile in wanted:
            fit, reason = qos_check_compatible(publisher.qos_profile, profile)
            if fit == QoSCompatibility.ERROR:
                found.append(f'the quality of service of {name} does not fit: {reason.strip()}')
    return found
