"""Joint states from the topic: use, counts and warnings."""

from types import SimpleNamespace

from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.ros.torque_path.joint_state_input import JointStateInput, WARN_EVERY
from dynamics_node.safety import EffortLimiter, OutputSettings, TorquePath
import numpy as np
import pytest
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from support.processes import Client
from support.robots import PENDULUM

LIMITED = (
    PENDULUM.read_text()
    .replace('type="continuous"', 'type="revolute"')
    .replace('<limit ', '<limit lower="-1" upper="1" ')
)


class Receiver:
    """A node with only the input, in this process."""

    def __init__(self, raw, **overrides):
        self.client = Client(
            'receiver',
            parameter_overrides=[
                Parameter(f'qos_overrides./joint_states.subscription.{name}', value=value)
                for name, value in overrides.items()
            ],
        )
        self.robot = ActiveRobot(RobotModel.from_urdf(LIMITED), ())
        # A busy machine may take its time from one process to the other.
        settings = OutputSettings(5.0, 0.0, 0.0, 'ramp_to_zero')
        self.path = TorquePath(settings)
        self.path.use(self.robot.buffer)
        self.path.configure(
            0.0,
            settings,
            self.robot.compensation(check_all({})),
            EffortLimiter(np.ones(1), np.ones(1), np.ones(1), ('hinge',)),
            self.robot.motion_limits(()),
        )
        self.received, self.errors, self.warnings = [], [], []
        node = self.client.node
        node.destroy_publisher(self.client.states)
        self.input = JointStateInput(
            NodeContext(node, {'allow_several_state_publishers': False}),
            SimpleNamespace(path=self.path),
            self,
            raw,
        )
        self.input.logger = SimpleNamespace(
            warning=self.warnings.append, info=lambda _: None, error=self.errors.append
        )

    def on_state(self, stamp):
        """Note a usable state."""
        self.received.append((list(self.robot.buffer.position), stamp))

    def on_internal_error(self, message):
        """Note an error of the callback."""
        self.errors.append(message)

    def spin(self):
        self.client.executor.spin_once(timeout_sec=0.0)

    def publishers(self):
        """Adapt the queue, and return the number of publishers."""
        self.input.adapt_queue()
        return self.input.publishers


@pytest.fixture(params=[{'raw': True}, {'raw': False}], ids=['raw', 'rclpy'])
def receiver(request):
    receiver = Receiver(**request.param)
    yield receiver
    receiver.client.close()


def send(client, *positions):
    for position in positions:
        client.publish(['hinge'], [position])


def until_received(client, receiver, position):
    """Publish until a state was received, then wait until none is in transit."""
    receiver.received.clear()
    client.until(lambda: receiver.received, lambda: (send(client, position), receiver.spin()))
    client.during(0.05, receiver.spin)
    receiver.received.clear()


def until_newest(client, receiver, *positions):
    """Publish at once, and wait until the last one was received."""
    send(client, *positions)
    client.during(0.02)
    newest = [positions[-1]]
    client.until(lambda: receiver.received and receiver.received[-1][0] == newest, receiver.spin)


def test_the_newest_state_wins_and_those_before_it_are_counted(client, receiver):
    until_received(client, receiver, 0.0)
    assert receiver.input.count_publishers() == 1
    until_newest(client, receiver, 0.0)
    before = receiver.input.skipped
    until_newest(client, receiver, *(0.001 * i for i in range(9)))
    assert len(receiver.received) == 2
    assert receiver.input.skipped - before == 8
    until_newest(client, receiver, *(0.001 * i for i in range(9, 12)))
    assert receiver.input.skipped - before == 10


def test_a_position_beyond_its_limits_is_used_with_a_warning(client, receiver):
    until_received(client, receiver, 1.25)
    warning = 'beyond the position limits: hinge at 1.25 (limits -1 to 1)'
    assert receiver.warnings == [warning]
    # An arm that rests there does not fill the log.
    client.during(1.5 * WARN_EVERY, lambda: send(client, 1.25))
    receiver.spin()
    assert receiver.warnings.count(warning) == 1


