"""Listeners are noticed within a twentieth of a second, over DDS."""

import time

from dynamics_node.ros.support.throttling import (
    HasSubscribers,
    Rate,
    SUBSCRIBER_COUNT_AGE,
    Throttle,
)
from std_msgs.msg import String


def test_a_listener_is_noticed_soon_after_it_was_matched_and_soon_after_it_left(client):
    publisher = client.node.create_publisher(String, 'listened', 1)
    listened = HasSubscribers(publisher)
    assert not listened
    subscription = client.node.create_subscription(String, 'listened', lambda _: None, 1)
    client.until(publisher.get_subscription_count)
    time.sleep(SUBSCRIBER_COUNT_AGE)
    assert listened
    client.node.destroy_subscription(subscription)
    client.until(lambda: not publisher.get_subscription_count())
    time.sleep(SUBSCRIBER_COUNT_AGE)
    assert not listened


def test_the_middleware_is_not_asked_for_every_message():
    class Publisher:
        asked = 0

        def get_subscription_count(self):
            self.asked += 1
            return 1

    publisher = Publisher()
    listened = HasSubscribers(publisher, period=3600.0)
    assert all(bool(listened) for _ in range(100))
    assert publisher.asked == 1


def test_the_rate_is_that_between_the_last_two_readings():
    rate = Rate()
    assert rate.value == 0.0
    rate.measure(10.0, 100)
    rate.measure(12.0, 400)
    assert rate.value == 150.0
    rate.measure(13.0, 400)
    assert rate.value == 0.0


def test_a_counter_that_begins_anew_is_no_negative_rate():
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
