"""The demo's side of ROS: one node, ONE executor that is kept, the services and the state."""

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
START_UP = 40.0  # [s] imports, compilation of the kernels and discovery on a slow machine
ANSWER = 5.0  # [s]


class Client:
    """Calls the services of both processes and records the joint states."""

    def __init__(self, recording: Recording, check: Callable[[], None]) -> None:
        """Connect; `check` is called while waiting and raises when a process has ended."""
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
        """Wait until all endpoints are there and the node has said what its output does."""
        for name, client in self._clients.items():
            self.wait_for(client.service_is_ready, START_UP, f'the service {name}')
        self.wait_for(lambda: len(self.recording) > 0, START_UP, 'joint states')
        self.wait_for_state('READY', START_UP)

    def wait_for(self, condition: Callable[[], bool], timeout: float, what: str) -> None:
        """Spin until a condition holds, or raise DemoError after `timeout` seconds."""
        end = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > end:
                raise DemoError(f'waited {timeout:.0f} s in vain for {what}')
            self._check()
            self._executor.spin_once(timeout_sec=0.05)

    def wait_for_state(self, name: str, timeout: float) -> None:
        """Wait for a state of the node's output; FAULT ends the waiting."""

        def reached() -> bool:
            if self.state is not None and self.state.name == 'FAULT' != name:
                raise DemoError(f'the node reports FAULT: {self.state.reason}')
            return self.state is not None and self.state.name == name

        self.wait_for(reached, timeout, f'the node to be {name}')

    def spin_for(self, seconds: float) -> None:
        """Record for a time on the clock of the stamps."""
        end = self.recording.now + seconds
        self.wait_for(lambda: self.recording.now >= end, 3 * seconds + ANSWER, 'joint states')

    def call(self, name: str, request: Any) -> Any:
        """Return the answer of a service, or raise DemoError if there is none or a refusal."""
        answer = self._ask(name, request)
        if not answer.success:
            raise DemoError(f'{name} refused: {answer.message}')
        return answer

    def _ask(self, name: str, request: Any) -> Any:
        """Return the answer of a service, whatever it says."""
        future = self._clients[name].call_async(request)
        self.wait_for(future.done, ANSWER, f'an answer of {name}')
        return future.result()

    def set_brakes(self, engaged: bool) -> None:
        """Engage or release the brakes of the robot."""
        self.call('simulated_robot/set_brakes', SetBool.Request(data=engaged))

    def reset(self) -> None:
        """Send the robot back to its start pose."""
        self.call('simulated_robot/reset', Trigger.Request())

    def push(self) -> str:
        """Push the robot; return with what."""
        return self.call('simulated_robot/push', Trigger.Request()).message

    def enable(self, on: bool) -> None:
        """Turn the node's output on or off."""
        self.call('dynamics_node/enable', SetBool.Request(data=on))

    def mass_matrix(self) -> GetMassMatrix.Response:
        """Return the mass matrix at the present position, as soon as the node can tell it."""
        name, request = 'dynamics_node/get_mass_matrix', GetMassMatrix.Request()
        end = time.monotonic() + START_UP
        # Description and joint states reach the node some time after its services are there.
        while not self._ask(name, request).success and time.monotonic() < end:
            self.spin_for(0.1)
        return self.call(name, request)

    def _on_state(self, message: OutputState) -> None:
        """Remember the newest state."""
        self.state = message
