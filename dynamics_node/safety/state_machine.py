"""When the output is on: READY → STARTING → ACTIVE → STOPPING → READY, HOLDING or FAULT."""

from enum import IntEnum
import logging

_log = logging.getLogger(__name__)


class OutputState(IntEnum):
    """The states of the output, numbered as in dynamics_interfaces/msg/OutputState."""

    READY = 0
    STARTING = 1
    ACTIVE = 2
    STOPPING = 3
    FAULT = 4
    HOLDING = 5


class OutputStateMachine:
    """
    The state of the output, its reason, and the latched fault.

    Attributes
    ----------
    state : OutputState
    reason : str
        Why the state is what it is, for people.
    fault : str
        The first fault since the last start; '' if there was none.
    on_change : callable(state, reason) or None
        Called after every change. An exception in it is logged and changes nothing here.

    """

    def __init__(self, on_change=None):
        self.state = OutputState.READY
        self.reason = 'output is off until it is enabled'
        self.fault = ''
        self.on_change = on_change

    @property
    def name(self):
        """The state as a word."""
        return self.state.name

    @property
    def is_driving(self):
        """True while commands follow the model: STARTING and ACTIVE."""
        return self.state in (OutputState.STARTING, OutputState.ACTIVE)

    @property
    def is_on(self):
        """True while commands are published: STARTING, ACTIVE and STOPPING."""
        return self.is_driving or self.state == OutputState.STOPPING

    def latch(self, reason):
        """Keep the first fault until the next start."""
        self.fault = self.fault or reason

    def enter(self, state, reason):
        """
        Change the state and tell the observer; the same state for the same reason is no change.

        Parameters
        ----------
        state : OutputState
        reason : str
            For people.

        """
        if state == OutputState.FAULT and self.state == state:
            return  # latched: the first fault is the one that people have to read
        if (state, reason) == (self.state, self.reason):
            return
        self.state, self.reason = state, reason
        if self.on_change is None:
            return
        try:
            self.on_change(state, reason)
        except Exception:
            # The observer informs people; the arm must not depend on that.
            _log.exception('observer of the output state failed')
