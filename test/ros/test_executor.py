"""rclpy's executors: its own by default, the events executor only where it works."""

import contextlib

from dynamics_node.ros import executor
from dynamics_node.ros.executor import make_executor, UnsoundExecutorError
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
import rclpy.experimental


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
    with pytest.raises(UnsoundExecutorError, match='it computes while nothing happens'):
        make_executor('events')
