"""Whether the stamp of a joint state can be true."""

from .rejected import RejectedStateError

# However short the timeout: clocks of two machines that are synchronised differ by less.
SMALLEST_TOLERANCE = 0.1


class StampTolerance:
    """
    Compares stamps with the node's own clock.

    Attributes
    ----------
    seconds : float
        The largest difference that is accepted, in both directions, s.

    """

    def __init__(self, state_timeout):
        """
        Accept what is not older than a state may be.

        Parameters
        ----------
        state_timeout : float
            Largest age of a joint state, s.

        """
        self.seconds = max(state_timeout, SMALLEST_TOLERANCE)
        self._nanoseconds = round(self.seconds * 1e9)

    def check(self, stamp, clock):
        """
        Refuse a stamp that is too far from the clock.

        Parameters
        ----------
        stamp : int
            ns.
        clock : int
            The time at which the message arrived, on the clock that stamps belong to, ns.

        Raises
        ------
        RejectedStateError
            Kind 'stamp'; says by how much, and what to look for.

        """
        late = clock - stamp
        if -self._nanoseconds <= late <= self._nanoseconds:
            return
        side = 'old' if late > 0 else 'in the future'
        raise RejectedStateError(
            'stamp',
            f'expected a stamp within {self.seconds:g} s of the clock, got one '
            f'{abs(late) * 1e-9:.3f} s {side}: synchronise the clocks of both machines, and '
            'set use_sim_time on both sides or on neither',
        )

    def is_ahead(self, stamp, clock):
        """Tell whether a stamp that was accepted once lies in the future of the clock by now."""
        return stamp - clock > self._nanoseconds
