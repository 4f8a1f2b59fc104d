"""`MarkersNode`: joint states, description and parameters in, markers out."""

import time

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.validate_full_topic_name import validate_full_topic_name
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from visualization_msgs.msg import MarkerArray

from .callbacks import ErrorReport, LimitedGroup, reported
from .followed_node import FollowedNode
from .messages import MarkerMessages
from .view import RobotView
from ...errors import DynamicsError
from ...ros.support.qos import (
    joint_states,
    NO_EVENTS,
    NO_SUBSCRIPTION_EVENTS,
    RESULT,
    ROBOT_DESCRIPTION,
)

# Shortest time between two messages, s: people do not see more.
PERIOD = 0.05
# How often the program looks for what is missing, s.
CHECK_EVERY = 1.0
# Joint states that are taken in one PERIOD; parts of a state may come from several publishers.
STATES_AT_ONCE = 8


class MarkersNode(Node):
    """
    Publishes markers for a dynamics node while they have a subscriber.

    Only then does it subscribe to joint states and gravity torque.

    """

    def __init__(self, **options):
        """
        Create the publisher and wait for a description.

        Parameters
        ----------
        **options
            Of rclpy.node.Node.

        Raises
        ------
        ValueError
            If the parameter `dynamics_node` is no name of a node.

        """
        super().__init__('markers', **options)
        self.errors = ErrorReport(self.get_logger())
        self._followed = FollowedNode(self, self._full_name(), self._on_settings)
        self._publisher = self.create_publisher(
            MarkerArray, f'{self._followed.name}/markers', RESULT, event_callbacks=NO_EVENTS
        )
        self._view: RobotView | None = None
        self._source, self._refused = None, {}
        self._text = None
        self._description = self.create_subscription(
            String,
            'robot_description',
            self._on_description,
            ROBOT_DESCRIPTION,
            event_callbacks=NO_SUBSCRIPTION_EVENTS,
        )
        self._inputs: list = []  # subscriptions to joint states and gravity torque
        self._state_group, self._torque_group = LimitedGroup(), LimitedGroup()
        self._stamp, self._state_time = None, 0.0
        self._messages = MarkerMessages()
        self._missing: list | None = None
        # Steady, so that a simulated time that stands still stops neither this nor the exit.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = self.create_timer(PERIOD, self._every_period, clock=steady)
        self._check_timer = self.create_timer(CHECK_EVERY, self._check, clock=steady)

    def _full_name(self):
        given = self.declare_parameter(
            'dynamics_node',
            'dynamics_node',
            ParameterDescriptor(
                description='Name of the dynamics node that markers are drawn for, relative to '
                'the namespace of this program',
                read_only=True,
            ),
        ).value
        try:
            name = expand_topic_name(given, self.get_name(), self.get_namespace())
            validate_full_topic_name(name)
        except Exception as error:
            raise ValueError(
                f'dynamics_node: expected the name of a node, got {given!r}: {error}'
            ) from error
        return name

    def spin_once(self, executor):
        """
        Run one callback.

        Parameters
        ----------
        executor : rclpy.executors.Executor

        """
        try:
            executor.spin_once()
        except Exception as error:
            # Not from the callbacks here: rclpy raises, say, for a text that is not UTF-8.
            self.errors.log('rclpy', error)

    # Description and settings -----------------------------------------------------------------

    @reported
    def _on_description(self, message):
        self._text = message.data.encode(errors='surrogatepass')
        self._choose_description()

    @reported
    def _on_settings(self, are_read_anew):
        if are_read_anew:
            self._source = None  # a file may have changed
            self._refused.clear()
            self._choose_description()
        self._configure()

    def _choose_description(self):
        for source, origin in self._descriptions():
            if source == self._source:
                return
            if self._refused.get(origin) != source and self._take(source, origin):
                return

    def _descriptions(self):
        # The first one that can be used is shown: the dynamics node has the same order.
        settings = self._followed.settings or {}
        if settings.get('robot_description'):
            yield (
                settings['robot_description'].encode(errors='surrogatepass'),
                f'parameter robot_description of {self._followed.name}',
            )
        if settings.get('robot_description_file'):
            path = settings['robot_description_file']
            yield path, f'parameter robot_description_file of {self._followed.name} ({path})'
        if self._text is not None:
            yield self._text, f'topic {self._description.topic_name}'

    def _take(self, source, origin):
        try:
            view = RobotView(source)
        except DynamicsError as error:
            self._refused[origin] = source
            kept = 'the one before is shown' if self._view else 'waiting for another one'
            self.get_logger().error(f'robot description from {origin} refused, {kept}: {error}')
            return False
        self._view, self._source = view, source
        self.get_logger().info(
            f'robot description from {origin}: joints {", ".join(view.model.joint_names)}'
        )
        self._configure()
        return True

    def _configure(self):
        if self._view is None:
            return
        try:
            self._view.configure(self._followed.settings)
        except DynamicsError as error:
            self.get_logger().error(
                f'parameters of {self._followed.name} do not fit the robot description, masses '
                f'are shown without them: {error}',
                throttle_duration_sec=10.0,
            )

    # States -----------------------------------------------------------------------------------

    @reported
    def _on_state(self, message):
        if self._view is not None:
            self._view.take_state(message.name, message.position, message.effort)
            self._stamp, self._state_time = message.header.stamp, time.monotonic()

    @reported
    def _on_torque(self, message):
        if self._view is not None:
            self._view.take_torque(message.name, message.effort, time.monotonic())

    @reported
    def _every_period(self):
        has_subscriber = self._publisher.get_subscription_count() > 0
        if has_subscriber != bool(self._inputs):
            (self._begin if has_subscriber else self._end)()
        if not has_subscriber:
            return
        self._state_group.allow(STATES_AT_ONCE)
        self._torque_group.allow(1)
        if self._view is not None and self._view.has_new_state:
            self._publish(self._view)

    def _begin(self):
        self._inputs = [
            self.create_subscription(
                JointState,
                topic,
                callback,
                qos,
                callback_group=group,
                event_callbacks=NO_SUBSCRIPTION_EVENTS,
            )
            for topic, callback, qos, group in (
                ('joint_states', self._on_state, joint_states(True), self._state_group),
                (
                    self._followed.torque_topic,
                    self._on_torque,
                    joint_states(False),
                    self._torque_group,
                ),
            )
        ]
        # A new viewer gets DELETEALL first.
        self._messages, self._state_time = MarkerMessages(), time.monotonic()

    def _end(self):
        for subscription in self._inputs:
            self.destroy_subscription(subscription)
        self._inputs = []

    def _publish(self, view):
        message = self._messages.make(
            view.shapes(time.monotonic()), self._stamp, view.model.tree.root
        )
        if message.markers:
            self._publisher.publish(message)

    # What is missing --------------------------------------------------------------------------

    @reported
    def _check(self):
        self._followed.check()
        missing = self._find_missing()
        if missing == self._missing:
            return
        self._missing = missing
        topic = self._publisher.topic_name
        self.get_logger().info(
            f'waiting for {"; ".join(missing)}'
            if missing
            else f'drawing on {topic} while it has a subscriber'
        )

    def _find_missing(self):
        missing = []
        if self._view is None:
            missing.append(f'a robot description on {self._description.topic_name}')
        if self._followed.settings is None:
            missing.append(
                f'the dynamics node {self._followed.name}, without which only masses are drawn'
            )
        if self._inputs and time.monotonic() - self._state_time > 2.0 * CHECK_EVERY:
            missing.append(f'joint states on {self._inputs[0].topic_name}')
        return missing
