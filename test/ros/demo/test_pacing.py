"""Real time on a clock that the test turns."""

from dynamics_node.ros.demo.pacing import Pacer
import pytest


def test_as_many_steps_as_time_has_passed():
    """Every millisecond twice, whatever the rhythm of the calls."""
    pacer = Pacer(0.0005, 10.0)
    assert pacer.steps_due(10.002) == 4
    assert pacer.steps_due(10.002) == 0
    assert sum(pacer.steps_due(10.002 + 0.0013 * k) for k in range(1, 1001)) == pytest.approx(
        2600, abs=1
    )


def test_a_long_pause_is_not_caught_up():
    """After ten seconds of sleep it goes on with 50 ms."""
    pacer = Pacer(0.001, 0.0)
    assert pacer.steps_due(10.0) == 50
    assert pacer.steps_due(10.001) == 1


def test_a_clock_that_stands_still_gives_no_steps():
    """And never a negative number."""
    pacer = Pacer(0.001, 5.0)
    assert pacer.steps_due(5.0) == 0
    assert pacer.steps_due(4.0) == 0


def test_it_says_to_which_time_it_has_come():
    """Whole steps, and a pause that is not caught up is skipped."""
    pacer = Pacer(0.001, 1.0)
    assert pacer.simulated_to == 1.0
    pacer.steps_due(1.0104)
    assert pacer.simulated_to == pytest.approx(1.010)
    pacer.steps_due(3.0)
    assert pacer.simulated_to == pytest.approx(3.0)
