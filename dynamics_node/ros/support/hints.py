"""Log hints while the node waits: the missing input, and the command that provides it."""

from collections import Counter
import time

from rclpy.qos import qos_check_compatible, QoSCompatibility

from .messages import type_name
from .throttling import Throttle
from ...errors import quoted

# Time without a description or joint states after which a hint is logged, s.
PATIENCE = 5.0
# Shortest time between two hints, s.
REPEAT_EVERY = 10.0
# Time without any message after which the topic counts as silent, s.
QUIET = 2.0
# Maximum number of names in a hint.
SHOWN = 8
# Endings of topics with incomplete or unfiltered joint states.
_STATES = ('', '_raw', '_unfiltered')


class Hints:
    """Logs a hint while the node waits for its inputs."""

    def __init__(self, context, source, states, now=time.monotonic):
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
        self._rejected: Counter = Counter()  # before joints began to be missing
        self._messages, self._last_message = 0, self._start

    def give(self):
        """Log a hint if an input has been missing for too long."""
        robot = self._context.robot
        if robot is not None:
            self._count_messages(robot.buffer)
        if self._now() - self._start < PATIENCE:
            return
        if robot is None:
            self._say(self._about_description)
            return
        missing = robot.buffer.stale_joints(self._now(), PATIENCE)
        if missing:
            self._say(lambda: self._about_states(robot, missing))
        else:
            self._rejected = Counter(robot.buffer.rejected)

    def _count_messages(self, buffer):
        messages = buffer.accepted + buffer.rejected.total()
        if messages != self._messages:
            self._messages, self._last_message = messages, self._now()

    def _say(self, text):
        if self._due.is_due():
            self.logger.warning(text())

    def _about_description(self):
        subscription = self._source.subscription
        lines = [f'no robot description on {self._source.topic} for {PATIENCE:g} s.']
        lines += self._heard_elsewhere(subscription, 'robot_description')
        if len(lines) == 1:
            lines += [
                # Not as a parameter on the command line: rcl reads it as YAML, which most are not.
                'Publish it: ros2 run robot_state_publisher robot_state_publisher my_arm.urdf',
                'or start this node with it: ros2 run dynamics_node dynamics_node --ros-args -p '
                'robot_description_file:=my_arm.urdf',
            ]
        return '\n  '.join(lines)

    def _about_states(self, robot, missing):
        topic = self._states.topic
        lines = [f'no joint state on {topic} for {_some(missing)} for {PATIENCE:g} s.']
        lines += self._heard_elsewhere(self._states.subscription, 'joint_states', _STATES)
        if len(lines) > 1:
            return '\n  '.join(lines)
        heard = robot.buffer.newest_names
        namespace = topic.rpartition('/')[0]
        if not self._node.count_publishers(topic):
            lines += [
                'No node publishes there' + (' any more.' if heard else '.'),
                f'Start the broadcaster: ros2 control load_controller{_manager(namespace)} '
                '--set-state active joint_state_broadcaster',
            ]
        elif not heard:
            lines.append(
                f'A node publishes there, but nothing comes: ros2 topic info --verbose {topic}'
            )
        elif self._now() - self._last_message > QUIET:
            # The publisher is still known some time after its process was killed.
            lines.append(
                f'Nothing comes any more; {_some([quoted(name) for name in heard])} came '
                'last. Look whether the broadcaster is still active:  ros2 control '
                f'list_controllers{_manager(namespace)}'
            )
        else:
            lines += _about_names(
                robot, missing, heard, topic, Counter(robot.buffer.rejected) - self._rejected
            )
        return '\n  '.join(lines)

    def _heard_elsewhere(self, subscription, name, endings=('',)):
        # First incompatible publishers on the topic, then publishers on similar topics.
        texts = mismatches(self._node, subscription)
        if texts:
            return [f'{text}.' for text in texts]
        if self._node.count_publishers(subscription.topic_name):
            return []
        return [
            f'But {topic} has it: add to the command line  --ros-args {self._rule(topic, name)}'
            for topic in published_elsewhere(self._node, subscription, endings)
        ]

    def _rule(self, topic, name):
        # Where the description is, everything else of that robot is, too. A broadcaster with
        # topics of its own has only its states there.
        namespace, _, last = topic.rpartition('/')
        is_robot = namespace and self._node.count_publishers(f'{namespace}/robot_description')
        if last == name and is_robot and not self._node.get_namespace().rstrip('/'):
            return f'-r __ns:={namespace}'
        return f'-r {name}:={topic}'


def unheard(node, publisher):
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
        What it is, and what to type.

    """
    topic = publisher.topic_name
    listened = listened_elsewhere(node, publisher)
    if listened:
        return (
            'nothing listens there, but there are subscribers on '
            + ', '.join(listened)
            + ': if that '
            'is an effort controller, start the node with  --ros-args -p '
            f'command_topic:={listened[0]}'
        )
    namespace, _, controller = topic.rpartition('/')[0].rpartition('/')
    manager = _manager(namespace)
    # Only a subscriber that exists before the output is on gets the ramp.
    return (
        'nothing listens there: call ~/enable with false first, because a controller that '
        'begins to listen now gets the whole effort at once; then look with  ros2 control '
        f'list_controllers{manager}  and start it with  ros2 control load_controller{manager}'
        f' --set-state active {controller or "forward_effort_controller"}  or set '
        'command_topic to that of another effort controller'
    )


def _manager(namespace):
    # `ros2 control` waits for ever in a namespace without this option.
    return f' --controller-manager {namespace}/controller_manager' if namespace else ''


def _about_names(robot, missing, heard, topic, rejected):
    # Messages arrive, but without usable values of these joints.
    lines = [
        f'There come {_some([quoted(name) for name in heard])}: look with  '
        f'ros2 topic echo --once {topic}'
    ]
    if set(missing) <= set(heard):
        dropped = ', '.join(f'{count} for {kind}' for kind, count in rejected.most_common())
        return (
            [*lines, f'They are dropped ({dropped}): the warnings above say why']
            if dropped
            else lines
        )
    prefix = _prefix(missing, heard)
    if prefix:
        return [
            *lines,
            f'They are named with {quoted(prefix)} before: use the description in '
            'which the joints have these names (often an argument of its xacro '
            'file, prefix or tf_prefix)',
        ]
    there = [name for name in robot.joint_names if name not in missing]
    if there:
        return [
            *lines,
            'If the others are all that you want: add to the command line  '
            f"--ros-args -p joints:='[{', '.join(there)}]'",
        ]
    return [*lines, 'The description must name its joints as they are named there']


def _prefix(missing, heard):
    """Return the prefix of every missing name in the received names, '' if there is none."""
    for name in heard:
        if name.endswith(missing[0]):
            prefix = name[: len(name) - len(missing[0])]
            if all(prefix + other in heard for other in missing):
                return prefix
    return ''


def _some(names):
    more = len(names) - SHOWN
    return ', '.join(names[:SHOWN]) + (f' and {more} more' if more > 0 else '')


# Maximum number of topics named in a hint.
MOST = 3
# Names of controllers whose command topics have the same type but take no efforts.
_NO_EFFORT = ('position', 'velocity', 'acceleration', 'trajectory')


def published_elsewhere(node, subscription, endings=('',)):
    """
    Return published topics of the same type with a similar name.

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
    Return subscribed topics of the same type with a similar name, for efforts.

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


def mismatches(node, subscription):
    """
    Return why the messages of publishers on a topic do not arrive.

    rclpy reports this by two more events per subscription, which cost time in every wait; so the
    node checks when a message is missing.

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
    # The profile in force: parameters may have overridden it.
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
