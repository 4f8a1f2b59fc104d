"""Periodic tasks without timers: throttled logging, measured rates, cached subscriber counts."""

import time

# Period of the queries for subscribers, s: far below the time of discovery.
ASK_EVERY = 0.05


class Throttle:
    """
    Limits how often a repeated message is logged.

    rclpy's own `throttle_duration_sec` searches the source files for its caller at every call,
    logged or not: about 1 ms, in a callback that may run at 1 kHz.

    """

    def __init__(self, period, clock=time.monotonic):
        """
        Let the first message pass.

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
        """Return whether the message may be logged now; if so, restart the period."""
        now = self._clock()
        if now < self._next:
            return False
        self._next = now + self._period
        return True


class Rate:
    """
    Rate of an event, from a counter that is read from time to time.

    Attributes
    ----------
    value : float
        Hz, between the last two readings.

    """

    def __init__(self):
        self.value = 0.0
        self._last = (0.0, 0)

    def measure(self, now, count):
        """
        Take a reading.

        Parameters
        ----------
        now : float
            s.
        count : int
            A smaller count than before restarts the measurement.

        """
        before, earlier = self._last
        self.value = max(count - earlier, 0) / max(now - before, 1e-6)
        self._last = (now, count)


class HasSubscribers:
    """
    Tells whether a publisher has subscribers.

    Querying the subscriber count costs more than computing a torque, so it is cached.

    """

    def __init__(self, publisher, period=ASK_EVERY):
        """
        Query at the first use.

        Parameters
        ----------
        publisher : rclpy.publisher.Publisher
        period : float
            Time for which a count is cached, s.

        """
        self._publisher = publisher
        self._due = Throttle(period)
        self._has_subscribers = False

    def __bool__(self):
        if self._due.is_due():
            self._has_subscribers = self._publisher.get_subscription_count() > 0
        return self._has_subscribers
