"""Log hints while the node waits: what is missing, and the command to type."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
import time
from typing import Any, Protocol, TYPE_CHECKING

from rclpy.qos import qos_check_compatible, QoSCompatibility

from .messages import type_name
from .throttling import Throttle
from ..context import NodeContext
from ...errors import quoted

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher
    from rclpy.subscription import Subscription

    from .description_source import DescriptionSource

# Time without a description or without joint states before the first hint, s.
PATIENCE = 5.0
# Shortest time between two hints, s.
REPEAT_EVERY = 10.0
# Time without a message after which the stream counts as ended, s; `give` runs once a second.
QUIET = 2.0
# Maximum number of names listed in a hint.
MAX_NAMES = 8
# Maximum number of topics named in a hint.
MAX_TOPICS = 3
# Endings of joint state topics that are incomplete or unfiltered, as drivers name them.
_STATE_ENDINGS = ('', '_raw', '_unfiltered')
# Float64MultiArray topics have the same last name for every quantity; these are not efforts.
_NOT_EFFORT = ('position', 'velocity', 'acceleration', 'trajectory')


class JointStateTopic(Protocol):
    """The parts of `JointStateInput` that hints need."""

    subscription: Any

    @property
    def topic(self) -> str:
        """Resolved name."""


class Hints:
    """Logs a hint when the description or joint states are missing for too long."""

    def __init__(
        self,
        context: NodeContext,
        source: DescriptionSource,
        states: JointStateTopic,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """
        Start the waiting time.

        Parameters
        ----------
        context : NodeContext
        source : DescriptionSource
        states : JointStateInput
        now : callable() -> float
            Steady clock, s.

        """
        self.logger = context.logger
        self._context = context
        self._node = context.node
        self._source = source
        self._states = states
        self._now = now
        self._start = now()
        self._due = Throttle(REPEAT_EVERY, now)
        # Rejected states up to the last moment at which no joint was missing.
        self._rejected: Counter = Counter()
        self._messages, self._last_message = 0, self._start

    def give(self) -> None:
        """Log a hint if something has been missing for PATIENCE, at most every REPEAT_EVERY."""
        robot = self._context.robot
        if robot is not None:
            self._count_messages(robot.buffer)
        if self._now() - self._start < PATIENCE:
            return
        if robot is None:
            self._log(self._about_description)
            return
        missing = robot.buffer.stale_joints(self._now(), PATIENCE)
        if missing:
            self._log(lambda: self._about_states(robot, missing))
        else:
            self._rejected = Counter(robot.buffer.rejected)

    def _count_messages(self, buffer):
        messages = buffer.accepted + buffer.rejected.total()
        if messages != self._messages:
            self._messages, self._last_message = messages, self._now()

    def _log(self, text):
        if self._due.is_due():
            self.logger.warning(text())

    def _about_description(self):
        subscription = self._source.subscription
        lines = [f'no robot description on {self._source.topic} for {PATIENCE:g} s.']
        lines += self._about_publishers(subscription, 'robot_description')
        if len(lines) == 1:
            lines += [
                # Not as a parameter on the command line: most URDFs are not valid YAML, as which
                # rcl reads it.
                'Publish it: ros2 run robot_state_publisher robot_state_publisher my_arm.urdf',
                'or start this node with it: ros2 run dynamics_node dynamics_node --ros-args -p '
                'robot_description_file:=my_arm.urdf',
            ]
        return '\n  '.join(lines)

    def _about_states(self, robot, missing):
        topic = self._states.topic
        lines = [f'no joint state on {topic} for {_shortened(missing)} for {PATIENCE:g} s.']
        lines += self._about_publishers(self._states.subscription, 'joint_states', _STATE_ENDINGS)
        if len(lines) > 1:
            return '\n  '.join(lines)
        received = robot.buffer.newest_names
        namespace = topic.rpartition('/')[0]
        if not self._node.count_publishers(topic):
            lines += [
                'No node publishes there' + (' any more.' if received else '.'),
                f'Start the broadcaster: ros2 control load_controller{_manager(namespace)} '
                '--set-state active joint_state_broadcaster',
            ]
        elif not received:
            lines.append(
                'A node publishes there, but no message arrives: '
                f'ros2 topic info --verbose {topic}'
            )
        elif self._now() - self._last_message > QUIET:
            # Discovery knows the publisher for some time after its process was killed.
            lines.append(
                'No message arrives any more; the last one had '
                f'{_shortened([quoted(name) for name in received])}. '
                'Check whether the broadcaster is still active:  ros2 control '
                f'list_controllers{_manager(namespace)}'
            )
        else:
            rejected = Counter(robot.buffer.rejected) - self._rejected
            lines += _about_names(robot, missing, received, topic, rejected)
        return '\n  '.join(lines)

    def _about_publishers(self, subscription, name, endings=('',)):
        # First the incompatible publishers of this topic, then those of similar topics.
        reasons = incompatible_publishers(self._node, subscription)
        if reasons:
            return [f'{reason}.' for reason in reasons]
        if self._node.count_publishers(subscription.topic_name):
            return []
        return [
            f'But {topic} has a publisher: add to the command line  '
            f'--ros-args {self._rule(topic, name)}'
            for topic in similar_published_topics(self._node, subscription, endings)
        ]

    def _rule(self, topic, name):
        # The namespace of a description holds all topics of that robot. A broadcaster with
        # topics of its own has only its states there.
        namespace, _, last = topic.rpartition('/')
        is_robot = namespace and self._node.count_publishers(f'{namespace}/robot_description')
        if last == name and is_robot and not self._node.get_namespace().rstrip('/'):
            return f'-r __ns:={namespace}'
        return f'-r {name}:={topic}'


def no_subscriber_hint(node: Node, publisher: Publisher) -> str:
    """
    Return the hint for a command topic without subscribers.

    Parameters
    ----------
    node : rclpy.node.Node
    publisher : rclpy.publisher.Publisher
        Of the command topic.

    Returns
    -------
    str
        The problem, and what to type.

    """
    topic = publisher.topic_name
    similar = similar_subscribed_topics(node, publisher)
    if similar:
        return (
            'nothing listens there, but there are subscribers on ' + ', '.join(similar) + ': if '
            'that is an effort controller, start the node with  --ros-args -p '
            f'command_topic:={similar[0]}'
        )
    namespace, _, controller = topic.rpartition('/')[0].rpartition('/')
    manager = _manager(namespace)
    # Only a controller that listens before the output is on receives the ramp.
    return (
        'nothing listens there: call ~/enable with false first, because a controller that '
        'begins to listen now gets the whole effort at once; then look with  ros2 control '
        f'list_controllers{manager}  and start it with  ros2 control load_controller{manager}'
        f' --set-state active {controller or "forward_effort_controller"}  or set '
        'command_topic to that of another effort controller'
    )


def similar_published_topics(
    node: Node, subscription: Subscription, endings: Sequence[str] = ('',)
) -> list[str]:
    """
    Return published topics with the type and last name of a subscription, elsewhere.

    Parameters
    ----------
    node : rclpy.node.Node
    subscription : rclpy.subscription.Subscription
    endings : sequence of str
        Allowed endings behind the last part of the name.

    Returns
    -------
    list of str
        Resolved names, for example /left/joint_states for /joint_states; sorted, at most
        MAX_TOPICS.

    """
    return _similar_topics(
        node,
        subscription.topic_name,
        type_name(subscription.msg_type),
        endings,
        node.count_publishers,
    )


def similar_subscribed_topics(node: Node, publisher: Publisher) -> list[str]:
    """
    Return subscribed effort topics with the type and last name of a publisher, elsewhere.

    Parameters
    ----------
    node : rclpy.node.Node
    publisher : rclpy.publisher.Publisher

    Returns
    -------
    list of str
        As of `similar_published_topics`, without names of other quantities than efforts.

    """
    topics = _similar_topics(
        node, publisher.topic_name, type_name(publisher.msg_type), ('',), node.count_subscribers
    )
    return [topic for topic in topics if not any(word in topic for word in _NOT_EFFORT)]


def incompatible_publishers(node: Node, subscription: Subscription) -> list[str]:
    """
    Return why publishers on a topic cannot reach a subscription.

    rclpy reports this by events, for which it waits together with every message; so the node
    queries it only when a message is missing.

    Parameters
    ----------
    node : rclpy.node.Node
    subscription : rclpy.subscription.Subscription

    Returns
    -------
    list of str
        One sentence for each publisher of another type or with an incompatible quality of
        service; empty if there is none.

    """
    own = type_name(subscription.msg_type)
    # The profile in force: parameters may have overridden the one in the code.
    wanted = [
        info.qos_profile
        for info in node.get_subscriptions_info_by_topic(subscription.topic_name)
        if info.node_name == node.get_name() and info.node_namespace == node.get_namespace()
    ]
    reasons = []
    for publisher in node.get_publishers_info_by_topic(subscription.topic_name):
        name = f'{publisher.node_namespace.rstrip("/")}/{publisher.node_name}'
        if publisher.topic_type != own:
            reasons.append(f'{name} publishes {publisher.topic_type} there, expected {own}')
            continue
        for profile in wanted:
            fit, reason = qos_check_compatible(publisher.qos_profile, profile)
            if fit == QoSCompatibility.ERROR:
                reasons.append(f'the quality of service of {name} does not fit: {reason.strip()}')
    return reasons


def _similar_topics(node, own, kind, endings, count):
    last = own.rpartition('/')[2]
    names = {last + ending for ending in endings}
    return sorted(
        topic
        for topic, kinds in node.get_topic_names_and_types()
        if topic != own and kind in kinds and topic.rpartition('/')[2] in names and count(topic)
    )[:MAX_TOPICS]


def _manager(namespace):
    # `ros2 control` needs the manager's name in a namespace; without it, it waits forever.
    return f' --controller-manager {namespace}/controller_manager' if namespace else ''


def _about_names(robot, missing, received, topic, rejected):
    # Messages arrive, but without usable numbers for the missing joints.
    lines = [
        f'Received: {_shortened([quoted(name) for name in received])}; look with  '
        f'ros2 topic echo --once {topic}'
    ]
    if set(missing) <= set(received):
        dropped = ', '.join(f'{count} for {kind}' for kind, count in rejected.most_common())
        return (
            [*lines, f'They are dropped ({dropped}): see the warnings above'] if dropped else lines
        )
    prefix = _prefix(missing, received)
    if prefix:
        return [
            *lines,
            f'They have the prefix {quoted(prefix)}: use the description in '
            'which the joints have these names (often an argument of its xacro '
            'file, prefix or tf_prefix)',
        ]
    present = [name for name in robot.joint_names if name not in missing]
    if present:
        return [
            *lines,
            'If the other joints are enough: add to the command line  '
            f"--ros-args -p joints:='[{', '.join(present)}]'",
        ]
    return [*lines, 'The joints in the description must have the names in the joint states']


def _prefix(missing, received):
    """Return the prefix of every missing name among the received names, '' if there is none."""
    for name in received:
        if name.endswith(missing[0]):
            prefix = name[: len(name) - len(missing[0])]
            if all(prefix + other in received for other in missing):
                return prefix
    return ''


def _shortened(names):
    more = len(names) - MAX_NAMES
    return ', '.join(names[:MAX_NAMES]) + (f' and {more} more' if more > 0 else '')
