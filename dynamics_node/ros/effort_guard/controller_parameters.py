"""The controller's `joints` and `interface_name`, offered as the guard's own parameters."""

import time

from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rcl_interfaces.srv import GetParameters
from rclpy.parameter import Parameter, parameter_value_to_python

from ..support.callback_errors import logged

_KINDS = {
    'joints': ParameterType.PARAMETER_STRING_ARRAY,
    'interface_name': ParameterType.PARAMETER_STRING,
}
# A request without an answer counts as lost after this time, s.
LOST_AFTER = 2.0


class ControllerParameters:
    """
    Asks the listeners of the output topic for joints and interface, and repeats their answers.

    The dynamics node asks the listeners of its command topic for both before it is enabled. With
    the guard in between it asks the guard, which must answer for the controller. As long as
    nothing is known, or where a listener has no such parameters, the guard has none either, and
    the node trusts it as it trusts such a listener. Listeners that contradict each other are
    repeated as such, so that the node refuses and shows both.

    Attributes
    ----------
    joint_count : int or None
        How many joints the controllers drive; None while unknown or contradictory.

    """

    def __init__(self, node, topic):
        """
        Start without any request.

        Parameters
        ----------
        node : rclpy.node.Node
        topic : str
            Resolved name of the output topic.

        """
        self.logger = node.get_logger()
        self.joint_count = None
        self._node = node
        self._topic = topic
        self._listeners: dict[str, _Listener] = {}
        self._is_own_change = False
        node.add_on_set_parameters_callback(self._check)

    @logged
    def ask(self):
        """Take over the answers, and ask again; called once a second."""
        names = self._names()
        for name in set(self._listeners) - names:
            self._listeners.pop(name).close()
        for name in names - set(self._listeners):
            self._listeners[name] = _Listener(self._node, name)
        for listener in self._listeners.values():
            listener.ask()
        self._take_over()

    def _names(self):
        own = self._node.get_fully_qualified_name()
        return {
            f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            for info in self._node.get_subscriptions_info_by_topic(self._topic)
            # Command line tools have hidden names and no parameters.
            if info.node_name and not info.node_name.startswith('_')
        } - {own}

    def _take_over(self):
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
        # The listener that refuses efforts, if there is one.
        self._declare(
            'interface_name', min(interfaces, key=lambda name: name == 'effort', default=None)
        )

    def _declare(self, name, value):
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

    def _check(self, parameters):
        mirrored = [item.name for item in parameters if item.name in _KINDS]
        if mirrored and not self._is_own_change:
            return SetParametersResult(
                successful=False,
                reason=f'{", ".join(mirrored)}: those of the controller, set them there',
            )
        return SetParametersResult(successful=True)


class _Listener:
    """The open request to one listener, and its last answer."""

    def __init__(self, node, name):
        self.values = {}
        self._node = node
        self._futures = {}
        self._asked_at = 0.0
        try:
            self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        except Exception as error:  # DDS security may forbid it
            self._client = None
            node.get_logger().warning(f'{name} cannot be asked for its joints: {error}')

    def ask(self):
        """Take the answers that have come, and ask again."""
        if self._futures and all(future.done() for future in self._futures.values()):
            self.values = {
                name: value
                for name, future in self._futures.items()
                if (value := _value(name, future)) is not None
            }
            self._futures = {}
        if self._futures and time.monotonic() - self._asked_at > LOST_AFTER:
            self._forget()
        if not self._futures and self._client is not None and self._client.service_is_ready():
            self._asked_at = time.monotonic()
            # One at a time: rclcpp answers nothing at all if one of several does not exist.
            self._futures = {
                name: self._client.call_async(GetParameters.Request(names=[name]))
                for name in _KINDS
            }

    def _forget(self):
        for future in self._futures.values():
            self._client.remove_pending_request(future)
        self._futures = {}

    def close(self):
        """Destroy the client."""
        if self._client is not None:
            self._forget()
            self._node.destroy_client(self._client)


def _value(name, future):
    response = None if future.exception() else future.result()
    if response is None or not response.values or response.values[0].type != _KINDS[name]:
        return None
    return parameter_value_to_python(response.values[0])
