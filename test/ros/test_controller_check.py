"""Joints and lifecycle of the listeners of the command topic, over DDS."""

from dynamics_node.ros.torque_path.controller_check import Controllers
from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.srv import GetState
import pytest
from rclpy.parameter import Parameter
from std_msgs.msg import Float64MultiArray
from support.processes import Client

JOINTS = ('shoulder', 'elbow')


@pytest.fixture
def listeners():
    """Return a function that starts a listener with parameters."""
    clients = []

    def start(name, start_parameter_services=True, **parameters):
        client = Client(name, start_parameter_services=start_parameter_services)
        for key, value in parameters.items():
            client.node.declare_parameter(key, value)
        client.subscription = client.node.create_subscription(
            Float64MultiArray, 'efforts', lambda _: None, 1
        )
        clients.append(client)
        return client

    yield start
    for client in clients:
        client.close()


def spinning(others):
    """Return an action that lets the others answer."""

    def spin():
        for other in others:
            other.executor.spin_once(timeout_sec=0.0)

    return spin


def watched(client, others, deaf=()):
    """Return controllers that know all listeners, and the answers of `others`."""
    unit = Controllers(client.node, '/efforts')
    names = {f'/{other.node.get_name()}' for other in (*others, *deaf)}
    answering = {f'/{other.node.get_name()}' for other in others}

    def heard():
        unit.update()
        return names == set(unit.listeners) and all(
            unit.listeners[name].has_answered for name in answering
        )

    client.until(heard, spinning(others))
    return unit


def test_without_a_listener_nothing_is_pending(client):
    unit = Controllers(client.node, '/efforts')
    unit.update()
    assert not unit.is_waiting()
    assert not unit.has_listener()
    assert unit.refusals(JOINTS) == unit.notes() == []


@pytest.mark.parametrize(
    'parameters',
    [
        {'joints': list(JOINTS), 'interface_name': 'effort'},
        {'joints': list(JOINTS)},
        {},
        {'joints': 7},
    ],
)
def test_equal_joints_and_listeners_without_joints_pass(client, listeners, parameters):
    unit = watched(client, [listeners('controller', **parameters)])
    assert unit.refusals(JOINTS) == unit.notes() == []
    assert not unit.is_waiting()


def test_other_joints_another_order_and_another_interface_are_refused(client, listeners):
    unit = watched(
        client,
        [
            listeners('other_order', joints=['elbow', 'shoulder']),
            listeners('other_joints', joints=['shoulder']),
            listeners('position_controller', joints=list(JOINTS), interface_name='position'),
        ],
    )
    assert sorted(unit.refusals(JOINTS)) == [
        '/other_joints has another number or names of the joints: its parameter joints is '
        '[shoulder], here it is [shoulder, elbow]; make them equal',
        '/other_order has another order of the joints: its parameter joints is [elbow, '
        'shoulder], here it is [shoulder, elbow]; make them equal',
        '/position_controller drives position, expected effort: command_topic must be that of '
        'an effort controller',
    ]


def test_a_listener_without_an_answer_is_named_and_does_not_hide_the_others(client, listeners):
    deaf = listeners('a_deaf_one', joints=['elbow', 'shoulder'])
    plain = listeners('b_plain_one', start_parameter_services=False)
    other = listeners('z_controller', joints=['elbow', 'shoulder'])
    unit = watched(client, [other], [deaf, plain])
    assert unit.is_waiting()
    assert [note.split(',')[0] for note in sorted(unit.notes())] == ['/a_deaf_one', '/b_plain_one']
    [refusal] = unit.refusals(JOINTS)
    assert refusal.startswith('/z_controller has another order')
    # The requests continue: a late answer counts, too.
    client.until(
        lambda: (unit.update(), len(unit.refusals(JOINTS)) == 2)[1], spinning([deaf, other])
    )


def test_changed_parameters_are_read_again(client, listeners):
    controller = listeners('controller', joints=['elbow', 'shoulder'])
    unit = watched(client, [controller])
    assert unit.refusals(JOINTS)
    controller.node.set_parameters([Parameter('joints', value=list(JOINTS))])
    unit.ask_again()
    client.until(lambda: (unit.update(), not unit.is_waiting())[1], spinning([controller]))
    assert unit.refusals(JOINTS) == []


def test_a_listener_without_a_discovered_name_is_pending(client, monkeypatch):
    class Info:
        node_name, node_namespace = '_NODE_NAME_UNKNOWN_', '_NODE_NAMESPACE_UNKNOWN_'
        endpoint_gid = (1,)

    class Tool:
        node_name, node_namespace, endpoint_gid = '_ros2cli_1234', '/', (2,)

    monkeypatch.setattr(client.node, 'get_subscriptions_info_by_topic', lambda topic: [Info, Tool])
    unit = Controllers(client.node, '/efforts')
    unit.update()
    assert unit.is_waiting()
    assert unit.has_listener()
    assert unit.listeners == {}
    assert unit.notes() == ['a listener there has not been identified yet']


