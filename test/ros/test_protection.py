"""Checks that stop the output while efforts are sent, and the supervision of these checks."""

from types import SimpleNamespace

from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.torque_path.protection import Protection
import pytest


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


def test_a_check_without_findings_is_reported_to_the_torque_path(parts):
    parts.unit.check()
    assert parts.path.calls == []
    assert parts.path.checks == 1


def test_other_publishers_stop_the_output(parts):
    parts.conflicts.append('1 other publisher')
    parts.unit.check()
    assert parts.path.calls == [('fault', '1 other publisher')]


def test_a_late_mismatch_of_a_controller_stops_the_output(parts):
    parts.refusals.append('another order')
    parts.unit.check()
    assert parts.path.calls == [('fault', 'another order')]


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


def test_a_listener_that_is_no_controller_may_leave(parts):
    parts.next_listeners = {'/controller': listener(), '/plot': listener(is_controller=False)}
    parts.unit.check()
    parts.next_listeners = {'/controller': listener()}
    parts.unit.check()
    assert parts.path.calls == []


def test_the_first_controller_that_begins_to_listen_gets_the_ramp(parts):
    parts.controllers.listeners = parts.next_listeners = {}
    parts.unit.check()
    parts.next_listeners = {'/controller': listener()}
    parts.unit.check()
    assert parts.path.calls == [('restart', '/controller has begun to listen to the commands')]
    parts.next_listeners = {'/controller': listener(), '/plot': listener(is_controller=False)}
    parts.unit.check()
    assert len(parts.path.calls) == 1


def test_a_restarted_controller_gets_the_ramp(parts):
    parts.unit.check()
    assert parts.path.calls == []
    parts.controllers.renewed = ['/controller']
    parts.unit.check()
    assert parts.path.calls == [('restart', '/controller has begun to listen to the commands')]


def test_a_check_that_raises_is_not_reported(parts):
    def fail():
        raise RuntimeError('no graph')

    parts.controllers.update = fail
    for _ in range(10):
        parts.unit.check()
    assert parts.path.checks == 0  # the torque path stops when the last one is too long ago
    assert len(parts.errors) == 1


def test_only_the_controllers_are_checked_while_the_output_is_off(parts):
    parts.path.is_driving = parts.path.is_on = False
    parts.conflicts.append('1 other publisher')
    parts.refusals.append('another order')
    parts.unit.check()
    assert parts.path.calls == []
