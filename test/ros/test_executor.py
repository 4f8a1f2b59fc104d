"""The service windows while efforts are sent, and the self-test of an executor."""

import contextlib
from types import SimpleNamespace

from dynamics_node.ros.support import executor
from dynamics_node.ros.support.callback_groups import BURST, EVERY, ServiceGroup, WINDOW
from dynamics_node.ros.support.executor import make_executor, UnsoundExecutorError
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
import rclpy.experimental


@pytest.fixture
def parts():
    parts = SimpleNamespace(now=10.0, is_driving=True)
    parts.group = ServiceGroup(lambda: parts.is_driving, lambda: parts.now)
    return parts


def test_services_are_always_open_while_the_output_is_off(parts):
    parts.is_driving = False
    for _ in range(100):
        assert parts.group.can_execute(None)
        parts.now += 0.001


def test_services_are_open_in_short_windows_while_efforts_are_sent(parts):
    was_open = []
    for _ in range(1000):
        # Called for every service in every wait.
        answers = {parts.group.can_execute(None) for _ in range(12)}
        assert len(answers) == 1
        was_open.append(answers.pop())
        parts.now += 0.0005
    share = sum(was_open) / len(was_open)
    assert 0.8 * WINDOW / EVERY < share < 1.6 * WINDOW / EVERY
    runs = ''.join('x' if is_open else '.' for is_open in was_open).split('x')
    closed = max(map(len, runs))
    assert closed * 0.0005 < EVERY


def test_services_stay_open_after_a_request(parts):
    assert parts.group.can_execute(None)
    parts.group.beginning_execution(None)
    for _ in range(20):
        parts.now += BURST / 21
        assert parts.group.can_execute(None)
    parts.group.ending_execution(None)


@pytest.fixture
def ros():
    rclpy.init()
    yield
    rclpy.shutdown()


def test_the_single_threaded_executor_is_the_default(ros):
    assert type(make_executor('rclpy')) is SingleThreadedExecutor


# Older versions of it drop the coroutine of a callback, the reason for which they are refused.
@pytest.mark.filterwarnings('ignore::pytest.PytestUnraisableExceptionWarning')
def test_the_events_executor_is_used_or_refused_with_a_reason(ros):
    with contextlib.suppress(UnsoundExecutorError):
        chosen = make_executor('events')
        assert type(chosen).__name__ == 'EventsExecutor'


@pytest.mark.parametrize(
    'broken, problem',
    [
        # One never runs a callback, one raises.
        (lambda self, timeout_sec=None: None, r'no timer and no message and no late answer'),
        (lambda self, timeout_sec=None: 1 / 0, 'ZeroDivisionError'),
    ],
)
def test_an_executor_that_does_not_work_is_refused(ros, monkeypatch, broken, problem):
    kind = type('EventsExecutor', (SingleThreadedExecutor,), {'spin_once': broken})
    monkeypatch.setattr(rclpy.experimental, 'EventsExecutor', kind, raising=False)
    monkeypatch.setattr(executor, 'TEST_WITHIN', 0.2)
    with pytest.raises(UnsoundExecutorError, match=problem):
        make_executor('events')


def test_an_executor_that_computes_while_it_waits_is_refused(ros, monkeypatch):
    class Busy(SingleThreadedExecutor):
        def spin_once(self, timeout_sec=None):
            for _ in range(20):
                with contextlib.suppress(Exception):
                    super().spin_once(timeout_sec=0.0)

    monkeypatch.setattr(rclpy.experimental, 'EventsExecutor', Busy, raising=False)
    # Beside other tests it gets only a part of a core.
    monkeypatch.setattr(executor, 'BUSY_SHARE', 0.05)
    with pytest.raises(UnsoundExecutorError, match='it uses the processor while it waits'):
        make_executor('events')
