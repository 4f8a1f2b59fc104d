"""`FollowedNode`: the dynamics node that markers are drawn for, and its parameters."""

from collections.abc import Callable
import time
from typing import Any

from rcl_interfaces.msg import ParameterEvent
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import qos_profile_parameter_events
from rclpy.task import Future

from .callbacks import ErrorReport, reported
from ...ros.support.qos import NO_SUBSCRIPTION_EVENTS

NAMES = (
    'robot_description',
    'robot_description_file',
    'joints',
    'gravity',
    'effort_limits',
    'payload.link',
    'payload.mass',
    'payload.com',
    'payload.inertia',
)
# Time after which a request is repeated, s.
ANSWER_WITHIN = 5.0


class FollowedNode:
    """
    Reads the parameters of another node once, then follows its parameter events.

    Attributes
    ----------
    name : str
        Full name of the other node.
    settings : dict of str to Any or None
        NAMES → values in force; None while the other node has not answered or is gone.

    """

    def __init__(self, node: Node, name: str, on_settings: Callable[[bool], None]) -> None:
        """
        Create the client and the subscription.

        Parameters
        ----------
        node : rclpy.node.Node
        name : str
            Full name of the other node.
        on_settings : callable(bool)
            Called after a change of `settings`; with True if all were read again: the other node
            may then have another description.

        """
        self.name = name
        self.settings: dict[str, Any] | None = None
        self.torque_topic = f'{name}/gravity_torque'
        self.errors = ErrorReport(node.get_logger())
        self._node, self._on_settings = node, on_settings
        self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        node.create_subscription(
            ParameterEvent,
            '/parameter_events',
            self._on_event,
            qos_profile_parameter_events,
            event_callbacks=NO_SUBSCRIPTION_EVENTS,
        )
        self._identity: tuple[tuple[int, ...], ...] | None = None
        self._pending: Future | None = None
        self._asked_at = 0.0
        self._is_outdated = False

    def check(self) -> None:
        """Detect start, end and restart of the other node."""
        # A restarted node has publishers with other identities.
        identity = tuple(
            sorted(
                tuple(info.endpoint_gid)
                for info in self._node.get_publishers_info_by_topic(self.torque_topic)
            )
        )
        if not identity:
            self._identity = None
            if self.settings is not None:
                self.settings = None
                self._on_settings(False)
        elif not self._client.service_is_ready():
            pass  # it is starting
        elif identity != self._identity or self._is_overdue():
            self._identity = identity
            self._ask()

    def _is_overdue(self) -> bool:
        return self._pending is not None and time.monotonic() - self._asked_at > ANSWER_WITHIN

    def _ask(self) -> None:
        if self._pending is not None:
            self._client.remove_pending_request(self._pending)
        self._is_outdated, self._asked_at = False, time.monotonic()
        self._pending = self._client.call_async(GetParameters.Request(names=NAMES))
        self._pending.add_done_callback(self._on_answer)

    @reported
    def _on_answer(self, future: Future) -> None:
        if future is not self._pending:
            return
        if self._is_outdated:  # the answer may be older than an event
            self._ask()
            return
        self._pending = None
        values = future.result().values
        if len(values) != len(NAMES):
            self._node.get_logger().error(
                f'{self.name} lacks parameters: expected a dynamics_node with '
                f'{", ".join(NAMES)}; set the parameter dynamics_node of this program to the '
                'name of one'
            )
            return
        self.settings = dict(zip(NAMES, map(parameter_value_to_python, values), strict=True))
        self._on_settings(True)

    @reported
    def _on_event(self, event: ParameterEvent) -> None:
        if event.node != self.name:
            return
        changed = {
            item.name: parameter_value_to_python(item.value)
            for item in (*event.new_parameters, *event.changed_parameters)
            if item.name in NAMES
        }
        if not changed:
            return
        if self._pending is not None:
            self._is_outdated = True
        elif None in changed.values():
            # The node is declaring its parameters: it has been restarted.
            self._identity = None
        elif self.settings is not None:
            self.settings = {**self.settings, **changed}
            self._on_settings(False)
