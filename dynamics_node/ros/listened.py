"""Whether anybody listens to a topic, asked often enough and not for every message."""

from .throttle import Throttle

# The longest that a new listener waits for its first message, s: far below what finding each
# other takes.
ASK_EVERY = 0.05


class Listened:
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
