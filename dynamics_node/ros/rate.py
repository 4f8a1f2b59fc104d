"""How often something happens, for people to see."""


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
