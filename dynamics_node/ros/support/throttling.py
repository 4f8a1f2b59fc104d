"""Rate limiting: of log messages, of graph queries, and the measured rate of a counter."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

# Longest age of a cached subscriber count, s: far below the duration of discovery.
SUBSCRIBER_COUNT_AGE = 0.05


class Throttle:
    """
    Limits how often something is done, usually a log message.

    rclpy's own `throttle_duration_sec` searches the source files for its caller at every call,
    logged or not. That takes nearly a millisecond, in a callback that may run at 1 kHz.

    """

    def __init__(self, period: float, clock: Callable[[], float] = time.monotonic) -> None:
        """
        Start due.

        Parameters
        ----------
        period : float
            Shortest time between two actions, s.
        clock : callable() -> float
            Steady, s.

        """
        self._period = period
        self._clock = clock
        self._next = float('-inf')

    def is_due(self) -> bool:
        """Return whether the action is due now; if so, the period begins again."""
        now = self._clock()
        if now < self._next:
            return False
        self._next = now + self._period
        return True


class Rate:
    """
    Rate of events, from two readings of a counter.

    Attributes
    ----------
    value : float
        Hz, between the last two readings.

    """

    def __init__(self) -> None:
        self.value = 0.0
        self._last: tuple[float, int] = (0.0, 0)

    def measure(self, now: float, count: int) -> None:
        """
        Take a reading.

        Parameters
        ----------
        now : float
            s.
        count : int
            Events so far; a smaller number than before means that the counter was reset.

        """
        before, earlier = self._last
        self.value = max(count - earlier, 0) / max(now - before, 1e-6)
        self._last = (now, count)


class HasSubscribers:
    """
    Truth value: whether a publisher has subscribers.

    Querying the subscriber count costs more than computing a torque, so it is cached.

    """

    def __init__(self, publisher: Publisher, period: float = SUBSCRIBER_COUNT_AGE) -> None:
        """
        Start without a count; the first use queries it.

        Parameters
        ----------
        publisher : rclpy.publisher.Publisher
        period : float
            Longest age of the cached count, s.

        """
        self._publisher = publisher
        self._due = Throttle(period)
        self._has_subscribers = False

    def __bool__(self) -> bool:
        if self._due.is_due():
            self._has_subscribers = self._publisher.get_subscription_count() > 0
        return self._has_subscribers
