"""An effort controller and its hardware, in the test's own process."""

import time

from lifecycle_msgs.msg import State, TransitionEvent
import rclpy
from std_msgs.msg import Float64MultiArray


class Controller:
    """
    A ForwardCommandController and its hardware.

    Active, it passes commands on to the hardware. Deactivated, it keeps its subscription and
    the hardware keeps the last effort.

    Attributes
    ----------
    received : list of (float, list of float)
        Time and efforts of all commands.
    hardware : list of list of float
        Efforts passed on.

    """

    def __init__(self, client, name='forward_effort_controller', topic='', **parameters):
        self.node = rclpy.create_node(name, context=client.context)
        for key, value in parameters.items():
            self.node.declare_parameter(key, value)
        self.events = self.node.create_publisher(TransitionEvent, '~/transition_event', 10)
        self.is_active, self.received, self.hardware = True, [], []
        self.node.create_subscription(
            Float64MultiArray, topic or f'{name}/commands', self._command, 1000
        )
        self._client = client
        client.executor.add_node(self.node)

    def _command(self, message):
        self.received.append((time.monotonic(), list(message.data)))
        if self.is_active:
            self.hardware.append(list(message.data))

    def deactivate(self):
        self._go(State.TRANSITION_STATE_DEACTIVATING, State.PRIMARY_STATE_INACTIVE)

    def activate(self):
        self._go(State.TRANSITION_STATE_ACTIVATING, State.PRIMARY_STATE_ACTIVE)

    def _go(self, *goals):
        self.is_active = goals[-1] == State.PRIMARY_STATE_ACTIVE
        for goal in goals:
            self.events.publish(TransitionEvent(goal_state=State(id=goal)))

    def close(self):
        """Leave the graph; again without effect."""
        if self.node in self._client.executor.get_nodes():
            self._client.executor.remove_node(self.node)
            self.node.destroy_node()
