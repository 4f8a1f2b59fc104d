"""config/sros2_policy_effort_guard.xml and docs/reference.md have the guard's graph."""

from pathlib import Path
import sys

import rclpy
from rclpy.node import NodeNameNonExistentError
from std_msgs.msg import Float64MultiArray
from support.sros2_policy import read

ROOT = Path(__file__).parents[2]
POLICY = ROOT / 'config' / 'sros2_policy_effort_guard.xml'
sys.path.insert(0, str(ROOT / 'scripts'))

from reference import graph  # noqa: E402


def found(node):
    """Return what the guard does, as seen from another node: permission → full names."""
    questions = {
        'publish': node.get_publisher_names_and_types_by_node,
        'subscribe': node.get_subscriber_names_and_types_by_node,
        'reply': node.get_service_names_and_types_by_node,
        'request': node.get_client_names_and_types_by_node,
    }
    try:
        return {
            permission: {name for name, _ in question('effort_guard', '/')}
            for permission, question in questions.items()
        }
    except NodeNameNonExistentError:
        return None


def test_the_policy_allows_exactly_the_graph_of_the_guard(client, start):
    start(module='dynamics_node.ros.effort_guard.main')
    controller = rclpy.create_node('forward_effort_controller', context=client.context)
    controller.create_subscription(
        Float64MultiArray, 'forward_effort_controller/commands', lambda message: None, 1
    )
    client.executor.add_node(controller)
    allowed = read(POLICY.read_text()).allowed
    try:
        client.until(lambda: found(client.node) == allowed)
    except AssertionError:
        assert found(client.node) == allowed  # which shows the difference
    finally:
        controller.destroy_node()
    named = {full(entry.name) for entry in graph.EFFORT_GUARD}
    assert named == {
        name
        for permission in ('publish', 'subscribe', 'reply')
        for name in allowed[permission]
        if name not in graph.OF_EVERY_NODE
        and 'parameter' not in name
        and 'type_description' not in name
    }


def full(name):
    """Return a name of the reference as the graph has it."""
    return name.replace('~', '/effort_guard') if name[0] in '~/' else f'/{name}'


def test_the_command_topic_of_the_documents_is_the_one_it_listens_to():
    allowed = read(POLICY.read_text()).allowed
    assert allowed['subscribe'] == {'/effort_guard/commands'}
    text = (ROOT / 'docs' / 'effort_guard.md').read_text()
    assert '-p command_topic:=/effort_guard/commands' in text
    assert POLICY.name in text
