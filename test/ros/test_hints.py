"""Log hints while the node waits: real topics, and a clock of the test."""

from types import SimpleNamespace

from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.support.description_source import DescriptionSource
from dynamics_node.ros.support.hints import (
    Hints,
    incompatible_publishers,
    no_subscriber_hint,
    PATIENCE,
    REPEAT_EVERY,
)
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.safety import RejectedStateError
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rclpy.qos import qos_profile_sensor_data, QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from support.processes import Client, LATCHED
from support.robots import ARM7, PENDULUM

ARM = RobotModel.from_urdf(ARM7)
NO_DESCRIPTION = {'robot_description': '', 'robot_description_file': ''}


@pytest.fixture
def other():
    """Return a second participant, whose publishers are not those of the node."""
    other = Client('other')
    yield other
    other.close()


class Waiting:
    """Hints of a real node, with a clock of the test."""

    def __init__(self, namespace=''):
        # Without the publishers that a client has on both topics.
        self.client = Client('waiting', namespace=namespace)
        node = self.client.node
        node.destroy_publisher(self.client.states)
        node.destroy_publisher(self.client.description)
        self.time, self.context = 0.0, NodeContext(node, NO_DESCRIPTION)
        source = DescriptionSource(self.context, lambda *_: True)
        source.begin()
        subscription = node.create_subscription(
            JointState, 'joint_states', lambda _: None, qos_profile_sensor_data
        )
        states = SimpleNamespace(subscription=subscription, topic=subscription.topic_name)
        self.hints = Hints(self.context, source, states, lambda: self.time)

    def describe(self, names=()):
        """Accept the description of arm7, with chosen joints."""
        self.context.robot = ActiveRobot(ARM, names)

    def feed(self, names, position=None):
        """Receive a joint state."""
        self.context.robot.buffer.update(
            self.time, list(names), [0.1] * len(names) if position is None else position
        )

    def after(self, seconds, capfd):
        """Return the log of the hint after some seconds."""
        capfd.readouterr()
        self.time += seconds
        self.hints.give()
        return capfd.readouterr().err

    def until_published(self, *topics, without=()):
        """Wait until topics have a publisher, and others have none."""
        count = self.client.node.count_publishers
        self.client.until(
            lambda: all(map(count, topics)) and not any(count(topic) for topic in without)
        )


@pytest.fixture
def waiting(request):
    """Return hints; a parameter is the namespace."""
    waiting = Waiting(getattr(request, 'param', ''))
    yield waiting
    waiting.client.close()


@pytest.fixture
def published(waiting, other):
    """Wait until joint states are published."""
    waiting.until_published('/joint_states')


def test_a_hint_is_not_logged_too_early_too_often_or_without_need(waiting, capfd):
    assert waiting.after(0.99 * PATIENCE, capfd) == ''
    assert 'no robot description' in waiting.after(0.01 * PATIENCE, capfd)
    assert waiting.after(0.9 * REPEAT_EVERY, capfd) == ''
    assert 'no robot description' in waiting.after(0.1 * REPEAT_EVERY, capfd)
    waiting.describe()
    waiting.time += REPEAT_EVERY
    waiting.feed(ARM.joint_names)
    assert waiting.after(0.0, capfd) == ''
    assert waiting.after(0.9 * PATIENCE, capfd) == ''
    assert 'no joint state' in waiting.after(0.2 * PATIENCE, capfd)


def test_without_a_description_the_hint_shows_two_ways_to_provide_one(waiting, capfd):
    text = waiting.after(PATIENCE, capfd)
    assert 'no robot description on /robot_description for 5 s' in text
    assert 'ros2 run robot_state_publisher robot_state_publisher my_arm.urdf' in text
    assert '-p robot_description_file:=my_arm.urdf' in text


def test_a_description_in_another_namespace_is_found(waiting, other, capfd):
    other.node.create_publisher(String, '/left/robot_description', LATCHED)
    # A subscription alone is no source.
    other.node.create_subscription(String, '/right/robot_description', lambda _: None, LATCHED)
    # What a motion planner publishes is another kind of description.
    other.node.create_publisher(String, '/robot_description_semantic', LATCHED)
    # Has the name, but another type.
    other.node.create_publisher(JointState, '/up/robot_description', LATCHED)
    other.node.destroy_publisher(other.description)
    waiting.until_published(
        '/left/robot_description',
        '/up/robot_description',
        '/robot_description_semantic',
        without=['/robot_description'],
    )
    text = waiting.after(PATIENCE, capfd)
    assert 'But /left/robot_description has a publisher' in text
    assert '--ros-args -r __ns:=/left' in text
    assert '/right' not in text and '/up' not in text and 'semantic' not in text


