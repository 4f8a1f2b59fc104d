"""States of the output: READY → STARTING → ACTIVE → STOPPING → READY, HOLDING or FAULT."""

from collections.abc import Callable
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
        Cause of the state, as text.
    fault : str
        The first fault since the last start; '' if there was none.
    on_change : callable(state, reason) or None
        Called after every change. Its exceptions are logged.

    """

    def __init__(self, on_change: Callable[[OutputState, str], None] | None = None) -> None:
        self.state = OutputState.READY
        self.reason = 'output is off until it is enabled'
        self.fault = ''
        self.on_change = on_change

    @property
    def name(self) -> str:
        """Name of the state."""
        return self.state.name

    @property
    def is_driving(self) -> bool:
        """True while commands follow the model: STARTING and ACTIVE."""
        return self.state in (OutputState.STARTING, OutputState.ACTIVE)

    @property
    def is_on(self) -> bool:
        """True while commands are published: STARTING, ACTIVE and STOPPING."""
        return self.is_driving or self.state == OutputState.STOPPING

    def latch(self, reason: str) -> None:
        """Record a fault; the first one stays until the next start."""
        self.fault = self.fault or reason

    def enter(self, state: OutputState, reason: str) -> None:
        """
        Change the state and notify the observer, unless state and reason stay the same.

        Parameters
        ----------
        state : OutputState
        reason : str
            Cause, as text.

        """
        if state == OutputState.FAULT and self.state == state:
            return  # latched: the first fault is the cause
        if (state, reason) == (self.state, self.reason):
            return
        self.state, self.reason = state, reason
        if self.on_change is None:
            return
        try:
            self.on_change(state, reason)
        except Exception:
            # The observer only reports; the arm must not depend on it.
            _log.exception('observer of the output state failed')
