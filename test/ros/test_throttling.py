"""Throttles, rates, and cached subscriber counts, over DDS."""

import time

from dynamics_node.ros.support.throttling import (
    HasSubscribers,
    Rate,
    SUBSCRIBER_COUNT_AGE,
    Throttle,
)
from std_msgs.msg import String


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


def test_the_rate_is_that_between_the_last_two_readings():
    rate = Rate()
    assert rate.value == 0.0
    rate.measure(10.0, 100)
    rate.measure(12.0, 400)
    assert rate.value == 150.0
    rate.measure(13.0, 400)
    assert rate.value == 0.0


def test_a_counter_that_is_reset_is_no_negative_rate():
    rate = Rate()
    rate.measure(10.0, 100)
    rate.measure(11.0, 7)
    assert rate.value == 0.0
    rate.measure(12.0, 27)
    assert rate.value == 20.0


def test_two_readings_at_the_same_moment_are_no_error():
    rate = Rate()
    rate.measure(10.0, 1)
    rate.measure(10.0, 1)
    assert rate.value == 0.0


def test_the_first_is_due_and_then_one_per_period():
    times = iter([5.0, 5.5, 5.999, 6.0, 6.5, 9.0])
    throttle = Throttle(1.0, clock=lambda: next(times))
    assert [throttle.is_due() for _ in range(6)] == [True, False, False, True, False, True]
