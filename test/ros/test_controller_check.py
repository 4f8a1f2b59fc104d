"""What the listeners of the command topic say about their joints, over DDS."""

from dynamics_node.ros.controller_check import ControllerCheck
import pytest
from rclpy.parameter import Parameter
from std_msgs.msg import Float64MultiArray
from support.processes import Client

JOINTS = ('shoulder', 'elbow')


@pytest.fixture
def controllers():
    """Return a function that starts a listener with parameters."""
    clients = []

    def start(name, start_parameter_services=True, **parameters):
        client = Client(name, start_parameter_services=start_parameter_services)
        for key, value in parameters.items():
            client.node.declare_parameter(key, value)
        client.node.create_subscription(Float64MultiArray, 'efforts', lambda _: None, 1)
        clients.append(client)
        return client
    yield start
    for client in clients:
        client.close()


def asked(client, others, deaf=()):
    """Ask the listeners in `others`; return refusals and notes. Those in `deaf` do not spin."""
    check, told = ControllerCheck(client.node, '/efforts'), []
    names = {other.node.get_name() for other in (*others, *deaf)}
    client.until(lambda: names <= {
        info.node_name for info in client.node.get_subscriptions_info_by_topic('/efforts')})
    check.begin(JOINTS, lambda *answer: told.append(answer))

    def spin():
        for other in others:
            other.executor.spin_once(timeout_sec=0.0)
    client.until(lambda: told, spin)
    assert len(told) == 1
    assert not check.is_busy
    return told[0]


def test_nobody_there_is_no_reason_to_wait(client):
    assert asked(client, []) == ([], [])


@pytest.mark.parametrize('parameters', [
    {'joints': list(JOINTS), 'interface_name': 'effort'}, {'joints': list(JOINTS)}, {},
    {'joints': 7}])
def test_the_same_joints_in_the_same_order_and_listeners_without_joints_pass(
        client, controllers, parameters):
    assert asked(client, [controllers('controller', **parameters)]) == ([], [])


def test_other_joints_another_order_and_another_interface_are_refused_in_words(
        client, controllers):
    refusals, notes = asked(client, [
        controllers('other_order', joints=['elbow', 'shoulder']),
        controllers('other_joints', joints=['shoulder']),
        controllers('position_controller', joints=list(JOINTS), interface_name='position')])
    assert notes == []
    assert sorted(refusals) == [
        '/other_joints has another number or names of the joints: its parameter joints is '
        '[shoulder], here it is [shoulder, elbow]; make them equal',
        '/other_order has another order of the joints: its parameter joints is [elbow, '
        'shoulder], here it is [shoulder, elbow]; make them equal',
        '/position_controller drives position, expected effort: command_topic must be that of '
        'an effort controller']


def test_whoever_does_not_answer_is_named_and_does_not_hide_the_others(client, controllers):
    deaf = controllers('a_deaf_one', joints=['elbow', 'shoulder'])
    plain = controllers('b_plain_one', start_parameter_services=False)
    other = controllers('z_controller', joints=['elbow', 'shoulder'])
    refusals, notes = asked(client, [plain, other], [deaf])
    assert notes == [
        f'/{name}, which listens there, did not say within 1 s which joints it drives'
        for name in ('a_deaf_one', 'b_plain_one')]
    [refusal] = refusals
    assert refusal.startswith('/z_controller has another order')


def test_it_can_be_asked_again(client, controllers):
    controller = controllers('controller', joints=['elbow', 'shoulder'])
    assert asked(client, [controller])[0]
    controller.node.set_parameters([Parameter('joints', value=list(JOINTS))])
    assert asked(client, [controller]) == ([], [])
