"""Services are left out of most waits while efforts are sent, and never for long."""

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


@pytest.fixture
def ros():
    rclpy.init()
    yield
    rclpy.shutdown()


def test_rclpys_own_is_the_default(ros):
    assert type(make_executor('rclpy')) is SingleThreadedExecutor


# Older ones drop the coroutine of a callback, which is why they are refused.
@pytest.mark.filterwarnings('ignore::pytest.PytestUnraisableExceptionWarning')
def test_the_events_executor_is_used_where_it_is_sound_and_refused_in_words_elsewhere(ros):
    with contextlib.suppress(UnsoundExecutorError):
        chosen = make_executor('events')
        assert type(chosen).__name__ == 'EventsExecutor'


@pytest.mark.parametrize(
    'broken, problem',
    [
        # One that never calls anything, and one that does not wait.
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
    # Beside other tests it gets a part of a core only.
    monkeypatch.setattr(executor, 'BUSY_SHARE', 0.05)
    with pytest.raises(UnsoundExecutorError, match='it uses the processor while it waits'):
        make_executor('events')
