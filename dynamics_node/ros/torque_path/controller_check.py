"""Check that subscribers of the command topic expect these efforts and are active."""

from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.qos import QoSProfile

from ..support.qos import NO_SUBSCRIPTION_EVENTS

try:  # part of ros2_control: on a robot with controllers it is there
    from controller_manager_msgs.srv import ListControllers
except ImportError:
    ListControllers = None

# Longest time for a subscriber's services to be discovered and to answer, s.
ANSWER_WITHIN = 1.0
# Name that rmw reports for a partly discovered node.
UNKNOWN_NAME = '_NODE_NAME_UNKNOWN_'
EVENTS = QoSProfile(depth=10)
PARAMETERS = ('joints', 'interface_name')


class Controllers:
    """
    Checks that the controllers on the command topic expect efforts for the same joints in order.

    An array of efforts says nothing about its joints: a controller with another order gives
    every joint the effort of another one, and one for positions takes efforts for angles. The
    controllers of ros2_control state both as parameters, `joints` and `interface_name`, and
    publish their lifecycle on `transition_event`. A listener without these parameters is trusted.

    Attributes
    ----------
    listeners : dict of str to Listener
        Fully qualified name → what is known of it.
    has_unnamed : bool
        Whether discovery knows a listener whose name it does not know yet.
    renewed : list of str
        Names of the controllers that were started again before the last `update`. A killed node
        stays in the graph for up to 20 s, beside the new node of the same name.

    """

    def __init__(self, node, topic):
        """
        Watch the listeners of a topic, whenever `update` is called.

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

    def update(self):
        """
        Find the subscribers, ask new ones, and read the answers.

        Returns
        -------
        list of str
            Names of the controllers that no longer listen. One that has been replaced by another
            of the same name is among them.

        """
        found = self._found()
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
            self._ask_anew(name)
        return sorted(item.name for item in closed if item.is_controller)

    def _ask_anew(self, name):
        # The new process may have other parameters and another lifecycle state.
        before = self.listeners[name]
        before.close()
        self.listeners[name] = Listener(self._node, name)
        self.listeners[name].endpoints = before.endpoints

    def ask_again(self):
        """Discard the answers: parameters of the controllers may have changed."""
        for listener in self.listeners.values():
            listener.ask_again()

    def is_waiting(self):
        """Whether a listener has yet to be named or to answer."""
        return self.has_unnamed or any(not item.has_answered for item in self.listeners.values())

    def refusals(self, joint_names):
        """
        Return why the listeners must not be driven.

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

    def notes(self):
        """Return what could not be checked, a list of str."""
        notes = [
            f'{item.name}, which listens there, did not say within {ANSWER_WITHIN:g} s which '
            'joints it drives; it is asked on, and stops the output if it does not fit'
            for item in self.listeners.values()
            if not item.has_answered
        ]
        if self.has_unnamed:
            notes.append('a listener there has not been identified yet')
        return notes

    def has_listener(self):
        """Whether there is a listener that may be a controller."""
        return bool(self.listeners) or self.has_unnamed

    def takes_commands(self):
        """Return whether a controller that is not inactive has got the last commands."""
        return any(
            item.is_controller and not item.inactive()
            for name, item in self.listeners.items()
            if name not in self._new
        )

    def _found(self):
        # Name → endpoints of each listener.
        own = self._node.get_fully_qualified_name()
        infos = self._node.get_subscriptions_info_by_topic(self._topic)
        self.has_unnamed = any(info.node_name in ('', UNKNOWN_NAME) for info in infos)
        found: dict[str, set] = {}
        for info in infos:
            name = f'{info.node_namespace.rstrip("/")}/{info.node_name}'
            # Other hidden names belong to command line tools, which have no parameters.
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

    def __init__(self, node, name):
        self.name = name
        self.endpoints: set = set()
        self._node = node
        self._clients: dict = {}
        self._answers: dict = {}
        self._state_answer = self._list_answer = None
        self._events = None
        self._state: int | None = None

    def update(self):
        """Ask as soon as that is possible, and read what has been answered."""
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

    def ask_again(self):
        """Discard the answers, but not an observed change of lifecycle."""
        self._answers = {}
        self._state_answer = self._list_answer = None

    @property
    def has_answered(self):
        """Whether its parameters are known, and its lifecycle if it tells that."""
        answers = [*self._answers.values(), self._state_answer, self._list_answer]
        return bool(self._answers) and all(answer is None or answer.done() for answer in answers)

    @property
    def is_controller(self):
        """Whether it says which joints it drives."""
        return self._value('joints').type == ParameterType.PARAMETER_STRING_ARRAY

    def mismatches(self, joint_names):
        """Return why its parameters forbid driving it, a list of str."""
        reasons = []
        joints = self._value('joints')
        if joints.type == ParameterType.PARAMETER_STRING_ARRAY:
            theirs = list(joints.string_array_value)
            if theirs != joint_names:
                has_same = sorted(theirs) == sorted(joint_names)
                what = 'order of the joints' if has_same else 'number or names of the joints'
                reasons.append(
                    f'{self.name} has another {what}: its parameter joints is '
                    f'[{", ".join(theirs)}], here it is [{", ".join(joint_names)}]; '
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

    def inactive(self):
        """Return a list with the reason if its lifecycle is known and not active."""
        state = self._lifecycle()
        if state is None or state == 'active':
            return []
        namespace, _, controller = self.name.rpartition('/')
        manager = f' -c {namespace}/controller_manager' if namespace else ''
        return [
            f'{self.name} is {state}: the efforts would not reach the arm; activate it first, '
            f'with  ros2 control set_controller_state{manager} {controller} active'
        ]

    def close(self):
        """Destroy clients and subscription."""
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
            # One at a time: rclcpp answers nothing at all if one of several does not exist.
            self._answers = {
                name: client.call_async(GetParameters.Request(names=[name])) for name in PARAMETERS
            }

    def _ask_state(self):
        # The lifecycle as the node offers it, or as the controller manager knows it: the
        # controllers of ros2_control have no get_state of their own.
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

    def _ready(self, kind, service):
        # A client, made only where the service exists; None while it cannot be called.
        if service not in self._clients:
            if not self._node.count_services(service):
                return None
            self._clients[service] = self._node.create_client(kind, service)
        client = self._clients[service]
        return client if client.service_is_ready() else None

    def _lifecycle(self):
        # An observed change is newer than an earlier answer.
        if self._state is not None:
            return _WORDS.get(self._state, f'in transition {self._state}')
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

    def _changed(self, event):
        self._state = event.goal_state.id

    def _value(self, name):
        answer = self._answers.get(name)
        values = answer.result().values if answer is not None and answer.done() else []
        return values[0] if values else ParameterValue()


_WORDS = {
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
