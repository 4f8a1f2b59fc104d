"""Publishers that cannot be heard are named, over DDS."""

from dynamics_node.ros.mismatch import mismatches
import pytest
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.processes import Client

RELIABLE = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def other():
    """Return a second client: one process cannot have two types on a topic."""
    other = Client()
    yield other
    other.close()


def found(client, other, kind, qos):
    """Return the mismatches of a subscription with another client's publisher."""
    subscription = client.node.create_subscription(JointState, 'states', lambda _: None, RELIABLE)
    other.node.create_publisher(kind, 'states', qos)
    # The name of a publisher's node comes some time after the publisher.
    client.until(
        lambda: [
            info
            for info in client.node.get_publishers_info_by_topic('/states')
            if info.node_name == 'test_client'
        ]
    )
    return mismatches(client.node, subscription)


def test_what_fits_is_not_mentioned(client, other):
    assert found(client, other, JointState, RELIABLE) == []


def test_another_quality_of_service_is_named_with_the_publisher(client, other):
    [text] = found(client, other, JointState, BEST_EFFORT)
    assert text.startswith('the quality of service of /test_client does not fit: ')
    assert 'reliab' in text.lower()


def test_another_type_is_named_with_what_was_expected(client, other):
    [text] = found(client, other, String, RELIABLE)
    assert text == (
        '/test_client publishes std_msgs/msg/String there, expected sensor_msgs/msg/JointState'
    )
