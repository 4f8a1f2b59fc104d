"""Real time for a simulation: how many steps are due, on a clock that is passed in."""

from collections.abc import Callable


class Pacer:
    """
    Counts simulation steps against a steady clock.

    Being late is caught up, but not by more than `longest_lag` seconds: after a longer pause (a
    suspended process) the simulation goes on from where it is and does not race.

    """

    def __init__(self, time_step: float, now: float, longest_lag: float = 0.05) -> None:
        """Start at the clock reading `now` [s]; all times are in s."""
        self._time_step = time_step
        self._longest_lag = longest_lag
        self._simulated_to = now

    def steps_due(self, now: float) -> int:
        """Return how many steps lead up to `now` [s], and count them as done."""
        if now - self._simulated_to > self._longest_lag:
            self._simulated_to = now - self._longest_lag
        # The small summand keeps a step that is due now from being lost to rounding.
        steps = max(int((now - self._simulated_to) / self._time_step + 1e-6), 0)
        self._simulated_to += steps * self._time_step
        return steps

    @property
    def simulated_to(self) -> float:
        """Return the clock reading that the simulation has come to [s]."""
        return self._simulated_to


READINGS = 5
SET = 1_000_000  # [ns] a clock that is further from where it was expected was set


class ClockOffset:
    """
    How far a clock is ahead of the steady one, constant until the clock is set.

    Between two readings a process may lose its processor, so every single reading of both clocks
    is wrong by up to milliseconds.

    """

    def __init__(self, clock: Callable[[], int], steady: Callable[[], int]) -> None:
        """Read both clocks, each a function that returns its time [ns]."""
        self._clock, self._steady = clock, steady
        self._offset = self._measured()

    def now(self) -> int:
        """Return the offset [ns]; measured anew if the clock was set."""
        offset, width = self._read()
        if abs(offset - self._offset) > SET + width:
            self._offset = self._measured()
        return self._offset

    def _measured(self) -> int:
        """Return the offset of the reading that took the least time."""
        return min((self._read() for _ in range(READINGS)), key=lambda reading: reading[1])[0]

    def _read(self) -> tuple[int, int]:
        """Return the offset, as far as one reading tells it, and how long that took [ns]."""
        before = self._steady()
        time = self._clock()
        after = self._steady()
        return time - (before + after) // 2, after - before
