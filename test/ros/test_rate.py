"""A rate from a counter that is read now and then."""

from dynamics_node.ros.rate import Rate


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
