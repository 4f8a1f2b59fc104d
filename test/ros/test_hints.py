"""Log hints while the node waits: real topics, and a clock of the test."""

import re
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
def other(participant):
    """Return a second participant, whose publishers are not those of the node."""
    return participant('other')


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
    text = waiting.after(0.01 * PATIENCE, capfd)
    # Two ways to provide a description.
    assert 'no robot description on /robot_description for 5 s' in text
    assert 'ros2 run robot_state_publisher robot_state_publisher my_arm.urdf' in text
    assert '-p robot_description_file:=my_arm.urdf' in text
    assert waiting.after(0.9 * REPEAT_EVERY, capfd) == ''
    assert 'no robot description' in waiting.after(0.1 * REPEAT_EVERY, capfd)
    waiting.describe()
    waiting.time += REPEAT_EVERY
    waiting.feed(ARM.joint_names)
    assert waiting.after(0.0, capfd) == ''
    assert waiting.after(0.9 * PATIENCE, capfd) == ''
    assert 'no joint state' in waiting.after(0.2 * PATIENCE, capfd)


DESCRIPTION, STATES = 'robot_description', 'joint_states'
LEFT = f'/left/{DESCRIPTION}'
LOAD, BROADCASTER = 'ros2 control load_controller ', '--set-state active joint_state_broadcaster'


@pytest.mark.parametrize(
    'waiting, is_described, topics, expected',
    [
        # A broadcaster with use_local_topics has its states in a namespace of its own.
        ('', True, [f'/jsb/{STATES}'], [f'--ros-args -r {STATES}:=/jsb/{STATES}']),
        ('', True, [f'/jsb/{STATES}', f'/jsb/{DESCRIPTION}'], ['--ros-args -r __ns:=/jsb']),
        ('', True, [f'/arm/{STATES}_raw'], [f'--ros-args -r {STATES}:=/arm/{STATES}_raw']),
        ('', False, [LEFT], [f'But {LEFT} has a publisher', '--ros-args -r __ns:=/left']),
        ('right', False, [LEFT], [f'on /right/{DESCRIPTION}', f'-r {DESCRIPTION}:={LEFT}']),
        (
            '',
            True,
            [],
            [
                f'no joint state on /{STATES} for {ARM.joint_names[0]}, ',
                'No node publishes there.',
                LOAD + BROADCASTER,
            ],
        ),
        ('left', True, [], [f'{LOAD}--controller-manager /left/controller_manager {BROADCASTER}']),
    ],
    indirect=['waiting'],
)
def test_the_hint_shows_the_command_for_what_is_found(
    waiting, other, is_described, topics, expected, capfd
):
    node = other.node
    node.destroy_publisher(other.description)
    node.destroy_publisher(other.states)
    for topic in topics:
        kind, qos = (
            (String, LATCHED) if DESCRIPTION in topic else (JointState, qos_profile_sensor_data)
        )
        node.create_publisher(kind, topic, qos)
    # Neither a subscription, nor what a motion planner publishes, nor another type is a source.
    node.create_subscription(String, f'/sub/{DESCRIPTION}', lambda _: None, LATCHED)
    node.create_publisher(String, f'/{DESCRIPTION}_semantic', LATCHED)
    node.create_publisher(JointState, f'/type/{DESCRIPTION}', LATCHED)
    waiting.until_published(
        *topics,
        f'/type/{DESCRIPTION}',
        f'/{DESCRIPTION}_semantic',
        without=[f'/{DESCRIPTION}', f'/{STATES}'],
    )
    if is_described:
        waiting.describe()
    text = waiting.after(PATIENCE, capfd)
    assert all(part in text for part in expected), text
    assert ('__ns' in text) == ('__ns' in ''.join(expected))
    assert not any(word in text for word in ('/sub', '/type', 'semantic'))


def test_ended_joint_states_are_reported(waiting, capfd):
    waiting.describe()
    waiting.feed(ARM.joint_names)
    with pytest.raises(RejectedStateError):
        waiting.feed(ARM.joint_names, [np.nan] * 8)
    text = waiting.after(PATIENCE + 1.0, capfd)
    assert 'No node publishes there any more.' in text and LOAD + BROADCASTER in text
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


def test_a_silent_publisher_is_inspected(waiting, published, capfd):
    waiting.describe()
    assert 'ros2 topic info --verbose /joint_states' in waiting.after(PATIENCE, capfd)


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
    start('__node:=with_other_names', robot_description_file=PENDULUM)
    # Best effort, where the subscription asks for reliable.
    client.node.create_publisher(JointState, '/others/joint_states', qos_profile_sensor_data)
    start(
        '__node:=incompatible',
        '__ns:=/others',
        robot_description_file=PENDULUM,
        **{'qos_overrides./others/joint_states.subscription.reliability': 'reliable'},
    )
    expected = {
        'without_description': 'no robot description on /robot_description for 5 s',
        'with_other_names': "They have the prefix 'left_'",
        'others.incompatible': 'the quality of service of /test_client does not fit',
    }
    client.until(
        lambda: all(map(logged, expected.values())), lambda: client.publish(['left_hinge'], [0.0])
    )
    assert logged('no joint state on /others/joint_states for hinge')
    for name, text in expected.items():
        assert {message.name for message in logged(text)} == {name}


RELIABLE = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)


@pytest.mark.parametrize(
    'kind, qos, expected',
    [
        (JointState, RELIABLE, r'\A\Z'),
        (JointState, BEST_EFFORT, '^the quality of service of /other does not fit: .*(?i:reliab)'),
        (
            String,
            RELIABLE,
            '^/other publishes std_msgs/msg/String there, expected sensor_msgs/msg/JointState$',
        ),
    ],
    ids=['compatible', 'quality of service', 'type'],
)
def test_incompatible_publishers_are_named(client, other, kind, qos, expected):
    # Another context: one cannot have two types on a topic.
    subscription = client.node.create_subscription(JointState, 'states', lambda _: None, RELIABLE)
    other.node.create_publisher(kind, 'states', qos)
    # The name of a publisher's node comes some time after the publisher.
    client.until(
        lambda: (
            'other'
            in {info.node_name for info in client.node.get_publishers_info_by_topic('/states')}
        )
    )
    texts = incompatible_publishers(client.node, subscription)
    assert len(texts) == (expected != r'\A\Z')
    assert re.search(expected, ''.join(texts))
