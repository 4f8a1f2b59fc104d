"""`ArmClient`: states, commands and services of robot, relay and node."""

import bisect
from collections import deque
import itertools
import time

from diagnostic_msgs.msg import DiagnosticArray
from dynamics_interfaces.msg import OutputState
import numpy as np
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger
from support.processes import Client, LATCHED, PATIENCE

from .command_judge import CommandJudge
from .faulty_link import stamp_of

HISTORY = 20_000  # states and commands: 40 s of each
# Messages written earlier than this have arrived, s.
MAX_TRANSPORT = 1.0
# Time after which a service is called again, s.
RETRY_AFTER = 1.0


class ArmClient(Client):
    """
    A client of robot, relay and node.

    Times are source timestamps, in s since the client was created.

    Attributes
    ----------
    truth : deque of (float, bytes)
        Joint states of the robot before the relay, serialized; see `state` and
        `truth_between`.
    commands : deque of (float, list of float)
        Time and efforts.
    outputs : list of OutputState
    output_times : list of float
    diagnostics : dict of dict
        By part ('joint states', ...) and key.
    judge : CommandJudge
    on_command, on_output, on_diagnostics : callable
        Called with the time of each command, with time and name of each output state, and with
        the diagnostics.

    """

    def __init__(self, names, limits, rate_limits):
        """
        Connect.

        Parameters
        ----------
        names : list of str
            Driven joints in the order of the command.
        limits, rate_limits : sequence of float
            See `CommandJudge`.

        """
        super().__init__()
        # The simulated robot publishes these.
        self.node.destroy_publisher(self.states)
        self.node.destroy_publisher(self.description)
        self.epoch = time.time_ns()
        self.judge = CommandJudge(limits, rate_limits)
        self.truth, self.commands = deque(maxlen=HISTORY), deque(maxlen=HISTORY)
        self.output_times, self.diagnostics, self.diagnostics_received = [], {}, 0
        self.on_command = self.on_output = self.on_diagnostics = lambda *news: None
        self._names, self._rows = names, None
        many = QoSProfile(depth=1000)
        # Serialized: few of them are read.
        self.node.create_subscription(
            JointState, 'robot/joint_states', self._on_truth, many, raw=True
        )
        self.node.create_subscription(
            Float64MultiArray, 'forward_effort_controller/commands', self._on_command, many
        )
        self.node.create_subscription(
            OutputState,
            'dynamics_node/state',
            self._on_output,
            QoSProfile(depth=100, durability=LATCHED.durability),
        )
        self.node.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics, many)

    def call(self, kind, name, request=None, action=None, timeout=PATIENCE):
        """Call a service, repeatedly: a process that has just died still receives requests."""
        end = time.monotonic() + timeout
        while True:
            try:
                return super().call(kind, name, request, action, RETRY_AFTER)
            except AssertionError:
                if time.monotonic() > end:
                    raise

    def time_of(self, nanoseconds):
        """Convert a time of the system clock, ns, to one of this client, s."""
        return (nanoseconds - self.epoch) * 1e-9

    @property
    def now(self):
        """The current time, s."""
        return self.time_of(time.time_ns())

    @property
    def state(self):
        """Newest position, velocity and effort of the driven joints; shape (n,) each."""
        return self._read(self.truth[-1][1])

    @property
    def is_held(self):
        """Whether the effort of the arm is that of the newest command."""
        return bool(self.commands) and np.allclose(
            self.state[2], self.commands[-1][1], rtol=1e-3, atol=1e-3
        )

    @property
    def speed(self):
        """Largest newest speed of any joint, rad/s or m/s."""
        return np.abs(self.state[1]).max()

    def settle(self, everything=False):
        """Judge all commands that have certainly arrived, or all received ones."""
        self.judge.settle(*([] if everything else [self.now - MAX_TRANSPORT]))

    def forget_node(self):
        """Expect a new node in place of the one that has ended."""
        self.settle(everything=True)
        self.judge.forget()
        self.outputs.clear()
        self.output_times.clear()

    def truth_between(self, begin, end):
        """
        Return the robot's states in an interval, s, and the one before it.

        Waits until all of them have arrived.

        Returns
        -------
        time, position, velocity, effort : numpy.ndarray, shape (k,) and three times (k, n)
            s; rad or m, per s, and N m or N, of the driven joints.

        """
        self.until(lambda: self.truth[-1][0] >= end)
        times = [time for time, _ in self.truth]
        first = max(bisect.bisect(times, begin) - 1, 0)
        chosen = [
            (time, *self._read(data))
            for time, data in itertools.islice(self.truth, first, bisect.bisect(times, end))
        ]
        return tuple(np.array(column) for column in zip(*chosen))

    def set_fault(self, fault):
        """Set the fault of the link."""
        self.set_parameter(
            'relay',
            'fault',
            ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=fault),
        )

    def set_clock_offset(self, seconds):
        """Let the relay publish /clock and shift all stamps; NaN ends it."""
        self.set_parameter(
            'relay',
            'clock_offset',
            ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=seconds),
        )

    def set_state_timeout(self, seconds):
        """Set the node's parameter state_timeout."""
        self.set_parameter(
            'dynamics_node',
            'state_timeout',
            ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=seconds),
        )

    def set_parameter(self, node, name, value):
        """Set a parameter of any node."""
        [result] = self.call(
            SetParameters,
            f'/{node}/set_parameters',
            SetParameters.Request(parameters=[Parameter(name=name, value=value)]),
        ).results
        assert result.successful, result.reason

    def set_brakes(self, engaged):
        """Engage or release the brakes of the robot; return success."""
        return self.call(
            SetBool, '/simulated_robot/set_brakes', SetBool.Request(data=engaged)
        ).success

    def reset(self):
        """Move the robot to its start pose; return success."""
        return self.call(Trigger, '/simulated_robot/reset').success

    def sent(self):
        """Return the number of joint states that the relay has published."""
        return int(self.call(Trigger, '/relay/sent').message)

    def number(self, part, key):
        """Return a number of the newest diagnostics; 0 if it is missing."""
        return float(self.diagnostics.get(part, {}).get(key, 0))

    def until_diagnosed(self):
        """Wait for diagnostics created after this call."""
        # The next message may be older than this call; the second one is not.
        first = self.diagnostics_received
        self.until(lambda: self.diagnostics_received >= first + 2)

    def _on_truth(self, data):
        self.truth.append((self.time_of(stamp_of(data)), data))

    def _read(self, data):
        message = deserialize_message(data, JointState)
        if self._rows is None:
            self._rows = [message.name.index(name) for name in self._names]
        return tuple(
            np.array(field)[self._rows]
            for field in (message.position, message.velocity, message.effort)
        )

    def _on_command(self, message, info):
        written, values = self.time_of(info['source_timestamp']), message.data.tolist()
        self.commands.append((written, values))
        self.judge.command(written, values, info['publication_sequence_number'])
        self.on_command(written)

    def _on_output(self, message, info):
        written = self.time_of(info['source_timestamp'])
        self.judge.state(written, message.name)
        self.outputs.append(message)
        self.output_times.append(written)
        self.on_output(written, message.name)

    def _on_diagnostics(self, message):
        self.diagnostics_received += 1
        self.diagnostics = {
            status.name.split(': ', 1)[1]: {item.key: item.value for item in status.values}
            for status in message.status
            if status.name.startswith('dynamics_')
        }
        self.on_diagnostics(self.diagnostics)
