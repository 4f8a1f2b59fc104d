"""Other publishers are counted and named, over DDS."""

from types import SimpleNamespace

from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.torque_path.publisher_monitor import PublisherMonitor
from std_msgs.msg import Float64MultiArray, String
from support.processes import Client


def monitor(client, states=None, allow=False):
    """Return a monitor of the topics of a client."""
    states = states or SimpleNamespace(
        topic='/joint_states',
        count_publishers=lambda: client.node.count_publishers('/joint_states'),
    )
    source = SimpleNamespace(topic='/described')
    context = NodeContext(client.node, {'allow_several_state_publishers': allow})
    return PublisherMonitor(context, '/efforts', states, source)


def test_other_sources_of_efforts_and_states_are_named(client):
    client.node.create_publisher(Float64MultiArray, 'efforts', 1)
    unit = monitor(client)
    client.until(lambda: client.node.count_publishers('/efforts') == 1)
    assert unit.conflicts() == []
    other = Client('joint_state_publisher')
    try:
        other.node.create_publisher(Float64MultiArray, 'efforts', 1)
        # Its name comes some time after it.
        client.until(
            lambda: (
                len(unit.conflicts()) == 2
                and all('joint_state_publisher' in text for text in unit.conflicts())
            )
        )
        efforts, joint_states = unit.conflicts()
    finally:
        other.close()
    assert efforts == (
        '1 other publisher(s) on /efforts (/joint_state_publisher): two sources '
        'of effort would fight'
    )
    assert joint_states.startswith('2 publishers on /joint_states (/joint_state_publisher')
    client.until(lambda: unit.conflicts() == [])


def test_another_node_of_the_same_name_is_named_too(client):
    client.node.create_publisher(Float64MultiArray, 'efforts', 1)
    other = Client(client.node.get_name())
    try:
        other.node.create_publisher(Float64MultiArray, 'efforts', 1)
        unit = monitor(client)
        client.until(
            lambda: any(f'(/{client.node.get_name()})' in text for text in unit.conflicts())
        )
    finally:
        other.close()


def test_several_sources_of_states_may_be_allowed(client):
    states = SimpleNamespace(topic='/joint_states', count_publishers=lambda: 2)
    assert monitor(client, states, True).conflicts() == []
    assert len(monitor(client, states).conflicts()) == 1


def test_a_second_publisher_of_descriptions_is_a_conflict(client):
    unit = monitor(client)
    client.node.create_publisher(String, '/described', 1)
    client.until(lambda: client.node.count_publishers('/described') == 1)
    assert unit.description_conflicts() == []
    other = Client('second_robot_state_publisher')
    try:
        other.node.create_publisher(String, '/described', 1)
        client.until(
            lambda: 'second_robot_state_publisher' in ''.join(unit.description_conflicts())
        )
        [text] = unit.description_conflicts()
    finally:
        other.close()
    assert text.startswith('2 publishers on /described')
    assert 'which of them describes this robot?' in text
