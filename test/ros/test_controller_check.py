"""Controllers on the command topic, over DDS: joints, lifecycle, and the output for them."""

from dynamics_interfaces.msg import OutputState
from dynamics_node.ros.torque_path.controller_check import Controllers
from lifecycle_msgs.msg import State, TransitionEvent
from lifecycle_msgs.srv import GetState
import numpy as np
import pytest
from rclpy.parameter import Parameter
from std_msgs.msg import Float64MultiArray
from support.processes import ANSWER
from support.robots import HOLD, PENDULUM

JOINTS = ('shoulder', 'elbow')


@pytest.fixture
def listeners(participant):
    """Return a function that starts a listener with parameters."""

    def start(name, start_parameter_services=True, **parameters):
        client = participant(name, start_parameter_services=start_parameter_services)
        for key, value in parameters.items():
            client.node.declare_parameter(key, value)
        listen(client)
        return client

    return start


def listen(client):
    client.subscription = client.node.create_subscription(
        Float64MultiArray, 'efforts', lambda _: None, 1
    )


class Watched:
    """The controllers of a client, updated while the others answer."""

    def __init__(self, client, others, deaf=()):
        self.client, self.others = client, others
        self.unit = Controllers(client.node, '/efforts')
        names, answering = (
            {f'/{other.node.get_name()}' for other in group}
            for group in ((*others, *deaf), others)
        )
        self.until(lambda: names == set(self.unit.listeners))

        def have_answered():
            return all(self.unit.listeners[name].has_answered for name in answering)

        try:
            self.until(have_answered, timeout=ANSWER)
        except AssertionError:  # a request in the moment before both ends are matched is lost
            self.unit.ask_again()
            self.until(have_answered)

    def spin(self):
        for other in self.others:
            other.executor.spin_once(timeout_sec=0.0)

    def until(self, condition, action=lambda: None, **options):
        """Update until a condition holds; return its value."""
        return self.client.until(
            lambda: (self.unit.update(), condition())[1],
            lambda: (action(), self.spin()),
            **options,
        )


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
    unit = Watched(client, [listeners('controller', **parameters)]).unit
    assert unit.refusals(JOINTS) == unit.notes() == []
    assert not unit.is_waiting()


def test_other_joints_another_order_and_another_interface_are_refused(client, listeners):
    unit = Watched(
        client,
        [
            listeners('other_order', joints=['elbow', 'shoulder']),
            listeners('other_joints', joints=['shoulder']),
            listeners('position_controller', joints=list(JOINTS), interface_name='position'),
        ],
    ).unit
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
    watched = Watched(client, [other], [deaf, plain])
    unit = watched.unit
    assert unit.is_waiting()
    assert [note.split(',')[0] for note in sorted(unit.notes())] == ['/a_deaf_one', '/b_plain_one']
    [refusal] = unit.refusals(JOINTS)
    assert refusal.startswith('/z_controller has another order')
    # The requests continue: a late answer counts, too.
    watched.others.append(deaf)
    watched.until(lambda: len(unit.refusals(JOINTS)) == 2)


def test_changed_parameters_are_read_again(client, listeners):
    controller = listeners('controller', joints=['elbow', 'shoulder'])
    watched = Watched(client, [controller])
    unit = watched.unit
    assert unit.refusals(JOINTS)
    controller.node.set_parameters([Parameter('joints', value=list(JOINTS))])
    unit.ask_again()
    watched.until(lambda: not unit.is_waiting())
    assert unit.refusals(JOINTS) == []
    # Another controller of the same name gets new requests.
    controller.node.destroy_subscription(controller.subscription)
    controller.node.set_parameters([Parameter('joints', value=['elbow', 'shoulder'])])
    listen(controller)
    gone = []
    client.until(lambda: (gone.extend(unit.update()), unit.refusals(JOINTS))[1], watched.spin)
    assert gone == ['/controller']
    # One that leaves is removed.
    controller.node.destroy_subscription(controller.subscription)
    client.until(lambda: unit.update() == ['/controller'], watched.spin)
    assert unit.listeners == {}
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


def test_a_controller_that_is_deactivated_is_noticed_by_its_transition_events(client, listeners):
    controller = listeners('controller', joints=list(JOINTS))
    publisher = controller.node.create_publisher(TransitionEvent, '~/transition_event', 10)
    watched = Watched(client, [controller])
    for goal, expected in (
        (State.PRIMARY_STATE_ACTIVE, ''),
        (
            State.TRANSITION_STATE_DEACTIVATING,
            '/controller is being deactivated: the efforts would not reach the arm; activate '
            'it first, with  ros2 control set_controller_state controller active',
        ),
        (State.PRIMARY_STATE_INACTIVE, '/controller is inactive'),
        (State.PRIMARY_STATE_ACTIVE, ''),
    ):
        event = TransitionEvent(goal_state=State(id=goal))

        def is_expected(expected=expected):
            refusals = watched.unit.refusals(JOINTS)
            return expected in ''.join(refusals) if expected else refusals == []

        watched.until(is_expected, lambda event=event: publisher.publish(event))


