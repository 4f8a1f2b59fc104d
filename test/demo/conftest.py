"""The simulated robot as a process, and its ROS client."""

import os
from pathlib import Path
import signal
import subprocess
import sys
import time

import dynamics_node
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import SetBool, Trigger
from support.ros_domain import claim

ARM7 = Path(__file__).resolve().parents[2] / 'config' / 'robots' / 'arm7.urdf'
SERVICES = {'set_brakes': SetBool, 'reset': Trigger, 'push': Trigger}
# Timeout of all waits [s]: on a busy machine a process may take long to start.
PATIENCE = 60.0


def environment():
    """Return the environment of a child process: a domain of its own, this very package."""
    package = str(Path(dynamics_node.__file__).resolve().parents[1])
    path = os.pathsep.join([package, *filter(None, [os.environ.get('PYTHONPATH')])])
    return {
        **os.environ,
        'PYTHONPATH': path,
        'ROS_DOMAIN_ID': str(claim()),
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
    }


def run_robot(env, arguments):
    """Start the simulated robot with a command line; return the process."""
    return subprocess.Popen(
        [sys.executable, '-m', 'dynamics_node.demo.simulated_robot', *arguments],
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


class Robot:
    """A running simulated robot and what ROS sees of it."""

    def __init__(self, *parameters):
        """Start the process with parameters `name:=value` and wait until all is connected."""
        env = environment()
        flags = [word for parameter in parameters for word in ('-p', parameter)]
        self.process = run_robot(env, ['--ros-args', *flags] if flags else [])
        self.context = Context()
        os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = env['ROS_AUTOMATIC_DISCOVERY_RANGE']
        rclpy.init(context=self.context, domain_id=int(env['ROS_DOMAIN_ID']))
        self.node = rclpy.create_node('test_client', context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.states, self.description = [], None
        try:
            self._connect()
        except BaseException:
            self._leave()  # otherwise the next robot in this domain would receive its messages
            raise

    def _connect(self):
        """Create the endpoints and wait for those of the robot."""
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.node.create_subscription(JointState, 'joint_states', self.states.append, 100)
        self.node.create_subscription(String, 'robot_description', self._on_description, latched)
        self.commands = self.node.create_publisher(
            Float64MultiArray, 'forward_effort_controller/commands', 1
        )
        self.services = {
            name: self.node.create_client(kind, f'simulated_robot/{name}')
            for name, kind in SERVICES.items()
        }
        self.wait_for(lambda: self.states and self.commands.get_subscription_count())
        self.wait_for(lambda: all(s.service_is_ready() for s in self.services.values()))

    def _on_description(self, message):
        """Remember the robot description."""
        self.description = message.data

    def wait_for(self, condition, timeout=PATIENCE):
        """Spin until a condition holds, and return its value."""
        end = time.monotonic() + timeout
        while not (value := condition()):
            assert time.monotonic() < end, 'waited in vain'
            assert self.process.poll() is None, self.process.stdout.read()
            self.executor.spin_once(timeout_sec=0.05)
        return value

    def spin_for(self, seconds):
        """Collect joint states for a time on the clock of their stamps; return those."""
        first, start = len(self.states), self.now
        self.wait_for(lambda: self.now - start >= seconds)
        return self.states[first:]

    @property
    def now(self):
        """Return the stamp of the newest state [s]."""
        return stamp(self.states[-1])

    def position(self, name):
        """Return the newest position of a joint [rad or m]."""
        return self.states[-1].position[self.states[-1].name.index(name)]

    def positions(self):
        """Return the newest positions by name."""
        return dict(zip(self.states[-1].name, self.states[-1].position))

    def efforts(self):
        """Return the newest efforts by name."""
        return dict(zip(self.states[-1].name, self.states[-1].effort))

    def call(self, name, **request):
        """Return the answer of a service of the robot."""
        future = self.services[name].call_async(SERVICES[name].Request(**request))
        self.wait_for(future.done)
        self.spin_for(0.01)  # so that the newest state is one after the answer
        return future.result()

    def command(self, values):
        """Publish a command once."""
        self.commands.publish(Float64MultiArray(data=values))

    def rest_at_start(self):
        """Bring the robot back to its start pose, on its brakes, without efforts."""
        assert self.call('reset').success
        self.wait_for(lambda: self.call('set_brakes', data=True).success)
        # States of the last test may still be in the queue of a machine that is busy.
        rests = self.node.get_clock().now().nanoseconds * 1e-9
        self.wait_for(lambda: self.now > rests)

    def close(self):
        """Press Ctrl-C; return the exit code and what the process has printed."""
        self.process.send_signal(signal.SIGINT)
        try:
            output, _ = self.process.communicate(timeout=PATIENCE)
        finally:
            self._leave()
        return self.process.returncode, output

    def _leave(self):
        """End the process for certain, and leave ROS."""
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()


def stamp(state):
    """Return the stamp of a message in s."""
    return state.header.stamp.sec + state.header.stamp.nanosec * 1e-9


@pytest.fixture(scope='module')
def shared_robot():
    """Return an arm7 that the tests of one file share."""
    robot = Robot()
    yield robot
    if robot.process.poll() is None:
        robot.close()


@pytest.fixture
def robot(shared_robot):
    """Return the shared arm7 at its start pose, on its brakes, without efforts."""
    shared_robot.rest_at_start()
    return shared_robot


@pytest.fixture
def start_robot():
    """Return a function that starts a simulated robot of its own with parameters."""
    robots = []

    def start(*parameters):
        robots.append(Robot(*parameters))
        return robots[-1]

    yield start
    for robot in robots:
        if robot.process.poll() is None:
            robot.close()


@pytest.fixture
def refusals():
    """Return a function: command lines of robots that must not start, to the line each prints."""

    def run(*command_lines):
        env = {
            name: value
            for name, value in environment().items()
            if name not in ('DISPLAY', 'WAYLAND_DISPLAY')
        }
        return [only_line(process) for process in [run_robot(env, line) for line in command_lines]]

    return run


def only_line(process):
    """Return the one line, beside log lines, of a process that ends with exit code 1."""
    try:
        output, _ = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    lines = [line for line in output.splitlines() if not line.startswith('[')]
    assert process.returncode == 1 and len(lines) == 1, output
    return lines[0]


@pytest.fixture
def child_environment():
    """Return the environment for a child process: a domain of its own, this very package."""
    return environment()


@pytest.fixture(scope='session')
def arm7_text():
    """Return the text of arm7.urdf."""
    return ARM7.read_text(encoding='utf-8')
