"""Check that the controllers on the command topic expect its efforts, and are active."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TYPE_CHECKING

from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.qos import QoSProfile

from ..support.qos import NO_SUBSCRIPTION_EVENTS

if TYPE_CHECKING:
    from rclpy.node import Node

try:  # part of ros2_control, so present on robots with its controllers
    from controller_manager_msgs.srv import ListControllers
except ImportError:
    ListControllers = None

# Longest time for the discovery and the answers of the services of a listener, s.
ANSWER_WITHIN = 1.0
# Name that rmw reports for a node whose discovery is incomplete.
UNKNOWN_NAME = '_NODE_NAME_UNKNOWN_'
EVENTS = QoSProfile(depth=10)
PARAMETERS = ('joints', 'interface_name')
_LIFECYCLE_NAMES = {
    State.PRIMARY_STATE_UNCONFIGURED: 'unconfigured',
    State.PRIMARY_STATE_INACTIVE: 'inactive',
    State.PRIMARY_STATE_ACTIVE: 'active',
    State.PRIMARY_STATE_FINALIZED: 'finalized',
    State.TRANSITION_STATE_CONFIGURING: 'configuring',
    State.TRANSITION_STATE_CLEANINGUP: 'being cleaned up',
    State.TRANSITION_STATE_SHUTTINGDOWN: 'shutting down',
    State.TRANSITION_STATE_ACTIVATING: 'being activated',
    State.TRANSITION_STATE_DEACTIVATING: 'being deactivated',
    State.TRANSITION_STATE_ERRORPROCESSING: 'in error',
}


class Controllers:
    """
    Compares the controllers on the command topic with the commands of the node, periodically.

    An array of efforts does not name its joints: a controller with another order gives every joint
    the effort of another one, and a position controller reads efforts as angles. The controllers
    of ros2_control have both as parameters, `joints` and `interface_name`, and publish their
    lifecycle on `transition_event`. A listener without these parameters is trusted.

    Attributes
    ----------
    listeners : dict of str to Listener
        Fully qualified name → its state.
    has_unnamed : bool
        Whether a listener was discovered without its name.
    renewed : list of str
        Names of the controllers that were restarted before the last `update`. A killed node stays
        in the graph for up to 20 s, beside the new node of the same name.

    """

    def __init__(self, node: Node, topic: str) -> None:
        """
        Start without listeners; `update` finds them.

        Parameters
        ----------
        node : rclpy.node.Node
        topic : str
            Resolved name of the command topic.

        """
        self._node = node
        self._topic = topic
        self.listeners: dict[str, Listener] = {}
        self.has_unnamed = False
        self.renewed: list[str] = []
        self._new: list[str] = []

    def update(self) -> list[str]:
        """
        Find the listeners, send requests to new ones, and read the answers.

        Returns
        -------
        list of str
            Names of the controllers that no longer listen, also of one that was replaced by
            another of the same name.

        """
        found = self._endpoints_by_name()
        before = {name: item.endpoints for name, item in self.listeners.items()}
        gone = [
            name
            for name, item in self.listeners.items()
            if item.endpoints.isdisjoint(found.get(name, ()))
        ]
        closed = [self.listeners.pop(name) for name in gone]
        for listener in closed:
            listener.close()
        for name, endpoints in found.items():
            listener = self.listeners.get(name) or Listener(self._node, name)
            listener.endpoints = endpoints
            self.listeners[name] = listener
            listener.update()
        self._new = [
            name for name, endpoints in found.items() if endpoints - before.get(name, set())
        ]
        self.renewed = [
            name for name in self._new if name in before and self.listeners[name].is_controller
        ]
        for name in self.renewed:
            self._replace(name)
        return sorted(item.name for item in closed if item.is_controller)

    def _replace(self, name: str) -> None:
        # The new process may have other parameters and another lifecycle state.
        before = self.listeners[name]
        before.close()
        self.listeners[name] = Listener(self._node, name)
        self.listeners[name].endpoints = before.endpoints

    def ask_again(self) -> None:
        """Discard the answers of all listeners: their parameters may have changed."""
        for listener in self.listeners.values():
            listener.ask_again()

    def is_waiting(self) -> bool:
        """Return whether the name or the answers of a listener are missing."""
        return self.has_unnamed or any(not item.has_answered for item in self.listeners.values())

    def refusals(self, joint_names: Sequence[str]) -> list[str]:
        """
        Return every reason of the listeners against sending efforts to them.

        Parameters
        ----------
        joint_names : sequence of str
            In the order of the command.

        Returns
        -------
        list of str

        """
        return [
            reason
            for item in self.listeners.values()
            for reason in item.mismatches(list(joint_names)) + item.inactive()
        ]

    def notes(self) -> list[str]:
        """Return a message for each listener without an answer or a name."""
        notes = [
            f'{item.name}, which listens there, did not report its joints within '
            f'{ANSWER_WITHIN:g} s; the node keeps asking, and stops the output if they differ'
            for item in self.listeners.values()
            if not item.has_answered
        ]
        if self.has_unnamed:
            notes.append('a listener there has not been identified yet')
        return notes

    def has_listener(self) -> bool:
        """Return whether a listener exists that may be a controller."""
        return bool(self.listeners) or self.has_unnamed

    def takes_commands(self) -> bool:
        """Return whether a controller that is not inactive received the last commands."""
        return any(
            item.is_controller and not item.inactive()
            for name, item in self.listeners.items()
            if name not in self._new
        )

    def _endpoints_by_name(self) -> dict[str, set]:
        own = self._node.get_fully_qualified_name()
        infos = self._node.get_subscriptions_info_by_topic(self._topic)
        self.has_unnamed = any(info.node_name in ('', UNKNOWN_NAME) for info in infos)
        found: dict[str, set] = {}
        for info in infos:
            name = f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            # Other hidden names are those of command line tools, which have no parameters.
            if info.node_name and not info.node_name.startswith('_') and name != own:
                found.setdefault(name, set()).add(tuple(info.endpoint_gid))
        return found


class Listener:
    """
    One node that listens to the commands.

    Attributes
    ----------
    name : str
        Fully qualified.
    endpoints : set of tuple
        Identifiers of its subscriptions.

    """

    def __init__(self, node: Node, name: str) -> None:
        self.name = name
        self.endpoints: set = set()
        self._node = node
        self._clients: dict[str, Any] = {}
        self._answers: dict[str, Any] = {}
        self._state_answer: Any = None
        self._list_answer: Any = None
        self._events: Any = None
        self._state: int | None = None

    def update(self) -> None:
        """Send the requests whose services are ready, and subscribe to the lifecycle events."""
        self._ask_parameters()
        self._ask_state()
        if self.has_answered:
            self._release()  # every client costs time in every wait of the executor
        if self._events is None and self._node.count_publishers(f'{self.name}/transition_event'):
            self._events = self._node.create_subscription(
                TransitionEvent,
                f'{self.name}/transition_event',
                self._changed,
                EVENTS,
                event_callbacks=NO_SUBSCRIPTION_EVENTS,
            )

    def ask_again(self) -> None:
        """Discard the answers, but not the lifecycle of the last event."""
        self._answers = {}
        self._state_answer = self._list_answer = None

    @property
    def has_answered(self) -> bool:
        """Whether its parameters are known, and its lifecycle if it has the service."""
        answers = [*self._answers.values(), self._state_answer, self._list_answer]
        return bool(self._answers) and all(answer is None or answer.done() for answer in answers)

    @property
    def is_controller(self) -> bool:
        """Whether it has the parameter `joints`."""
        return self._value('joints').type == ParameterType.PARAMETER_STRING_ARRAY

    def mismatches(self, joint_names: list[str]) -> list[str]:
        """Return the differences between its parameters and the commands."""
        reasons = []
        joints = self._value('joints')
        if joints.type == ParameterType.PARAMETER_STRING_ARRAY:
            its_joints = list(joints.string_array_value)
            if its_joints != joint_names:
                has_same = sorted(its_joints) == sorted(joint_names)
                difference = 'order' if has_same else 'number or names'
                reasons.append(
                    f'{self.name} has another {difference} of the joints: its parameter joints is '
                    f'[{", ".join(its_joints)}], here it is [{", ".join(joint_names)}]; '
                    'make them equal'
                )
        interface = self._value('interface_name')
        if interface.type == ParameterType.PARAMETER_STRING and interface.string_value not in (
            '',
            'effort',
        ):
            reasons.append(
                f'{self.name} drives {interface.string_value}, expected effort: '
                'command_topic must be that of an effort controller'
            )
        return reasons

    def inactive(self) -> list[str]:
        """Return the reason, as a list, if its lifecycle is known and not active."""
        state = self._lifecycle()
        if state is None or state == 'active':
            return []
        namespace, _, controller = self.name.rpartition('/')
        manager = f' -c {namespace}/controller_manager' if namespace else ''
        return [
            f'{self.name} is {state}: the efforts would not reach the arm; activate it first, '
            f'with  ros2 control set_controller_state{manager} {controller} active'
        ]

    def close(self) -> None:
        """Destroy its clients and subscription."""
        self._release()
        if self._events is not None:
            self._node.destroy_subscription(self._events)
            self._events = None

    def _release(self):
        for client in self._clients.values():
            self._node.destroy_client(client)
        self._clients = {}

    def _ask_parameters(self):
        client = (
            None if self._answers else self._ready(GetParameters, f'{self.name}/get_parameters')
        )
        if client is not None:
            # One request per parameter: rclcpp returns no value if one of several is missing.
            self._answers = {
                name: client.call_async(GetParameters.Request(names=[name])) for name in PARAMETERS
            }

    def _ask_state(self):
        # From the node itself or from the controller manager: the controllers of ros2_control have
        # no get_state of their own.
        if self._state_answer is None and (
            client := self._ready(GetState, f'{self.name}/get_state')
        ):
            self._state_answer = client.call_async(GetState.Request())
        manager = f'{self.name.rpartition("/")[0]}/controller_manager/list_controllers'
        if (
            ListControllers is not None
            and self._list_answer is None
            and (client := self._ready(ListControllers, manager))
        ):
            self._list_answer = client.call_async(ListControllers.Request())

    def _ready(self, kind: Any, service: str) -> Any:
        # A client of a service that is ready; None otherwise. Clients of missing services are not
        # created.
        if service not in self._clients:
            if not self._node.count_services(service):
                return None
            self._clients[service] = self._node.create_client(kind, service)
        client = self._clients[service]
        return client if client.service_is_ready() else None

    def _lifecycle(self) -> str | None:
        # Events are newer than answers.
        if self._state is not None:
            return _LIFECYCLE_NAMES.get(self._state, f'in transition {self._state}')
        if self._state_answer is not None and self._state_answer.done():
            return self._state_answer.result().current_state.label
        if self._list_answer is not None and self._list_answer.done():
            name = self.name.rpartition('/')[2]
            return next(
                (
                    item.state
                    for item in self._list_answer.result().controller
                    if item.name == name
                ),
                None,
            )
        return None

    def _changed(self, event: TransitionEvent) -> None:
        self._state = event.goal_state.id

    def _value(self, name: str) -> ParameterValue:
        answer = self._answers.get(name)
        values = answer.result().values if answer is not None and answer.done() else []
        return values[0] if values else ParameterValue()
