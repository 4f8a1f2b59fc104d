"""Real time for a simulation: the steps that are due, and the offset between two clocks."""

from collections.abc import Callable

READINGS = 5  # of both clocks; the one that took the least time counts
CLOCK_SET = 1_000_000  # [ns] a larger change of the offset means that the clock was set


class Pacer:
    """
    Counts simulation steps against a steady clock.

    A delay up to `longest_lag` seconds is caught up. After a longer pause, of a suspended process
    say, the simulation continues without racing.

    """

    def __init__(self, time_step: float, now: float, longest_lag: float = 0.05) -> None:
        """Start at the clock reading `now` [s]."""
        self._time_step = time_step
        self._longest_lag = longest_lag
        self._simulated_to = now

    def steps_due(self, now: float) -> int:
        """Return the number of steps up to `now` [s], and count them as done."""
        if now - self._simulated_to > self._longest_lag:
            self._simulated_to = now - self._longest_lag
        # The small summand keeps rounding from losing a step that is due now.
        steps = max(int((now - self._simulated_to) / self._time_step + 1e-6), 0)
        self._simulated_to += steps * self._time_step
        return steps

    @property
    def simulated_to(self) -> float:
        """Return the clock reading that the simulation has reached [s]."""
        return self._simulated_to


class ClockOffset:
    """
    Offset of a clock from the steady one, constant until the clock is set.

    A process may lose its processor between two readings, so a single reading of both clocks can
    be wrong by milliseconds.

    """

    def __init__(self, clock: Callable[[], int], steady: Callable[[], int]) -> None:
        """Measure the offset; both clocks are functions that return their time [ns]."""
        self._clock, self._steady = clock, steady
        self._offset = self._measured()

    def now(self) -> int:
        """Return the offset [ns]; it is measured again if the clock was set."""
        offset, width = self._read()
        if abs(offset - self._offset) > CLOCK_SET + width:
            self._offset = self._measured()
        return self._offset

    def _measured(self) -> int:
        """Return the offset of the reading that took the least time."""
        return min((self._read() for _ in range(READINGS)), key=lambda reading: reading[1])[0]

    def _read(self) -> tuple[int, int]:
        """Return the offset by one reading, and the duration of that reading [ns]."""
        before = self._steady()
        time = self._clock()
        after = self._steady()
        return time - (before + after) // 2, after - before
