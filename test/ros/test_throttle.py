"""Warnings that keep coming are logged once a period."""

from dynamics_node.ros.throttle import Throttle


def test_the_first_is_due_and_then_one_per_period():
    times = iter([5.0, 5.5, 5.999, 6.0, 6.5, 9.0])
    throttle = Throttle(1.0, clock=lambda: next(times))
    assert [throttle.is_due() for _ in range(6)] == [True, False, False, True, False, True]
