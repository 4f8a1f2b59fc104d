"""Other publishers are counted and named, over DDS."""

from types import SimpleNamespace

from dynamics_node.ros.rivals import Rivals
from std_msgs.msg import Float64MultiArray
from support.processes import Client


def test_other_sources_of_efforts_and_states_are_named(client):
    client.node.create_publisher(Float64MultiArray, 'efforts', 1)
    states = SimpleNamespace(topic='/joint_states', count_publishers=lambda: (
        client.node.count_publishers('/joint_states')))
    rivals = Rivals(client.node, '/efforts', states, False)
    client.until(lambda: client.node.count_publishers('/efforts') == 1)
    assert rivals.found() == []
    other = Client('joint_state_publisher')
    try:
        other.node.create_publisher(Float64MultiArray, 'efforts', 1)
        # Its name comes some time after it.
        client.until(lambda: len(rivals.found()) == 2
                     and all('joint_state_publisher' in text for text in rivals.found()))
        efforts, joint_states = rivals.found()
    finally:
        other.close()
    assert efforts == ('1 other publisher(s) on /efforts (/joint_state_publisher): two sources '
                       'of effort would fight')
    assert joint_states.startswith('2 publishers on /joint_states (/joint_state_publisher): '
                                   'stop the others')
    client.until(lambda: rivals.found() == [])


def test_several_sources_of_states_may_be_allowed(client):
    states = SimpleNamespace(topic='/joint_states', count_publishers=lambda: 2)
    assert Rivals(client.node, '/efforts', states, True).found() == []
