"""Steps in real time, and the offset between two clocks."""

from dynamics_node.demo.timing import ClockOffset, Pacer
import pytest

MILLISECOND = 1_000_000


class Clocks:
    """A steady clock, and another one that is ahead of it."""

    def __init__(self, delays):
        """Take `delays` [ns] after the readings of the other clock, then none."""
        self.time, self.ahead, self.delays = 0, 5_000 * MILLISECOND, list(delays)

    def steady(self):
        """Return the steady time; a reading takes a microsecond."""
        self.time += 1_000
        return self.time

    def clock(self):
        """Return the other time."""
        result = self.time + self.ahead
        self.time += self.delays.pop(0) if self.delays else 0
        return result


def error(offset, clocks):
    """Return how wrong the offset is [ns]."""
    return abs(offset.now() - clocks.ahead)


def test_the_offset_does_not_jitter_with_the_readings():
    clocks = Clocks(
        [3 * MILLISECOND, 0, MILLISECOND, 7 * MILLISECOND, 100]
        + 50 * [0, 4 * MILLISECOND, 90 * MILLISECOND]
    )
    offset = ClockOffset(clocks.clock, clocks.steady)
    found = {offset.now() for _ in range(150)}
    assert len(found) == 1
    assert abs(found.pop() - clocks.ahead) <= 1_000


def test_a_clock_that_was_set_is_followed():
    clocks = Clocks([])
    offset = ClockOffset(clocks.clock, clocks.steady)
    for change in (10_000 * MILLISECOND, -15_000 * MILLISECOND, 2 * MILLISECOND):
        clocks.ahead += change
        assert error(offset, clocks) <= 1_000
    clocks.ahead += MILLISECOND // 2
    assert error(offset, clocks) > MILLISECOND // 4


def test_as_many_steps_as_time_has_passed():
    pacer = Pacer(0.0005, 10.0)
    assert pacer.steps_due(10.002) == 4
    assert pacer.steps_due(10.002) == 0
    assert sum(pacer.steps_due(10.002 + 0.0013 * k) for k in range(1, 1001)) == pytest.approx(
        2600, abs=1
    )


def test_a_long_pause_is_not_caught_up():
    pacer = Pacer(0.001, 0.0)
    assert pacer.steps_due(10.0) == 50
    assert pacer.steps_due(10.001) == 1


def test_a_clock_that_stands_still_gives_no_steps():
    pacer = Pacer(0.001, 5.0)
    assert pacer.steps_due(5.0) == 0
    assert pacer.steps_due(4.0) == 0


def test_it_says_to_which_time_it_has_come():
    pacer = Pacer(0.001, 1.0)
    assert pacer.simulated_to == 1.0
    pacer.steps_due(1.0104)
    assert pacer.simulated_to == pytest.approx(1.010)
    pacer.steps_due(3.0)
    assert pacer.simulated_to == pytest.approx(3.0)
