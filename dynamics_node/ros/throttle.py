"""A warning at most once a second, at no cost in between."""

import time


class Throttle:
    """
    Says when a message that keeps coming is due again.

    rclpy's own `throttle_duration_sec` looks through the source files for its caller at every
    call, logged or not: near a millisecond, in a callback that may come a thousand times a
    second.

    """

    def __init__(self, period, clock=time.monotonic):
        """
        Start due.

        Parameters
        ----------
        period : float
            Shortest time between two messages, s.
        clock : callable() -> float
            Steady, s.

        """
        self._period = period
        self._clock = clock
        self._next = float('-inf')

    def is_due(self):
        """Tell whether the message may be logged now; if so, the period begins again."""
        now = self._clock()
        if now < self._next:
            return False
        self._next = now + self._period
        return True
