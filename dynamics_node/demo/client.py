"""The ROS node of the demo: service clients, joint states, output state."""

from collections.abc import Callable
import time
from typing import Any

from dynamics_interfaces.msg import OutputState
from dynamics_interfaces.srv import GetMassMatrix
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from .processes import DemoError
from .recording import Recording

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
START_TIMEOUT = 40.0  # [s] imports, compiled kernels and discovery on a slow machine
ANSWER_TIMEOUT = 5.0  # [s]


class Client:
    """Calls the services of both processes and records the joint states."""

    def __init__(self, recording: Recording, check: Callable[[], None]) -> None:
        """Connect; `check` is called while waiting, and raises if a process has ended."""
        self.recording = recording
        self.state: OutputState | None = None
        self._check = check
        self._node = rclpy.create_node('dynamics_demo')
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._node.create_subscription(JointState, 'joint_states', recording.add, 100)
        self._node.create_subscription(OutputState, 'dynamics_node/state', self._on_state, LATCHED)
        services = {
            'simulated_robot/set_brakes': SetBool,
            'simulated_robot/reset': Trigger,
            'simulated_robot/push': Trigger,
            'dynamics_node/enable': SetBool,
            'dynamics_node/get_mass_matrix': GetMassMatrix,
        }
        self._clients = {
            name: self._node.create_client(kind, name) for name, kind in services.items()
        }

    def wait_until_ready(self) -> None:
        """Wait for all services, joint states, and the state READY of the output."""
        for name, client in self._clients.items():
            self.wait_for(client.service_is_ready, START_TIMEOUT, f'the service {name}')
        self.wait_for(lambda: len(self.recording) > 0, START_TIMEOUT, 'joint states')
        self.wait_for_state('READY', START_TIMEOUT)

    def wait_for(self, condition: Callable[[], bool], timeout: float, what: str) -> None:
        """Spin until a condition holds; raise DemoError after `timeout` seconds."""
        end = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > end:
                raise DemoError(f'waited {timeout:.0f} s in vain for {what}')
            self._check()
            self._executor.spin_once(timeout_sec=0.05)

    def wait_for_state(self, name: str, timeout: float) -> None:
        """Wait for a state of the node's output; raise DemoError on FAULT."""

        def reached() -> bool:
            if self.state is not None and self.state.name == 'FAULT' != name:
                raise DemoError(f'the node reports FAULT: {self.state.reason}')
            return self.state is not None and self.state.name == name

        self.wait_for(reached, timeout, f'the node to be {name}')

    def spin_for(self, seconds: float) -> None:
        """Record for a duration [s] on the clock of the stamps."""
        end = self.recording.now + seconds
        self.wait_for(
            lambda: self.recording.now >= end, 3 * seconds + ANSWER_TIMEOUT, 'joint states'
        )

    def call(self, name: str, request: Any) -> Any:
        """Return the response of a service; raise DemoError if it fails or does not come."""
        response = self._call(name, request)
        if not response.success:
            raise DemoError(f'{name} refused: {response.message}')
        return response

    def _call(self, name: str, request: Any) -> Any:
        """Return the response of a service."""
        future = self._clients[name].call_async(request)
        self.wait_for(future.done, ANSWER_TIMEOUT, f'an answer of {name}')
        return future.result()

    def set_brakes(self, engaged: bool) -> None:
        """Engage or release the brakes of the robot."""
        self.call('simulated_robot/set_brakes', SetBool.Request(data=engaged))

    def reset(self) -> None:
        """Send the robot back to its start pose."""
        self.call('simulated_robot/reset', Trigger.Request())

    def push(self) -> str:
        """Push the robot; return the description of the push."""
        return self.call('simulated_robot/push', Trigger.Request()).message

    def enable(self, on: bool) -> None:
        """Turn the node's output on or off."""
        self.call('dynamics_node/enable', SetBool.Request(data=on))

    def mass_matrix(self) -> GetMassMatrix.Response:
        """Return the mass matrix at the current position, as soon as the node can compute it."""
        name, request = 'dynamics_node/get_mass_matrix', GetMassMatrix.Request()
        end = time.monotonic() + START_TIMEOUT
        # Description and joint states reach the node after its services exist.
        while not self._call(name, request).success and time.monotonic() < end:
            self.spin_for(0.1)
        return self.call(name, request)

    def _on_state(self, message: OutputState) -> None:
        """Store the newest state."""
        self.state = message
