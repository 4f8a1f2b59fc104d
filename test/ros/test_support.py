"""Throttles, guarded callbacks, service windows, and the self-test of an executor."""

import contextlib
import time
from types import SimpleNamespace

from dynamics_node.ros.support import executor
from dynamics_node.ros.support.callback_errors import guarded, guarded_service, logged
from dynamics_node.ros.support.callback_groups import BURST, EVERY, ServiceGroup, WINDOW
from dynamics_node.ros.support.executor import make_executor, UnsoundExecutorError
from dynamics_node.ros.support.throttling import (
    HasSubscribers,
    Rate,
    SUBSCRIBER_COUNT_AGE,
    Throttle,
)
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
import rclpy.experimental
from std_msgs.msg import String
from std_srvs.srv import SetBool


def test_a_new_and_a_lost_subscriber_are_noticed_within_the_age_of_the_cache(client):
    publisher = client.node.create_publisher(String, 'topic', 1)
    has_subscribers = HasSubscribers(publisher)
    assert not has_subscribers
    subscription = client.node.create_subscription(String, 'topic', lambda _: None, 1)
    client.until(publisher.get_subscription_count)
    time.sleep(SUBSCRIBER_COUNT_AGE)
    assert has_subscribers
    client.node.destroy_subscription(subscription)
    client.until(lambda: not publisher.get_subscription_count())
    time.sleep(SUBSCRIBER_COUNT_AGE)
    assert not has_subscribers


def test_the_count_is_not_queried_for_every_message():
    class Publisher:
        queries = 0

        def get_subscription_count(self):
            self.queries += 1
            return 1

    publisher = Publisher()
    has_subscribers = HasSubscribers(publisher, period=3600.0)
    assert all(bool(has_subscribers) for _ in range(100))
    assert publisher.queries == 1


@pytest.mark.parametrize(
    'readings, rate',
    [
        ([], 0.0),
        ([(10.0, 100), (12.0, 400)], 150.0),
        ([(10.0, 100), (12.0, 400), (13.0, 400)], 0.0),
        # A counter that is reset is no negative rate.
        ([(10.0, 100), (11.0, 7)], 0.0),
        ([(10.0, 100), (11.0, 7), (12.0, 27)], 20.0),
        # Two readings at the same moment are no error.
        ([(10.0, 1), (10.0, 1)], 0.0),
    ],
)
def test_the_rate_is_that_between_the_last_two_readings(readings, rate):
    unit = Rate()
    for reading in readings:
        unit.measure(*reading)
    assert unit.value == rate


def test_the_first_is_due_and_then_one_per_period():
    times = iter([5.0, 5.5, 5.999, 6.0, 6.5, 9.0])
    throttle = Throttle(1.0, clock=lambda: next(times))
    assert [throttle.is_due() for _ in range(6)] == [True, False, False, True, False, True]


class Broken:
    """Callbacks that fail, with their log and the reported internal errors."""

    def __init__(self):
        self.logger = self
        self.logged, self.reported = [], []
        self.error = self.logged.append
        self.on_internal_error = self.reported.append

    @guarded
    def callback(self, message):
        """Fail."""
        raise ZeroDivisionError(message)

    @logged
    def logged_only(self):
        """Fail off the torque path."""
        raise ZeroDivisionError

    def failed(self, response, message):
        """Fill a refusal."""
        response.message = message
        return response

    @guarded_service
    def service(self, request, response):
        """Fail after the answer was set to success."""
        response.success = True
        raise KeyError('lost')


def test_a_failing_callback_is_logged_with_its_traceback_and_reported():
    broken = Broken()
    assert broken.callback('boom') is None
    assert broken.reported == ['internal error in callback: boom']
    assert 'Traceback' in broken.logged[0]
    assert 'ZeroDivisionError' in broken.logged[0]


def test_a_failing_service_answers_with_failure():
    broken = Broken()
    answer = broken.service(SetBool.Request(), SetBool.Response())
    assert not answer.success
    assert "internal error: 'lost'" in answer.message
    assert 'KeyError' in broken.logged[0]


def test_a_repeated_error_does_not_fill_the_log():
    broken = Broken()
    for _ in range(1000):
        broken.callback('boom')
    assert len(broken.logged) == 1
    assert len(broken.reported) == 1000  # all of them reach the torque path
    assert Broken().callback('boom') is None


def test_an_error_off_the_torque_path_is_only_logged():
    broken = Broken()
    assert broken.logged_only() is None
    assert 'ZeroDivisionError' in broken.logged[0]
    assert broken.reported == []


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