@pytest.mark.parametrize('label, is_refused', [('inactive', True), ('active', False)])
def test_the_lifecycle_is_read_from_the_service_of_the_listener(
    client, listeners, label, is_refused
):
    controller = listeners('controller', joints=list(JOINTS))

    def answer(request, response):
        response.current_state.label = label
        return response

    controller.node.create_service(GetState, '~/get_state', answer)
    watched = Watched(client, [controller])
    unit = watched.unit

    def has_answered():
        unit.ask_again()
        unit.update()
        client.during(0.1, watched.spin)
        unit.update()
        return not unit.is_waiting() and bool(unit.refusals(JOINTS)) == is_refused

    client.until(has_answered, watched.spin)


def test_a_restarted_controller_is_noticed_beside_its_remains(client, listeners):
    controller = listeners('controller', joints=list(JOINTS))
    plot = listeners('plot', start_parameter_services=False)
    watched = Watched(client, [controller], [plot])
    unit = watched.unit
    unit.update()
    assert unit.renewed == [] and unit.takes_commands()
    # A killed process stays in the graph; here the first one simply continues.
    again = listeners('controller', joints=list(JOINTS))
    client.until(lambda: (unit.update(), unit.renewed == ['/controller'])[1])
    assert not unit.takes_commands()  # the new one has not received the last commands
    assert unit.is_waiting()  # its own parameters are requested
    watched.others.append(again)
    renewed = []
    watched.until(
        lambda: (renewed.extend(unit.renewed), unit.listeners['/controller'].has_answered)[1]
    )
    unit.update()
    assert unit.takes_commands()
    # A node without the parameters of a controller may come and go: the arm must not sink for it.
    plot.node.destroy_subscription(plot.subscription)
    listen(plot)
    seen = set(unit.listeners['/plot'].endpoints)

    def is_there():
        unit.update()
        renewed.extend(unit.renewed)
        return '/plot' in unit.listeners and bool(unit.listeners['/plot'].endpoints - seen)

    client.until(is_there)
    assert renewed == []


def test_a_deactivated_controller_ends_the_output_and_the_next_start_begins_there(
    client, start, controller
):
    unit = controller(joints=['hinge'], interface_name='effort')
    unit.hardware.append([0.0])

    def publish():
        client.publish(['hinge'], [0.0], [0.0], unit.hardware[-1])

    start(robot_description_file=PENDULUM, state_timeout=1.0)
    client.record_commands()
    client.activate(publish)
    client.until(unit.events.get_subscription_count, publish)
    client.until(lambda: unit.hardware[-1] == [pytest.approx(HOLD)], publish)
    unit.deactivate()
    client.until_output('FAULT', publish)
    assert '/forward_effort_controller is' in client.reason
    assert 'the hardware may hold: hinge: 10.3005' in client.reason
    # No command any more, and no word that nothing is in force. They are two topics: the last
    # command may be heard a moment after the state.
    client.during(0.3, publish)
    client.commands.clear()
    client.during(0.5, publish)
    assert client.commands == []
    answer = client.enable(False, publish)
    assert not answer.success
    assert 'may be in force at the hardware (hinge: 10.3005)' in answer.message
    # An inactive controller is refused.
    answer = client.enable(True, publish)
    assert not answer.success
    assert 'activate it first' in answer.message
    # Active again: the ramp begins at what the hardware holds, without a step.
    unit.activate()
    begin = len(unit.hardware)
    client.until(lambda: client.enable(True, publish).success, publish)
    client.until_output('ACTIVE', publish)
    client.during(0.3, publish)
    efforts = np.array(unit.hardware[begin - 1 :])
    assert np.abs(np.diff(efforts, axis=0)).max() < 0.05 * HOLD
    assert efforts[-1] == pytest.approx(HOLD)
    client.enable(False, publish)
    client.until_output('READY', publish)


def test_a_late_controller_gets_the_ramp_or_stops_the_output(client, start, publish, controller):
    start(robot_description_file=PENDULUM, state_timeout=1.0)
    outputs = client.outputs
    client.node.create_subscription(OutputState, '/dynamics_node/state', outputs.append, 10)
    client.until_heard(publish)
    assert 'nothing listens there' in client.enable(True, publish).message
    client.until_output('ACTIVE', publish)
    late = controller(joints=['hinge'], interface_name='effort')
    client.until(
        lambda: any('has begun to listen' in output.reason for output in outputs), publish
    )
    client.until_output('ACTIVE', publish)
    # The first command may have come before it was found; from then on, the ramp.
    efforts = np.array(late.hardware)[:, 0]
    begin = int(np.argmin(efforts))
    assert efforts[begin] < 0.2 * HOLD
    assert np.diff(efforts[begin:]).max() < 0.2 * HOLD
    late.close()
    controller(joints=['other'], interface_name='effort')
    client.until_output('FAULT', publish)
