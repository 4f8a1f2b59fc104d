"""Whether every joint state is accounted for."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Account:
    """
    What the node says about joint states, and what it was sent.

    Attributes
    ----------
    sent : int
        States that the line has published.
    accepted, rejected, skipped : int
        What the node says has become of them.

    """

    sent: int
    accepted: int
    rejected: int
    skipped: int

    @property
    def known(self):
        """States of which the node says what became of them."""
        return self.accepted + self.rejected + self.skipped


class Books:
    """
    Looks for states that were lost, and for states without a command.

    Attributes
    ----------
    sent : int
        States that were looked at.
    missing : int
        Those of which the node does not say what became of them.
    surplus : int
        Those that it counts though nobody sent them.
    active : int
        States accepted while the output was ACTIVE.
    unanswered : int
        Those to which no command was published, or several.

    """

    def __init__(self):
        """Know of nothing yet."""
        self.sent = self.missing = self.surplus = self.active = self.unanswered = 0
        self._opened = None
        self._last = None

    def open(self, account):
        """Begin with an account that was taken while the line was silent."""
        self._opened = account

    def close(self, account):
        """Look at everything since `open`, by another account taken in silence."""
        before, self._opened = self._opened, None
        sent = account.sent - before.sent
        difference = sent - (account.known - before.known)
        self.sent += sent
        self.missing += max(difference, 0)
        self.surplus += max(-difference, 0)

    @property
    def is_open(self):
        """Whether there was an `open` without a `close`."""
        return self._opened is not None

    def diagnosed(self, state, accepted, commands):
        """
        Take what one message of the diagnostics says, every one in its order.

        They come on every change of the state; so between two of them that say ACTIVE it was
        ACTIVE all the time, and every state that was accepted has had its command.

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
            # Said when the state changed: because of a state whose command follows right after.
            self._last = (accepted, commands + 1)
            return
        states, answers = accepted - self._last[0], commands - self._last[1]
        self.active += states
        self.unanswered += abs(states - answers)
        self._last = (accepted, commands)
