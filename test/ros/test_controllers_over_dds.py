"""Controllers that come, go and are deactivated, as ros2_control's do it, over DDS."""

from dynamics_interfaces.msg import OutputState
from lifecycle_msgs.msg import State, TransitionEvent
import numpy as np
import pytest
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from support.robots import PENDULUM

TOPIC = 'forward_effort_controller/commands'
HOLD = 0.5 * 3 * 0.7 * 9.81  # the pendulum's gravity torque at 0, N m


class Controller:
    """
    A ForwardCommandController and its hardware, in the test's own process.

    Active, it passes commands on to the hardware. Deactivated, it keeps its subscription and
    the hardware keeps the last effort.

    """

    def __init__(self, client, joints=('hinge',)):
        self.node = Node('forward_effort_controller', context=client.context)
        self.node.declare_parameter('joints', list(joints))
        self.node.declare_parameter('interface_name', 'effort')
        self.events = self.node.create_publisher(TransitionEvent, '~/transition_event', 10)
        self.client = client
        self.is_active, self.hardware = True, [0.0]
        self.subscription = self.node.create_subscription(
            Float64MultiArray, TOPIC, self._command, 1
        )
        client.executor.add_node(self.node)

    def _command(self, message):
        if self.is_active:
            self.hardware.append(message.data[0])

    def go(self, *goals):
        """Publish transitions; the last goal decides."""
        self.is_active = goals[-1] == State.PRIMARY_STATE_ACTIVE
        for goal in goals:
            self.events.publish(TransitionEvent(goal_state=State(id=goal)))

    def deactivate(self):
        self.go(State.TRANSITION_STATE_DEACTIVATING, State.PRIMARY_STATE_INACTIVE)

    def activate(self):
        self.go(State.TRANSITION_STATE_ACTIVATING, State.PRIMARY_STATE_ACTIVE)

    def publish(self):
        """Publish the joint state, with the effort of the hardware."""
        self.client.publish(['hinge'], [0.0], [0.0], [self.hardware[-1]])

    def close(self):
        self.client.executor.remove_node(self.node)
        self.node.destroy_node()


@pytest.fixture
def controller(client):
    controller = Controller(client)
    yield controller
    controller.close()


def listening(client, controller):
    """Wait until the node follows the controller's lifecycle."""
    client.until(lambda: controller.events.get_subscription_count() > 0, controller.publish)


def enable(client, action):
    """Enable the output and wait for ACTIVE."""
    answers = []
    client.until(
        lambda: answers.append(client.enable(True, action)) or answers[-1].success, action
    )
    client.until(client.output_is('ACTIVE'), action)
    return answers[-1].message


def test_a_deactivated_controller_ends_the_output_and_the_next_start_begins_there(
    client, start, controller
):
    start(robot_description_file=PENDULUM, state_timeout=1.0)
    client.record_commands()
    client.until_heard(controller.publish)
    enable(client, controller.publish)
    listening(client, controller)
    client.until(lambda: controller.hardware[-1] == pytest.approx(HOLD), controller.publish)
    controller.deactivate()
    client.until(client.output_is('FAULT'), controller.publish)
    reason = client.outputs[-1].reason
    assert '/forward_effort_controller is' in reason
    assert 'the hardware may hold: hinge: 10.3005' in reason
    # No command any more, and no word that nothing is in force. They are two topics: the last
    # command may be heard a moment after the state.
    client.during(0.3, controller.publish)
    client.commands.clear()
    client.during(0.5, controller.publish)
    assert client.commands == []
    answer = client.enable(False, controller.publish)
    assert not answer.success
    assert 'may be in force at the hardware (hinge: 10.3005)' in answer.message
    # An inactive controller is refused.
    answer = client.enable(True, controller.publish)
    assert not answer.success
    assert 'activate it first' in answer.message
    # Active again: the ramp begins at what the hardware holds, without a step.
    controller.activate()
    begin = len(controller.hardware)
    enable(client, controller.publish)
    client.during(0.3, controller.publish)
    efforts = np.array(controller.hardware[begin - 1 :])
    assert np.abs(np.diff(efforts)).max() < 0.05 * HOLD
    assert efforts[-1] == pytest.approx(HOLD)
    client.enable(False, controller.publish)
    client.until(client.output_is('READY'), controller.publish)


def test_a_late_controller_gets_the_ramp_or_stops_the_output(client, start):
    start(robot_description_file=PENDULUM, state_timeout=1.0)
    outputs = client.outputs
    client.node.create_subscription(OutputState, '/dynamics_node/state', outputs.append, 10)

    def publish():
        client.publish(['hinge'], [0.0], [0.0])

    client.until_heard(publish)
    assert 'nothing listens there' in enable(client, publish)
    controller = Controller(client)
    try:
        client.until(
            lambda: any('has begun to listen' in output.reason for output in outputs), publish
        )
        client.until(client.output_is('ACTIVE'), publish)
        # The first command may have come before it was found; from then on, the ramp.
        efforts = np.array(controller.hardware)
        begin = int(np.argmin(efforts[1:])) + 1
        assert efforts[begin] < 0.2 * HOLD
        assert np.diff(efforts[begin:]).max() < 0.2 * HOLD
    finally:
        controller.close()
    wrong = Controller(client, ('other',))
    try:
        client.until(client.output_is('FAULT'), publish)
    finally:
        wrong.close()


def test_an_arm_and_a_gripper_state_publisher_are_named(client, start, controller):
    start(robot_description_file=PENDULUM, state_timeout=1.0)
    gripper = client.node.create_publisher(JointState, 'joint_states', 1)
    client.until_heard(controller.publish)
    client.until(gripper.get_subscription_count, controller.publish)
    client.until(
        lambda: (
            'allow_several_state_publishers' in client.enable(True, controller.publish).message
        ),
        controller.publish,
    )
