"""Asks whoever listens to the commands whether it takes them for what they are."""

import time

from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.clock import Clock, ClockType

from .guard import logged

# How often it is looked whether all have answered, s.
STEP = 0.02
# How long a listener's parameter service may take to be found and to answer, s.
ANSWER_WITHIN = 1.0


class ControllerCheck:
    """
    Compares joints and interface of the effort controller with what the node sends.

    An array of efforts says nothing about its joints: a controller with another order gives
    every joint the effort of another one, and one for positions takes efforts for angles. The
    controllers of ros2_control state both as parameters, `joints` and `interface_name`; a
    listener without them is taken to know what it does.

    """

    def __init__(self, node, topic):
        """
        Check the listeners of a topic, whenever `begin` is called.

        Parameters
        ----------
        node : rclpy.node.Node
        topic : str
            Resolved name of the command topic.

        """
        self.logger = node.get_logger()
        self._node = node
        self._topic = topic
        self._questions = []
        self._timer = node.create_timer(STEP, self._look,
                                        clock=Clock(clock_type=ClockType.STEADY_TIME))
        self._timer.cancel()

    @property
    def is_busy(self):
        """Whether answers are being waited for."""
        return bool(self._questions)

    def begin(self, joint_names, on_done):
        """
        Ask every listener.

        Parameters
        ----------
        joint_names : sequence of str
            In the order of the command.
        on_done : callable(refusals, notes)
            Called once, from a callback or at once: two lists of str.

        """
        self._joint_names = list(joint_names)
        self._on_done = on_done
        self._begun = time.monotonic()
        self._questions = [_Question(self._node, name) for name in self._listeners()]
        if self._questions:
            self._timer.reset()
        else:
            on_done([], [])

    def _listeners(self):
        own = self._node.get_fully_qualified_name()
        names = {f'{info.node_namespace.rstrip("/")}/{info.node_name}'
                 for info in self._node.get_subscriptions_info_by_topic(self._topic)
                 # Command line tools have hidden names and no parameters.
                 if info.node_name and not info.node_name.startswith('_')}
        return sorted(names - {own})

    @logged
    def _look(self):
        elapsed = time.monotonic() - self._begun
        for question in self._questions:  # each of them, however long another one takes
            question.ask()
        if elapsed < ANSWER_WITHIN and any(item.is_unanswered for item in self._questions):
            return
        self._timer.cancel()
        questions, self._questions = self._questions, []
        refusals, notes = [], []
        for question in questions:
            refusals += question.refusals(self._joint_names)
            if question.is_unanswered:
                notes.append(f'{question.name}, which listens there, did not say within '
                             f'{ANSWER_WITHIN:g} s which joints it drives')
            question.close()
        self._on_done(refusals, notes)


class _Question:
    """What one listener is asked."""

    def __init__(self, node, name):
        self.name = name
        self._node = node
        try:
            self._client = node.create_client(GetParameters, f'{name}/get_parameters')
        except Exception as error:  # DDS security may forbid it
            self._client = None
            node.get_logger().warning(f'{name} cannot be asked for its joints: {error}')
        self._answers = {}

    def ask(self):
        """Ask, as soon as that is possible."""
        if self._answers or self._client is None or not self._client.service_is_ready():
            return
        # One at a time: rclcpp answers nothing at all if one of several does not exist.
        self._answers = {name: self._client.call_async(GetParameters.Request(names=[name]))
                         for name in ('joints', 'interface_name')}

    @property
    def is_unanswered(self):
        """Whether it has not told its parameters yet."""
        return not self._answers or not all(answer.done() for answer in self._answers.values())

    def refusals(self, joint_names):
        """Return what its parameters say against driving it, as a list of str."""
        reasons = []
        joints = self._value('joints')
        if joints.type == ParameterType.PARAMETER_STRING_ARRAY:
            theirs = list(joints.string_array_value)
            if theirs != joint_names:
                has_same = sorted(theirs) == sorted(joint_names)
                what = 'order of the joints' if has_same else 'number or names of the joints'
                reasons.append(f'{self.name} has another {what}: its parameter joints is '
                               f'[{", ".join(theirs)}], here it is [{", ".join(joint_names)}]; '
                               'make them equal')
        interface = self._value('interface_name')
        if (interface.type == ParameterType.PARAMETER_STRING
                and interface.string_value not in ('', 'effort')):
            reasons.append(f'{self.name} drives {interface.string_value}, expected effort: '
                           'command_topic must be that of an effort controller')
        return reasons

    def _value(self, name):
        answer = self._answers.get(name)
        values = answer.result().values if answer is not None and answer.done() else []
        return values[0] if values else ParameterValue()

    def close(self):
        """Ask no more."""
        if self._client is not None:
            self._node.destroy_client(self._client)