def test_a_namespace_is_taken_over_only_where_the_description_is_too(waiting, other, capfd):
    # A broadcaster with use_local_topics has its states in a namespace of its own.
    other.node.create_publisher(JointState, '/local_jsb/joint_states', qos_profile_sensor_data)
    other.node.destroy_publisher(other.states)
    waiting.until_published('/local_jsb/joint_states', without=['/joint_states'])
    waiting.describe()
    text = waiting.after(PATIENCE, capfd)
    assert '--ros-args -r joint_states:=/local_jsb/joint_states' in text and '__ns' not in text
    other.node.create_publisher(String, '/local_jsb/robot_description', LATCHED)
    waiting.until_published('/local_jsb/robot_description')
    assert '--ros-args -r __ns:=/local_jsb' in waiting.after(REPEAT_EVERY, capfd)


@pytest.mark.parametrize('waiting', ['right'], indirect=True)
def test_in_a_namespace_only_the_topic_is_remapped(waiting, other, capfd):
    other.node.destroy_publisher(other.description)
    other.node.create_publisher(String, '/left/robot_description', LATCHED)
    waiting.until_published('/left/robot_description', without=['/robot_description'])
    text = waiting.after(PATIENCE, capfd)
    assert 'on /right/robot_description' in text
    assert '-r robot_description:=/left/robot_description' in text


BROADCASTER = 'ros2 control load_controller --set-state active joint_state_broadcaster'


def test_without_joint_states_the_hint_starts_the_broadcaster(waiting, capfd):
    waiting.describe()
    text = waiting.after(PATIENCE, capfd)
    assert f'no joint state on /joint_states for {ARM.joint_names[0]}, ' in text
    assert 'No node publishes there.' in text and BROADCASTER in text


def test_ended_joint_states_are_reported(waiting, capfd):
    waiting.describe()
    waiting.feed(ARM.joint_names)
    with pytest.raises(RejectedStateError):
        waiting.feed(ARM.joint_names, [np.nan] * 8)
    text = waiting.after(PATIENCE + 1.0, capfd)
    assert 'No node publishes there any more.' in text and BROADCASTER in text
    assert 'Received:' not in text and 'dropped' not in text


def test_ended_joint_states_of_a_known_publisher_are_reported(waiting, published, capfd):
    waiting.describe()
    for _ in range(3):
        waiting.feed(ARM.joint_names)
        assert waiting.after(1.0, capfd) == ''
    while not (text := waiting.after(1.0, capfd)):
        assert waiting.time < 20.0
    assert f"No message arrives any more; the last one had '{ARM.joint_names[0]}', " in text
    assert 'ros2 control list_controllers' in text and 'Received:' not in text


@pytest.mark.parametrize('waiting', ['left'], indirect=True)
def test_in_a_namespace_the_broadcaster_has_another_controller_manager(waiting, other, capfd):
    other.node.destroy_publisher(other.states)
    waiting.until_published(without=['/joint_states'])
    waiting.describe()
    text = waiting.after(PATIENCE, capfd)
    assert (
        'ros2 control load_controller --controller-manager /left/controller_manager '
        '--set-state active joint_state_broadcaster'
    ) in text


def test_a_silent_publisher_is_inspected(waiting, published, capfd):
    waiting.describe()
    assert 'ros2 topic info --verbose /joint_states' in waiting.after(PATIENCE, capfd)


def test_joint_states_under_another_name_are_found(waiting, other, capfd):
    other.node.destroy_publisher(other.states)
    other.node.create_publisher(JointState, '/arm/joint_states_raw', qos_profile_sensor_data)
    waiting.until_published('/arm/joint_states_raw', without=['/joint_states'])
    waiting.describe()
    text = waiting.after(PATIENCE, capfd)
    assert '--ros-args -r joint_states:=/arm/joint_states_raw' in text


def test_missing_joints_are_named_with_the_joints_parameter(waiting, published, capfd):
    waiting.describe()
    there = ARM.joint_names[:-1]
    for _ in range(4):
        waiting.time += 2.0
        waiting.feed(there)
    text = waiting.after(0.0, capfd)
    assert f'no joint state on /joint_states for {ARM.joint_names[-1]} for 5 s' in text
    assert 'ros2 topic echo --once /joint_states' in text
    assert f"-p joints:='[{', '.join(there)}]'" in text


