"""Listeners are noticed within a twentieth of a second, over DDS."""

import time

from dynamics_node.ros.listened import ASK_EVERY, Listened
from std_msgs.msg import String


def test_a_listener_is_noticed_soon_after_it_was_matched_and_soon_after_it_left(client):
    publisher = client.node.create_publisher(String, 'listened', 1)
    listened = Listened(publisher)
    assert not listened
    subscription = client.node.create_subscription(String, 'listened', lambda _: None, 1)
    client.until(publisher.get_subscription_count)
    time.sleep(ASK_EVERY)
    assert listened
    client.node.destroy_subscription(subscription)
    client.until(lambda: not publisher.get_subscription_count())
    time.sleep(ASK_EVERY)
    assert not listened


def test_the_middleware_is_not_asked_for_every_message():
    class Publisher:
        asked = 0

        def get_subscription_count(self):
            self.asked += 1
            return 1

    publisher = Publisher()
    listened = Listened(publisher, period=3600.0)
    assert all(bool(listened) for _ in range(100))
    assert publisher.asked == 1
