"""docs/two_robots.md: two simulated arms, two nodes, and nothing of one reaches the other."""

from pathlib import Path
import re

from dynamics_interfaces.msg import OutputState
from dynamics_interfaces.srv import GetGravityTorque
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool
from support.processes import NodeProcess

DOCUMENT = (Path(__file__).parents[2] / 'docs' / 'two_robots.md').read_text()
SIDES = ('left', 'right')


class Arm:
    """A simulated arm and a node, both in a namespace, and what is heard of them."""

    def __init__(self, client, side):
        self.client, self.side = client, side
        self.states = client.listen(JointState, f'/{side}/joint_states')
        self.torques = client.listen(JointState, f'/{side}/dynamics_node/gravity_torque')
        self.commands = client.listen(
            Float64MultiArray, f'/{side}/forward_effort_controller/commands'
        )
        self.outputs = client.listen(OutputState, f'/{side}/dynamics_node/state', latched=True)
        namespace = f'__ns:=/{side}'
        self.simulation = NodeProcess(
            namespace, module='dynamics_node.demo.simulated_robot', rate=100.0
        )
        # A busy machine does not trip it.
        self.node = NodeProcess(namespace, state_timeout=2.0)

    def call(self, kind, name, **request):
        """Call a service of this arm."""
        return self.client.call(kind, f'/{self.side}/{name}', kind.Request(**request))

    def output(self):
        """Return the name of the output's state."""
        return self.outputs[-1].name if self.outputs else ''

    def close(self):
        """Press Ctrl-C in both; return the exit codes."""
        for process in (self.node, self.simulation):
            process.close()
        return [process.process.returncode for process in (self.node, self.simulation)]


@pytest.fixture
def arms(client):
    """Return two arms whose nodes have heard them."""
    started = [Arm(client, side) for side in SIDES]
    client.until(lambda: all(arm.torques and arm.output() for arm in started))
    yield started
    for arm in started:
        arm.close()


def test_enabling_one_robot_does_not_affect_the_other(client, arms):
    left, right = arms
    assert left.torques[-1].name == right.torques[-1].name  # the same names in both
    for arm in arms:
        answer = arm.call(GetGravityTorque, 'dynamics_node/get_gravity_torque')
        assert answer.success, answer.message
    # The left arm is turned, and only the left node knows of it.
    client.until(lambda: left.call(SetBool, 'dynamics_node/enable', data=True).success)
    client.until(lambda: left.output() == 'ACTIVE' and left.commands)
    assert right.output() == 'READY'
    assert client.node.count_publishers('/right/forward_effort_controller/commands') == 1
    assert left.call(SetBool, 'simulated_robot/set_brakes', data=False).success
    held = list(left.states[-1].position)
    commands = len(left.commands)
    client.until(lambda: len(left.commands) > commands + 50)
    assert left.commands[-1].data == pytest.approx(left.torques[-1].effort, abs=1.0)
    assert list(left.states[-1].position) == pytest.approx(held, abs=0.02)
    assert right.commands == [] and right.output() == 'READY'
    for arm in arms:
        assert arm.close() == [0, 0]
    assert right.commands == []
    assert {output.name for output in right.outputs} == {'READY'}


def test_states_of_one_robot_never_reach_the_other(client, arms):
    left, right = arms
    for arm in arms:
        for topic in ('joint_states', 'forward_effort_controller/commands', 'robot_description'):
            assert client.node.count_publishers(f'/{arm.side}/{topic}') == 1
    # What hears each topic is in the same namespace.
    for arm, other in ((left, right), (right, left)):
        ends = client.node.get_subscriptions_info_by_topic(
            f'/{arm.side}/joint_states'
        ) + client.node.get_publishers_info_by_topic(f'/{arm.side}/joint_states')
        spaces = {end.node_namespace for end in ends if end.node_name != 'test_client'}
        assert spaces == {f'/{arm.side}'}
        assert f'/{other.side}' not in spaces
    # The left arm falls; torques of the right one stay to the last bit what they were.
    assert left.call(SetBool, 'simulated_robot/set_brakes', data=False).success
    start, right_torque = list(left.torques[-1].effort), list(right.torques[-1].effort)
    client.until(
        lambda: max(abs(a - b) for a, b in zip(left.torques[-1].effort, start, strict=True)) > 2.0
    )
    heard = len(right.torques)
    client.until(lambda: len(right.torques) > heard + 20)
    assert list(right.torques[-1].effort) == pytest.approx(right_torque, abs=1e-9)


def test_the_document_describes_the_tested_commands():
    said = re.findall(r'`/(left|right)/([a-z_/]+)`', DOCUMENT)
    assert {side for side, _ in said} == set(SIDES)
    names = {name for _, name in said}
    assert names >= {
        'joint_states',
        'robot_description',
        'forward_effort_controller/commands',
        'dynamics_node/gravity_torque',
        'dynamics_node/enable',
    }
    for side in SIDES:
        assert f'ros2 launch dynamics_node demo.launch.py namespace:={side}' in DOCUMENT
        assert f'ros2 run dynamics_node dynamics_node --ros-args -r __ns:=/{side}' in DOCUMENT
