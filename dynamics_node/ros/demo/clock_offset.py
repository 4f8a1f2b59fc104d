"""The difference of two clocks, without the jitter of reading them one after the other."""

from collections.abc import Callable

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