def test_dropped_states_are_warned_about_once_a_second_per_kind(client, receiver):
    until_received(client, receiver, 0.0)

    def bad():
        client.publish(['hinge'], [])
        client.until(lambda: receiver.robot.buffer.rejected['length'], receiver.spin)
        client.publish(['hinge', 'hinge'], [0.0, 0.0])
        client.until(lambda: receiver.robot.buffer.rejected['name twice'], receiver.spin)

    for _ in range(3):
        bad()
    assert [text.split(':')[0] for text in receiver.warnings] == ['joint state dropped'] * 2
    assert receiver.received == []


def test_an_exception_in_the_callback_is_reported_and_the_next_state_is_used(client, receiver):
    until_received(client, receiver, 0.0)
    receiver.robot.buffer.runaway = lambda: 1 / 0
    client.until(lambda: receiver.errors, lambda: (send(client, 0.0), receiver.spin()))
    assert any(
        'internal error in ' in text and 'division by zero' in text for text in receiver.errors
    )
    del receiver.robot.buffer.runaway
    until_received(client, receiver, 0.0)


def test_a_missing_stamp_is_replaced_by_the_arrival_time(client, receiver):
    until_received(client, receiver, 0.0)
    message = JointState(name=['hinge'], position=[0.0])
    message.header.stamp = client.node.get_clock().now().to_msg()
    client.states.publish(message)
    client.until(lambda: receiver.received, receiver.spin)
    assert receiver.received[-1][1] == message.header.stamp
    message.header.stamp.sec = message.header.stamp.nanosec = 0
    before = client.node.get_clock().now().to_msg()
    client.states.publish(message)
    client.until(lambda: len(receiver.received) == 2, receiver.spin)
    stamp = receiver.received[-1][1]
    assert (stamp.sec, stamp.nanosec) >= (before.sec, before.nanosec)


@pytest.mark.parametrize('receiver', [{'raw': True}], indirect=True)
def test_unreadable_states_do_not_count_as_skipped(client, receiver):
    until_received(client, receiver, 0.0)
    until_newest(client, receiver, 0.0)
    before, rejected = receiver.input.skipped, receiver.robot.buffer.rejected
    client.states.publish(b'\x00\x01\x00\x00no joint state')
    client.until(lambda: rejected['unreadable'] == 1, receiver.spin)
    receiver.received.clear()
    until_newest(client, receiver, 0.0)
    assert receiver.input.skipped == before


def test_two_publishers_share_a_queue_without_replacing_states(client, participant, receiver):
    gripper, heard = participant('gripper'), receiver.robot.buffer

    def gripper_state():
        gripper.publish(['finger'], [0.0])

    # Discovered both, and the new subscription by both.
    client.until(lambda: receiver.publishers() == 2)
    for names, action in ((('hinge',), lambda: send(client, 0.0)), (('finger',), gripper_state)):
        client.until(
            lambda: heard.newest_names == names,  # noqa: B023
            lambda: (action(), receiver.spin()),  # noqa: B023
        )
    client.during(0.05, receiver.spin)
    for i in range(20):
        accepted = heard.accepted
        send(client, 0.001 * i)
        gripper_state(), gripper_state()
        client.until(lambda: heard.accepted == accepted + 3, receiver.spin)  # noqa: B023
        assert heard.position[0] == 0.001 * i
    # It is there only as long as the second one is, and never changed while efforts are sent.
    receiver.input._path = SimpleNamespace(is_on=True)
    gripper.close()
    subscription = receiver.input.subscription
    client.until(lambda: receiver.publishers() == 1)
    assert receiver.input.subscription is subscription
    receiver.input._path = receiver.path
    receiver.input.adapt_queue()
    assert receiver.input.subscription is not subscription
    until_received(client, receiver, 0.0)
    until_newest(client, receiver, *(0.001 * i for i in range(9)))
    assert len(receiver.received) == 1


@pytest.mark.parametrize('receiver', [{'raw': False, 'depth': 3}], indirect=True)
def test_a_depth_of_the_parameters_is_not_changed(client, participant, receiver):
    participant('gripper')
    subscription = receiver.input.subscription
    client.until(lambda: receiver.publishers() == 2)
    assert receiver.input.subscription is subscription
