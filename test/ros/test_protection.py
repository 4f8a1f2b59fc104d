"""Checks while efforts are sent: other publishers, over DDS, and controllers."""

from types import SimpleNamespace

from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.torque_path.protection import Protection
from dynamics_node.ros.torque_path.publisher_monitor import PublisherMonitor
import pytest
from std_msgs.msg import Float64MultiArray, String


class Path:
    """A torque path that records its calls."""

    def __init__(self):
        self.is_driving = self.is_on = True
        self.calls, self.checks = [], 0
        self.output = SimpleNamespace(limiter=SimpleNamespace(describe_last=lambda: 'a: -32'))

    def fault(self, now, reason):
        self.calls.append(('fault', reason))

    def lose_controller(self, now, reason):
        self.calls.append(('lost', reason))

    def restart_from_zero(self, now, reason):
        self.calls.append(('restart', reason))

    def monitored(self, now):
        self.checks += 1


def listener(inactive=(), is_controller=True):
    return SimpleNamespace(inactive=lambda: list(inactive), is_controller=is_controller)


@pytest.fixture
def parts():
    path = Path()
    parts = SimpleNamespace(
        path=path, conflicts=[], refusals=[], next_listeners={'/controller': listener()}, errors=[]
    )
    controllers = SimpleNamespace(
        listeners=dict(parts.next_listeners),
        refusals=lambda names: parts.refusals,
        has_listener=lambda: bool(controllers.listeners),
        renewed=[],
        takes_commands=lambda: any(not item.inactive() for item in controllers.listeners.values()),
    )

    def update():
        gone = [
            name
            for name, item in controllers.listeners.items()
            if item.is_controller and name not in parts.next_listeners
        ]
        controllers.listeners = dict(parts.next_listeners)
        return gone

    controllers.update = update
    parts.controllers = controllers
    node = SimpleNamespace(
        create_timer=lambda *_, **__: None,
        get_logger=lambda: SimpleNamespace(error=parts.errors.append),
    )
    parts.unit = Protection(
        NodeContext(node, {}, SimpleNamespace(joint_names=('a',))),
        SimpleNamespace(path=path),
        SimpleNamespace(conflicts=lambda: parts.conflicts),
        controllers,
    )
    return parts


@pytest.mark.parametrize('finding', ['conflicts', 'refusals'])
def test_other_publishers_and_a_late_mismatch_stop_the_output(parts, finding):
    parts.unit.check()
    assert parts.path.calls == []
    assert parts.path.checks == 1  # reported to the torque path
    getattr(parts, finding).append('a reason')
    parts.unit.check()
    assert parts.path.calls == [('fault', 'a reason')]
    # While the output is off, only the controllers are checked.
    parts.path.calls.clear()
    parts.path.is_driving = parts.path.is_on = False
    parts.unit.check()
    assert parts.path.calls == []


def test_a_deactivated_or_lost_controller_ends_the_output(parts):
    parts.next_listeners = {'/controller': listener(['/controller is inactive'])}
    parts.unit.check()
    assert parts.path.calls == [('lost', '/controller is inactive')]
    parts.path.calls.clear()
    parts.next_listeners = {'/controller': listener()}
    parts.unit.check()
    parts.next_listeners = {}
    parts.unit.check()
    assert parts.path.calls[0] == ('lost', '/controller no longer listens to the commands')


@pytest.mark.parametrize('others', [{}, {'/controller': listener(['/controller is inactive'])}])
def test_a_second_controller_that_still_listens_gets_the_whole_stop(parts, others):
    parts.next_listeners = {'/controller': listener(), '/second': listener()}
    parts.unit.check()
    parts.next_listeners = {**others, '/second': listener()}
    parts.unit.check()
    [(what, reason)] = parts.path.calls
    assert what == 'fault'
    assert reason.endswith('; its hardware may hold the last efforts: a: -32')
    parts.path.is_driving = False  # the stop is on its way: it goes on
    parts.unit.check()
    assert len(parts.path.calls) == 1
    parts.next_listeners = {}
    parts.unit.check()
    what, reason = parts.path.calls[-1]
    assert what == 'lost' and '/second no longer listens to the commands' in reason


def test_a_controller_that_begins_to_listen_gets_the_ramp(parts):
    ramp = ('restart', '/controller has begun to listen to the commands')
    parts.controllers.listeners = parts.next_listeners = {}
    parts.unit.check()
    parts.next_listeners = {'/controller': listener()}
    parts.unit.check()
    assert parts.path.calls == [ramp]
    parts.next_listeners = {'/controller': listener(), '/plot': listener(is_controller=False)}
    parts.unit.check()
    assert len(parts.path.calls) == 1
    # One that is no controller may leave.
    parts.next_listeners = {'/controller': listener()}
    parts.unit.check()
    assert len(parts.path.calls) == 1
    parts.controllers.renewed = ['/controller']  # restarted
    parts.unit.check()
    assert parts.path.calls == [ramp, ramp]


def test_a_check_that_raises_is_not_reported(parts):
    def fail():
        raise RuntimeError('no graph')

    parts.controllers.update = fail
    for _ in range(10):
        parts.unit.check()
    assert parts.path.checks == 0  # the torque path stops when the last one is too long ago
    assert len(parts.errors) == 1


def monitor(client, allow=False):
    """Return a monitor of the topics of a client."""
    states = SimpleNamespace(
        topic='/joint_states',
        count_publishers=lambda: client.node.count_publishers('/joint_states'),
    )
    context = NodeContext(client.node, {'allow_several_state_publishers': allow})
    return PublisherMonitor(context, '/efforts', states, SimpleNamespace(topic='/described'))


def test_other_sources_of_efforts_and_states_are_named(client, participant):
    client.node.create_publisher(Float64MultiArray, 'efforts', 1)
    unit = monitor(client)
    client.until(lambda: client.node.count_publishers('/efforts') == 1)
    assert unit.conflicts() == []
    other = participant('joint_state_publisher')
    other.node.create_publisher(Float64MultiArray, 'efforts', 1)
    # Its name comes some time after it.
    client.until(lambda: sum('joint_state_publisher' in text for text in unit.conflicts()) == 2)
    efforts, joint_states = unit.conflicts()
    assert efforts == (
        '1 other publisher(s) on /efforts (/joint_state_publisher): two sources '
        'of effort would fight'
    )
    assert joint_states.startswith('2 publishers on /joint_states (/joint_state_publisher')
    assert 'allow_several_state_publishers' in joint_states
    unit = monitor(client, allow=True)  # several sources of states
    assert unit.conflicts() == [efforts]
    other.close()
    client.until(lambda: unit.conflicts() == [])


def test_another_node_of_the_same_name_is_named_too(client, participant):
    client.node.create_publisher(Float64MultiArray, 'efforts', 1)
    name = client.node.get_name()
    participant(name).node.create_publisher(Float64MultiArray, 'efforts', 1)
    unit = monitor(client)
    client.until(lambda: any(f'(/{name})' in text for text in unit.conflicts()))


def test_a_second_publisher_of_descriptions_is_a_conflict(client, participant):
    unit, name = monitor(client), 'second_robot_state_publisher'
    client.node.create_publisher(String, '/described', 1)
    client.until(lambda: client.node.count_publishers('/described') == 1)
    assert unit.description_conflicts() == []
    participant(name).node.create_publisher(String, '/described', 1)
    client.until(lambda: name in ''.join(unit.description_conflicts()))
    [text] = unit.description_conflicts()
    assert text.startswith('2 publishers on /described')
    assert 'which of them describes this robot?' in text
