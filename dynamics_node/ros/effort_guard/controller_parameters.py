"""The parameters `joints` and `interface_name` of the controller, mirrored by the guard."""

from __future__ import annotations

import time
from typing import Any, TYPE_CHECKING

from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rcl_interfaces.srv import GetParameters
from rclpy.parameter import Parameter, parameter_value_to_python

from ..support.callback_errors import logged

if TYPE_CHECKING:
    from rclpy.node import Node

_TYPES = {
    'joints': ParameterType.PARAMETER_STRING_ARRAY,
    'interface_name': ParameterType.PARAMETER_STRING,
}
# Time after which a request counts as lost, s.
LOST_AFTER = 2.0


class ControllerParameters:
    """
    Requests joints and interface from the listeners of the output topic, and mirrors the answers.

    The dynamics node requests both from the listeners of its command topic before it is enabled.
    With the guard in between it asks the guard, which must answer for the controller. While the
    listeners have not answered, or if they have no such parameters, the guard has none either, and
    the node trusts it like any listener without them. Contradictory answers are mirrored together,
    so that the node refuses and shows both.

    Attributes
    ----------
    joint_count : int or None
        Number of joints that the controllers drive; None while unknown or contradictory.

    """

    def __init__(self, node: Node, topic: str) -> None:
        """
        Start without requests; `ask` sends them.

        Parameters
        ----------
        node : rclpy.node.Node
        topic : str
            Resolved name of the output topic.

        """
        self.logger = node.get_logger()
        self.joint_count: int | None = None
        self._node = node
        self._topic = topic
        self._listeners: dict[str, _Listener] = {}
        self._is_own_change = False
        node.add_on_set_parameters_callback(self._check)

    @logged
    def ask(self) -> None:
        """Mirror the answers, and send the requests again; to be called periodically."""
        names = self._names()
        for name in set(self._listeners) - names:
            self._listeners.pop(name).close()
        for name in names - set(self._listeners):
            self._listeners[name] = _Listener(self._node, name)
        for listener in self._listeners.values():
            listener.ask()
        self._mirror_answers()

    def _names(self) -> set[str]:
        own = self._node.get_fully_qualified_name()
        return {
            f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            for info in self._node.get_subscriptions_info_by_topic(self._topic)
            # Command line tools have hidden names and no parameters.
            if info.node_name and not info.node_name.startswith('_')
        } - {own}

    def _mirror_answers(self) -> None:
        known = {name: listener.values for name, listener in sorted(self._listeners.items())}
        joints = {name: values['joints'] for name, values in known.items() if 'joints' in values}
        interfaces = {
            values['interface_name'] for values in known.values() if 'interface_name' in values
        } - {''}
        different = {tuple(names) for names in joints.values()}
        self.joint_count = len(next(iter(different))) if len(different) == 1 else None
        self._declare(
            'joints',
            list(next(iter(different)))
            if len(different) == 1
            else [f'{name}: {" ".join(names)}' for name, names in joints.items()] or None,
        )
        # An interface other than effort, if there is one, so that the node refuses it.
        self._declare(
            'interface_name', min(interfaces, key=lambda name: name == 'effort', default=None)
        )

    def _declare(self, name: str, value: Any) -> None:
        is_declared = self._node.has_parameter(name)
        if is_declared and self._node.get_parameter(name).value == value:
            return
        self._is_own_change = True
        try:
            if value is None:
                if is_declared:
                    self._node.undeclare_parameter(name)
                return
            if is_declared:
                self._node.set_parameters([Parameter(name, value=value)])
            else:
                self._node.declare_parameter(
                    name,
                    value,
                    ParameterDescriptor(
                        description='That of the controller behind the guard; cannot be set'
                    ),
                    ignore_override=True,
                )
            self.logger.info(f'{name} of the controller: {value}')
        finally:
            self._is_own_change = False

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        mirrored = [item.name for item in parameters if item.name in _TYPES]
        if mirrored and not self._is_own_change:
            return SetParametersResult(
                successful=False,
                reason=f'{", ".join(mirrored)}: those of the controller, set them there',
            )
        return SetParametersResult(successful=True)


class _Listener:
    """Requests to one listener, and its last answers."""

    def __init__(self, node: Node, name: str) -> None:
        self.values: dict[str, Any] = {}
        self._node = node
        self._futures: dict[str, Any] = {}
        self._asked_at = 0.0
        try:
            self._client: Any = node.create_client(GetParameters, f'{name}/get_parameters')
        except Exception as error:  # DDS security may forbid it
            self._client = None
            node.get_logger().warning(f'{name} cannot be asked for its joints: {error}')

    def ask(self) -> None:
        """Read the answers that have arrived, and send the requests again."""
        if self._futures and all(future.done() for future in self._futures.values()):
            self.values = {
                name: value
                for name, future in self._futures.items()
                if (value := _value(name, future)) is not None
            }
            self._futures = {}
        if self._futures and time.monotonic() - self._asked_at > LOST_AFTER:
            self._discard_requests()
        if not self._futures and self._client is not None and self._client.service_is_ready():
            self._asked_at = time.monotonic()
            # One request per parameter: rclcpp returns no value if one of several is missing.
            self._futures = {
                name: self._client.call_async(GetParameters.Request(names=[name]))
                for name in _TYPES
            }

    def _discard_requests(self) -> None:
        for future in self._futures.values():
            self._client.remove_pending_request(future)
        self._futures = {}

    def close(self) -> None:
        """Destroy the client."""
        if self._client is not None:
            self._discard_requests()
            self._node.destroy_client(self._client)


def _value(name: str, future: Any) -> Any:
    response = None if future.exception() else future.result()
    if response is None or not response.values or response.values[0].type != _TYPES[name]:
        return None
    return parameter_value_to_python(response.values[0])
