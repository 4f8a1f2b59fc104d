"""Services are left out of most waits while efforts are sent, and never for long."""

from types import SimpleNamespace

from dynamics_node.ros.callback_groups import BURST, EVERY, ServiceGroup, WINDOW
import pytest


@pytest.fixture
def parts():
    parts = SimpleNamespace(now=10.0, is_driving=True)
    parts.group = ServiceGroup(lambda: parts.is_driving, lambda: parts.now)
    return parts


def test_while_the_output_is_off_they_are_always_waited_for(parts):
    parts.is_driving = False
    for _ in range(100):
        assert parts.group.can_execute(None)
        parts.now += 0.001


def test_while_efforts_are_sent_they_are_waited_for_now_and_then(parts):
    waited = []
    for _ in range(1000):
        # Every service is asked for, in every wait.
        answers = {parts.group.can_execute(None) for _ in range(12)}
        assert len(answers) == 1
        waited.append(answers.pop())
        parts.now += 0.0005
    share = sum(waited) / len(waited)
    assert 0.8 * WINDOW / EVERY < share < 1.6 * WINDOW / EVERY
    runs = ''.join('x' if is_open else '.' for is_open in waited).split('x')
    closed = max(map(len, runs))
    assert closed * 0.0005 < EVERY


def test_requests_that_follow_another_do_not_wait(parts):
    assert parts.group.can_execute(None)
    parts.group.beginning_execution(None)
    for _ in range(20):
        parts.now += BURST / 21
        assert parts.group.can_execute(None)
    parts.group.ending_execution(None)
