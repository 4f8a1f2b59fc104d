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


class Rate:
    """
    How often something happens, from a counter that is read now and then.

    Attributes
    ----------
    value : float
        Hz, between the last two readings.

    """

    def __init__(self):
        """Begin at zero."""
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
            A smaller one than before begins anew.

        """
        before, earlier = self._last
        self.value = max(count - earlier, 0) / max(now - before, 1e-6)
        self._last = (now, count)


# The longest that a new listener waits for its first message, s: far below what finding each
# other takes.
ASK_EVERY = 0.05


class HasSubscribers:
    """
    Knows whether a publisher has listeners.

    The middleware takes longer to answer that than a state takes to become a torque.

    """

    def __init__(self, publisher, period=ASK_EVERY):
        """
        Know nothing yet.

        Parameters
        ----------
        publisher : rclpy.publisher.Publisher
        period : float
            Longest time for which an answer is taken to hold, s.

        """
        self._publisher = publisher
        self._due = Throttle(period)
        self._has_listeners = False

    def __bool__(self):
        if self._due.is_due():
            self._has_listeners = self._publisher.get_subscription_count() > 0
        return self._has_listeners
