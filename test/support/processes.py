"""The node as a process, and a client over DDS."""

import os
import re
import signal
import subprocess
import sys
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamics_interfaces.msg import OutputState
from dynamics_interfaces.srv import GetGravityTorque
from rcl_interfaces.srv import GetParameters, SetParameters
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import qos_profile_sensor_data, QoSDurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import SetBool

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
# Timeout of all waits, s: a busy machine takes long to start a node.
PATIENCE = 60.0


# Time after which a request is sent again, s.
ANSWER = 8.0


class NodeProcess:
    """The executable `dynamics_node` with given parameters."""

    module = 'dynamics_node.ros.main'

    def __init__(self, *remappings, parameters_file=None, options=(), module=None, **parameters):
        self.expects_traceback = False
        arguments = [
            item for name, value in parameters.items() for item in ('-p', f'{name}:={value}')
        ]
        if parameters_file:
            arguments += ['--params-file', str(parameters_file)]
        self.process = subprocess.Popen(
            [
                sys.executable,
                '-m',
                module or self.module,
                *options,
                '--ros-args',
                *arguments,
                *[item for rule in remappings for item in ('-r', rule)],
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=dict(os.environ),
        )

    def send(self, number):
        """Send a signal."""
        self.process.send_signal(number)

    def wait(self, timeout=PATIENCE):
        """Wait for the end; return the exit code and everything printed."""
        output, _ = self.process.communicate(timeout=timeout)
        return self.process.returncode, output

    def end(self, number=signal.SIGINT, timeout=PATIENCE):
        """Send a signal and wait for the end; return the exit code and everything printed."""
        self.send(number)
        return self.wait(timeout)

    def close(self):
        """End the process if it runs, and check that it has printed no traceback."""
        if self.process.stdout.closed:
            return
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            _, output = self.wait()
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        assert self.expects_traceback or 'Traceback' not in output, output


class MarkersProcess(NodeProcess):
    """The executable `markers` with given parameters."""

    module = 'dynamics_node.visualization.markers'


class Client:
    """Publishes states, calls services and records commands and output states."""

    def __init__(self, name='test_client', **options):
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node(name, context=self.context, **options)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.states = self.node.create_publisher(JointState, 'joint_states', 1)
        self.description = self.node.create_publisher(String, 'robot_description', LATCHED)
        self._clients = {}
        self.commands, self.outputs = [], []

    def record_commands(self, topic='forward_effort_controller/commands'):
        """Record `commands`, (time, list of efforts), and `outputs`."""
        self.node.create_subscription(
            Float64MultiArray,
            topic,
            lambda message: self.commands.append((time.monotonic(), list(message.data))),
            10,
        )
        self.node.create_subscription(
            OutputState, '/dynamics_node/state', self.outputs.append, LATCHED
        )

    def listen(self, kind, topic, latched=False):
        """Return a list that receives all messages of a topic."""
        received = []
        self.node.create_subscription(
            kind, topic, received.append, LATCHED if latched else qos_profile_sensor_data
        )
        return received

    def publish(self, names, position, velocity=(), effort=()):
        """Publish one joint state with the current time."""
        message = JointState(
            name=list(names),
            position=[float(q) for q in position],
            velocity=[float(qd) for qd in velocity],
            effort=[float(tau) for tau in effort],
        )
        message.header.stamp = self.node.get_clock().now().to_msg()
        self.states.publish(message)

    def until(self, condition, action=None, timeout=PATIENCE, period=0.01):
        """Spin until a condition holds, with an `action` every period; return its value."""
        end = time.monotonic() + timeout
        due = time.monotonic()
        while not (result := condition()):
            if time.monotonic() > end:
                last = [f'{output.name} {output.reason}' for output in self.outputs[-3:]]
                raise AssertionError(f'not within {timeout} s: {condition}; output: {last}')
            if action is not None and time.monotonic() >= due:
                action()
                due += period
            self.executor.spin_once(timeout_sec=min(period, 0.005))
        return result

    def during(self, seconds, action=None, period=0.01):
        """Spin for a duration, with an `action` every period."""
        end = time.monotonic() + seconds
        self.until(lambda: time.monotonic() >= end, action, seconds + PATIENCE, period)

    def call(self, kind, name, request=None, action=None, timeout=PATIENCE):
        """Call a service of the node."""
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.until(client.service_is_ready, action, timeout)
        end = time.monotonic() + timeout
        while True:
            future = client.call_async(request or kind.Request())
            try:
                self.until(future.done, action, min(ANSWER, timeout))
            except AssertionError:
                # A service is ready a moment before both ends are matched; a request in that
                # moment is lost. All requests here may be sent twice.
                client.remove_pending_request(future)
                if time.monotonic() > end:
                    raise
                continue
            return future.result()

    def ask(self, kind, action=None, **fields):
        """Call the service of the node named like its type: SetGravity is ~/set_gravity."""
        name = re.sub('(?<=[a-z])(?=[A-Z])', '_', kind.__name__).lower()
        return self.call(kind, f'/dynamics_node/{name}', kind.Request(**fields), action)

    def set_node_parameter(self, name, value, action=None):
        """Set a parameter of the node; return the result."""
        # rclpy takes an empty list for bytes.
        kind = Parameter.Type.DOUBLE_ARRAY if value == [] else None
        message = Parameter(name, kind, value).to_parameter_msg()
        [result] = self.ask(SetParameters, action, parameters=[message]).results
        return result

    def node_parameter(self, name):
        """Return a parameter of the node."""
        value = parameter_value_to_python(self.ask(GetParameters, names=[name]).values[0])
        return value if isinstance(value, (bool, int, float, str)) else list(value)

    def until_heard(self, action):
        """Wait until the node receives the joint states that `action` publishes."""
        # Discovery has two sides: the client may know the subscription of the node before the
        # node knows the client.
        self.until(self.states.get_subscription_count, action)
        self.until(lambda: self.ask(GetGravityTorque, action).success, action)

    def enable(self, value, action=None):
        """Enable or disable the output."""
        return self.call(SetBool, '/dynamics_node/enable', SetBool.Request(data=value), action)

    def activate(self, action):
        """Enable the output, again if states were late, and wait until it is ACTIVE."""
        self.until_heard(action)
        self.until(lambda: self._became_active(action), action)
        self.until(lambda: self.commands, action)

    def _became_active(self, action):
        before = len(self.outputs)
        answer = self.enable(True, action)
        # A busy machine may stop this process for a tenth of a second.
        if not answer.success and 'no joint state within' in answer.message:
            return False
        assert answer.success, answer.message

        def faults():
            return [output.reason for output in self.outputs[before:] if output.name == 'FAULT']

        self.until(lambda: self.output == 'ACTIVE' or faults(), action)
        assert all('joint_states stale' in reason for reason in faults()), faults()
        return self.output == 'ACTIVE'

    @property
    def command(self):
        """Efforts of the newest recorded command; None before the first."""
        return self.commands[-1][1] if self.commands else None

    @property
    def output(self):
        """Name of the newest recorded output state; '' before the first."""
        return self.outputs[-1].name if self.outputs else ''

    @property
    def reason(self):
        """Reason of the newest recorded output state; '' before the first."""
        return self.outputs[-1].reason if self.outputs else ''

    def until_output(self, name, action=None, timeout=PATIENCE):
        """Wait until the output of the node is in a state."""
        self.until(lambda: self.output == name, action, timeout)

    def close(self):
        """Shut ROS down; again without effect."""
        if not self.context.ok():
            return
        nodes = self.executor.get_nodes()  # also those of controllers beside the client
        self.executor.shutdown()
        for node in nodes:
            node.destroy_node()
        rclpy.shutdown(context=self.context)


class Diagnostics:
    """The newest diagnostics of the node, by part: 'joint states', 'output', ..."""

    def __init__(self, client):
        self._received = client.listen(DiagnosticArray, '/diagnostics')

    @property
    def newest(self):
        """All statuses of the newest message."""
        return list(self._received[-1].status) if self._received else []

    @property
    def text(self):
        """The messages of all parts."""
        return '\n'.join(status.message for status in self.newest)

    def status(self, part):
        """Return the status of a part; an empty one before the first."""
        found = [status for status in self.newest if status.name == f'dynamics_node: {part}']
        return found[0] if found else DiagnosticStatus()

    def message(self, part):
        return self.status(part).message

    def values(self, part):
        return {item.key: item.value for item in self.status(part).values}