def transition(goal):
    """Return the message that a controller publishes when it goes to a state."""
    return TransitionEvent(goal_state=State(id=goal))


def test_a_controller_that_is_deactivated_is_noticed_by_its_transition_events(client, listeners):
    controller = listeners('controller', joints=list(JOINTS))
    publisher = controller.node.create_publisher(TransitionEvent, '~/transition_event', 10)
    unit = watched(client, [controller])
    spin = spinning([controller])

    def until(goal, condition):
        def publish():
            publisher.publish(transition(goal))
            spin()

        client.until(lambda: (unit.update(), condition(unit.refusals(JOINTS)))[1], publish)

    until(State.PRIMARY_STATE_ACTIVE, lambda refusals: refusals == [])
    until(
        State.TRANSITION_STATE_DEACTIVATING,
        lambda refusals: (
            refusals
            == [
                '/controller is being deactivated: the efforts would not reach the arm; activate '
                'it first, with  ros2 control set_controller_state controller active'
            ]
        ),
    )
    until(State.PRIMARY_STATE_INACTIVE, lambda refusals: 'is inactive' in ''.join(refusals))
    until(State.PRIMARY_STATE_ACTIVE, lambda refusals: refusals == [])


@pytest.mark.parametrize('label, is_refused', [('inactive', True), ('active', False)])
def test_the_lifecycle_is_read_from_the_service_of_the_listener(
    client, listeners, label, is_refused
):
    controller = listeners('controller', joints=list(JOINTS))

    def answer(request, response):
        response.current_state.label = label
        return response

    controller.node.create_service(GetState, '~/get_state', answer)
    unit = watched(client, [controller])
    spin = spinning([controller])
    unit.ask_again()
    client.until(lambda: (unit.update(), not unit.is_waiting())[1], spin)
    client.until(
        lambda: (
            unit.ask_again(),
            unit.update(),
            client.during(0.1, spin),
            unit.update(),
            bool(unit.refusals(JOINTS)) == is_refused,
        )[-1],
        spin,
    )


def test_a_listener_that_leaves_is_removed(client, listeners):
    controller = listeners('controller', joints=['other'])
    unit = watched(client, [controller])
    controller.node.destroy_subscription(controller.subscription)
    client.until(lambda: unit.update() == ['/controller'], spinning([controller]))
    assert unit.listeners == {}
    assert unit.refusals(JOINTS) == []


def test_a_restarted_controller_is_noticed_beside_its_remains(client, listeners):
    controller = listeners('controller', joints=list(JOINTS))
    plot = listeners('plot', start_parameter_services=False)
    unit = watched(client, [controller], [plot])
    unit.update()
    assert unit.renewed == [] and unit.takes_commands()
    # A killed process stays in the graph; here the first one simply continues.
    again = listeners('controller', joints=list(JOINTS))

    def is_renewed():
        unit.update()
        return unit.renewed == ['/controller']

    client.until(is_renewed)
    assert not unit.takes_commands()  # the new one has not received the last commands
    assert unit.is_waiting()  # its own parameters are requested

    def has_answered():
        unit.update()
        assert unit.renewed == []
        return unit.listeners['/controller'].has_answered

    client.until(has_answered, spinning([controller, again]))
    unit.update()
    assert unit.takes_commands()
    # A node without the parameters of a controller may come and go: the arm must not sink for it.
    plot.node.destroy_subscription(plot.subscription)
    plot.subscription = plot.node.create_subscription(
        Float64MultiArray, 'efforts', lambda _: None, 1
    )
    seen = set(unit.listeners['/plot'].endpoints)

    def is_there():
        unit.update()
        assert unit.renewed == []
        return '/plot' in unit.listeners and bool(unit.listeners['/plot'].endpoints - seen)

    client.until(is_there)


def test_another_controller_of_the_same_name_gets_new_requests(client, listeners):
    controller = listeners('controller', joints=list(JOINTS))
    unit = watched(client, [controller])
    controller.node.destroy_subscription(controller.subscription)
    controller.node.set_parameters([Parameter('joints', value=['elbow', 'shoulder'])])
    controller.subscription = controller.node.create_subscription(
        Float64MultiArray, 'efforts', lambda _: None, 1
    )
    gone = []
    client.until(
        lambda: (gone.extend(unit.update()), unit.refusals(JOINTS))[1], spinning([controller])
    )
    assert gone == ['/controller']
