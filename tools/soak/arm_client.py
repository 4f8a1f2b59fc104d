"""What somebody beside the robot sees and does: states, commands, services of all processes."""

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

REMEMBERED = 20_000  # states and commands: 40 s of each
# Whatever was written so long ago has arrived, s.
SETTLED = 1.0
# Then a service is asked again, s.
ANSWER = 1.0


class ArmClient(Client):
    """
    A client of robot, relay and node.

    Times are those of the writers, in s since the client was made.

    Attributes
    ----------
    truth : deque of (float, bytes)
        What the robot itself says, whatever the relay makes of it: time and message; see
        `state` and `truth_between`.
    commands : deque of (float, list of float)
        Time and efforts.
    outputs : list of OutputState
    output_times : list of float
    diagnostics : dict of dict
        By part ('joint states', ...) and key.
    judge : CommandJudge
    on_command, on_output, on_diagnostics : callable
        Called with the time of every command, with time and name of every state of the output,
        and with all diagnostics.

    """

    def __init__(self, names, limits, rate_limits):
        """
        Connect.

        Parameters
        ----------
        names : list of str
            The driven joints, in the order of the command.
        limits, rate_limits : sequence of float
            See `CommandJudge`.

        """
        super().__init__()
        # The simulated robot is the one that publishes these.
        self.node.destroy_publisher(self.states)
        self.node.destroy_publisher(self.description)
        self.epoch = time.time_ns()
        self.judge = CommandJudge(limits, rate_limits)
        self.truth, self.commands = deque(maxlen=REMEMBERED), deque(maxlen=REMEMBERED)
        self.output_times, self.diagnostics, self.diagnostics_received = [], {}, 0
        self.on_command = self.on_output = self.on_diagnostics = lambda *news: None
        self._names, self._rows = names, None
        many = QoSProfile(depth=1000)
        # As bytes: only few of them are ever looked into.
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
        """Call a service; again if there is no answer: whoever has just died takes requests."""
        end = time.monotonic() + timeout
        while True:
            try:
                return super().call(kind, name, request, action, ANSWER)
            except AssertionError:
                if time.monotonic() > end:
                    raise

    def time_of(self, nanoseconds):
        """Return a time on the system's clock, ns, as one of this client, s."""
        return (nanoseconds - self.epoch) * 1e-9

    @property
    def now(self):
        """Now, s."""
        return self.time_of(time.time_ns())

    @property
    def output(self):
        """The newest state of the output, a word; '' before there is one."""
        return self.outputs[-1].name if self.outputs else ''

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
        """Judge what has certainly arrived, or everything that is there."""
        self.judge.settle(*([] if everything else [self.now - SETTLED]))

    def forget_node(self):
        """Expect another node instead of the one that has ended."""
        self.settle(everything=True)
        self.judge.forget()
        self.outputs.clear()
        self.output_times.clear()

    def truth_between(self, begin, end):
        """
        Return what the robot itself said within a time, s, and just before.

        Waits until it has said all of it.

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
        """Change what is wrong with the line."""
        self.set_parameter(
            'relay',
            'fault',
            ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=fault),
        )

    def set_clock_offset(self, seconds):
        """Let the relay publish /clock and move all stamps; NaN: no longer."""
        self.set_parameter(
            'relay',
            'clock_offset',
            ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=seconds),
        )

    def set_state_timeout(self, seconds):
        """Change how old a joint state may be for the node."""
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
        """Engage or release the brakes of the robot; tell whether it did."""
        return self.call(
            SetBool, '/simulated_robot/set_brakes', SetBool.Request(data=engaged)
        ).success

    def reset(self):
        """Send the robot to its start pose; tell whether it set out."""
        return self.call(Trigger, '/simulated_robot/reset').success

    def sent(self):
        """Return how many joint states the relay has published."""
        return int(self.call(Trigger, '/relay/sent').message)

    def number(self, part, key):
        """Return a number of the newest diagnostics, 0 if it is not there."""
        return float(self.diagnostics.get(part, {}).get(key, 0))

    def until_diagnosed(self):
        """Wait for diagnostics that were made after this call."""
        # Those on their way now may be older: the second from now is not.
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
