"""The lean executor does what rclpy's own does; each test runs with both."""

import time

from dynamics_node.ros.lean_executor import LeanExecutor
import pytest
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

PATIENCE = 20.0


@pytest.fixture
def context():
    context = rclpy.Context()
    rclpy.init(context=context)
    yield context
    rclpy.try_shutdown(context=context)


@pytest.fixture(params=[LeanExecutor, SingleThreadedExecutor])
def executor(request, context):
    executor = request.param(context=context)
    yield executor
    executor.shutdown()


@pytest.fixture
def node(context, executor):
    node = rclpy.create_node('lean', context=context)
    executor.add_node(node)
    yield node
    executor.remove_node(node)
    node.destroy_node()


def until(executor, condition):
    """Spin until a condition holds."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        executor.spin_once(0.05)


def spin(executor, seconds):
    """Spin for some time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(0.01)


def test_messages_timers_services_and_guards_are_served(executor, node):
    heard, ticks, guards = [], [], []
    node.create_subscription(String, 'topic', heard.append, 10)
    publisher = node.create_publisher(String, 'topic', 10)
    node.create_timer(0.01, lambda: ticks.append(None))
    guard = node.create_guard_condition(lambda: guards.append(None))

    def answer(request, response):
        response.message = 'yes'
        return response
    node.create_service(Trigger, 'service', answer)
    client = node.create_client(Trigger, 'service')
    until(executor, lambda: publisher.get_subscription_count() and client.service_is_ready())
    for text in 'abc':
        publisher.publish(String(data=text))
    guard.trigger()
    future = client.call_async(Trigger.Request())
    until(executor, lambda: len(heard) == 3 and len(ticks) > 3 and guards and future.done())
    assert [message.data for message in heard] == ['a', 'b', 'c']
    assert future.result().message == 'yes'
    assert len(guards) == 1


def test_what_is_created_in_a_callback_is_served_and_what_is_destroyed_is_not(executor, node):
    first, second = [], []

    def replace():
        first.append(None)
        node.destroy_timer(timer)
        node.create_timer(0.01, lambda: second.append(None))
    timer = node.create_timer(0.01, replace)
    until(executor, lambda: len(second) > 3)
    assert len(first) == 1


def test_a_node_that_was_removed_is_not_served(executor, node):
    ticks = []
    node.create_timer(0.01, lambda: ticks.append(None))
    until(executor, lambda: ticks)
    executor.remove_node(node)
    ticks.clear()
    spin(executor, 0.1)
    assert ticks == []
    executor.add_node(node)
    until(executor, lambda: ticks)


def test_a_timer_that_was_cancelled_rests_and_a_new_period_holds(executor, node):
    ticks = []
    timer = node.create_timer(0.01, lambda: ticks.append(time.monotonic()))
    until(executor, lambda: len(ticks) > 2)
    timer.cancel()
    ticks.clear()
    spin(executor, 0.1)
    assert ticks == []
    timer.timer_period_ns = 300_000_000
    begin = time.monotonic()
    timer.reset()
    until(executor, lambda: ticks)
    assert ticks[0] - begin >= 0.295


def test_an_exception_leaves_and_the_rest_is_served_the_next_time(executor, node):
    ticks = []

    def fail():
        failing.cancel()
        raise ValueError('of the callback')
    failing = node.create_timer(0.001, fail)
    node.create_timer(0.001, lambda: ticks.append(None))
    time.sleep(0.01)
    with pytest.raises(ValueError, match='of the callback'):
        until(executor, lambda: False)
    until(executor, lambda: ticks)


def test_a_wait_ends_after_its_time(executor, node):
    begin = time.monotonic()
    executor.spin_once(0.0)
    while time.monotonic() - begin < 0.1:  # entities that are new wake the executor at first
        executor.spin_once(0.02)
    begin = time.monotonic()
    executor.spin_once(0.2)
    assert 0.19 <= time.monotonic() - begin < 5.0


def test_a_message_that_waits_comes_before_a_timer_that_is_due(context):
    # Whoever was busy looks at the newest state before judging that it is too old.
    executor, order = LeanExecutor(context=context), []
    node = rclpy.create_node('lean', context=context)
    executor.add_node(node)
    node.create_subscription(String, 'topic', lambda message: order.append('message'), 1)
    publisher = node.create_publisher(String, 'topic', 1)
    until(executor, publisher.get_subscription_count)
    publisher.publish(String())
    until(executor, lambda: order)
    timer = node.create_timer(0.05, lambda: order.append('timer'))
    for _ in range(5):
        order.clear()
        spin(executor, 0.1)
        order.clear()
        timer.reset()
        publisher.publish(String())
        time.sleep(0.1)
        executor.spin_once(1.0)
        assert order == ['message', 'timer']
    executor.remove_node(node)
    node.destroy_node()
    executor.shutdown()


def test_tasks_are_run(executor, node):
    done = []
    executor.create_task(done.append, 1)
    until(executor, lambda: done)
    assert done == [1]


@pytest.mark.parametrize('executor', [LeanExecutor], indirect=True)
def test_the_end_of_the_context_ends_the_wait(executor, node, context):
    node.create_timer(0.05, lambda: rclpy.try_shutdown(context=context))
    with pytest.raises(ExternalShutdownException):
        until(executor, lambda: False)


def test_a_callback_that_awaits_is_refused_by_the_lean_one(context):
    executor = LeanExecutor(context=context)
    node = rclpy.create_node('lean', context=context)
    executor.add_node(node)
    never = rclpy.task.Future()

    async def wait():
        timer.cancel()
        await never
    timer = node.create_timer(0.01, wait)
    with pytest.raises(NotImplementedError, match='callbacks that do not await'):
        until(executor, lambda: False)
    executor.remove_node(node)
    node.destroy_node()
    executor.shutdown()
