"""Real time for a simulation: how many steps are due, on a clock that is passed in."""


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
