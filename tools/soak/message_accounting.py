"""`MessageAccounting`: every joint state is counted, and has its command."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Account:
    """
    Counts of joint states at one time.

    Attributes
    ----------
    sent : int
        States published by the relay.
    accepted, rejected, skipped : int
        States counted by the node.

    """

    sent: int
    accepted: int
    rejected: int
    skipped: int

    @property
    def counted(self):
        """All states counted by the node."""
        return self.accepted + self.rejected + self.skipped


class MessageAccounting:
    """
    Finds lost states, and states without a command.

    Attributes
    ----------
    sent : int
        States in closed periods.
    missing : int
        States that the node has not counted.
    surplus : int
        States that the node has counted, but the relay has not sent.
    active : int
        States accepted while the output was ACTIVE.
    unanswered : int
        States without a command, or with several.

    """

    def __init__(self):
        self.sent = self.missing = self.surplus = self.active = self.unanswered = 0
        self._opened = None
        self._last = None

    def open(self, account):
        """Begin a period with an account taken while the link was silent."""
        self._opened = account

    def close(self, account):
        """End a period with another account taken in silence."""
        before, self._opened = self._opened, None
        sent = account.sent - before.sent
        difference = sent - (account.counted - before.counted)
        self.sent += sent
        self.missing += max(difference, 0)
        self.surplus += max(-difference, 0)

    @property
    def is_open(self):
        """Whether a period is open."""
        return self._opened is not None

    def diagnosed(self, state, accepted, commands):
        """
        Add one diagnostics message, in order.

        The node publishes diagnostics at every change of the state. Between two consecutive
        messages with ACTIVE it was ACTIVE, and each accepted state had its command.

        Parameters
        ----------
        state : str
        accepted, commands : int
            Counted by the node since its start.

        """
        if state != 'ACTIVE':
            self._last = None
            return
        if self._last is None:
            # Published at the change of state, just before the command of the same joint state.
            self._last = (accepted, commands + 1)
            return
        states, answers = accepted - self._last[0], commands - self._last[1]
        self.active += states
        self.unanswered += abs(states - answers)
        self._last = (accepted, commands)