def test_a_prefix_before_every_name_is_recognized(waiting, published, capfd):
    waiting.describe()
    waiting.feed([f'left_{name}' for name in ARM.joint_names])
    text = waiting.after(PATIENCE, capfd)
    assert "They have the prefix 'left_'" in text
    assert 'tf_prefix' in text
    waiting.feed([*(f'left_{name}' for name in ARM.joint_names[:-1]), 'x' * 300, 'a\x1b[31m'])
    text = waiting.after(REPEAT_EVERY, capfd)
    assert 'The joints in the description must have the names in the joint states' in text
    assert '\x1b[31m' not in text and len(text) < 1500


def test_dropped_states_are_not_taken_for_missing_names(waiting, published, capfd):
    waiting.describe()
    with pytest.raises(RejectedStateError):
        waiting.feed(ARM.joint_names, [np.nan] * 8)
    text = waiting.after(PATIENCE, capfd)
    assert 'They are dropped (1 for not finite)' in text
    assert 'joints:=' not in text
    # States dropped before joints were missing are not the reason.
    waiting.feed(ARM.joint_names)
    assert waiting.after(0.0, capfd) == ''
    assert 'dropped' not in waiting.after(REPEAT_EVERY, capfd)


def test_a_command_topic_without_subscribers_gets_a_hint(waiting, other):
    node = waiting.client.node
    publisher = node.create_publisher(Float64MultiArray, 'forward_effort_controller/commands', 1)
    text = no_subscriber_hint(node, publisher)
    assert 'ros2 control list_controllers' in text
    assert 'ros2 control load_controller --set-state active forward_effort_controller' in text
    in_namespace = node.create_publisher(Float64MultiArray, '/left/effort/commands', 1)
    assert (
        'load_controller --controller-manager /left/controller_manager --set-state active effort'
    ) in no_subscriber_hint(node, in_namespace)
    assert 'active forward_effort_controller' in no_subscriber_hint(
        node, node.create_publisher(Float64MultiArray, '/efforts', 1)
    )
    # Takes radians.
    other.node.create_subscription(
        Float64MultiArray, '/forward_position_controller/commands', lambda _: None, 1
    )
    waiting.client.until(lambda: node.count_subscribers('/forward_position_controller/commands'))
    assert 'forward_position_controller' not in no_subscriber_hint(node, publisher)
    other.node.create_subscription(
        Float64MultiArray, '/arm_controller/commands', lambda _: None, 1
    )
    waiting.client.until(lambda: node.count_subscribers('/arm_controller/commands'))
    assert '-p command_topic:=/arm_controller/commands' in no_subscriber_hint(node, publisher)


def test_the_node_logs_the_hints(client, start):
    log = client.listen(Log, '/rosout')

    def logged(text):
        return [message for message in log if text in message.msg]

    start('__node:=without_description')
    client.until(lambda: logged('no robot description on /robot_description for 5 s'))
    start('__node:=with_other_names', robot_description_file=PENDULUM)
    client.until(
        lambda: logged("They have the prefix 'left_'"),
        lambda: client.publish(['left_hinge'], [0.0]),
    )
    assert {message.name for message in logged(' for 5 s')} == {
        'without_description',
        'with_other_names',
    }


RELIABLE = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)


def mismatches(client, other, kind, qos):
    """Return the mismatches of a subscription with the publisher of another client."""
    # Another context: one cannot have two types on a topic.
    subscription = client.node.create_subscription(JointState, 'states', lambda _: None, RELIABLE)
    other.node.create_publisher(kind, 'states', qos)
    # The name of a publisher's node comes some time after the publisher.
    client.until(
        lambda: [
            info
            for info in client.node.get_publishers_info_by_topic('/states')
            if info.node_name == 'other'
        ]
    )
    return incompatible_publishers(client.node, subscription)


def test_a_compatible_publisher_is_not_reported(client, other):
    assert mismatches(client, other, JointState, RELIABLE) == []


def test_another_quality_of_service_is_named_with_the_publisher(client, other):
    [text] = mismatches(client, other, JointState, BEST_EFFORT)
    assert text.startswith('the quality of service of /other does not fit: ')
    assert 'reliab' in text.lower()


def test_another_type_is_named_with_what_was_expected(client, other):
    [text] = mismatches(client, other, String, RELIABLE)
    assert text == (
        '/other publishes std_msgs/msg/String there, expected sensor_msgs/msg/JointState'
    )
