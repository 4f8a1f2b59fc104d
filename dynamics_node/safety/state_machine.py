"""When the output is on: READY → STARTING → ACTIVE → STOPPING → READY, or FAULT."""

from enum import IntEnum


class OutputState(IntEnum):
    """The states of the output, numbered as in dynamics_interfaces/msg/OutputState."""

    READY = 0
    STARTING = 1
    ACTIVE = 2
    STOPPING = 3
    FAULT = 4


class OutputStateMachine:
    """
    The state of the output and the ramp that belongs to it.

    FAULT is latched: only a new `enable` leaves it.

    Attributes
    ----------
    state : OutputState
    reason : str
        Why the state is what it is, for people.
    fault : str
        The first fault since the last `enable`; '' if there was none.
    on_change : callable(state, reason) or None
        Called after every change.

    """

    def __init__(self, on_change=None):
        """Start READY."""
        self.state = OutputState.READY
        self.reason = 'output is off until it is enabled'
        self.on_change = on_change
        self._since = 0.0
        self._duration = 0.0
        self.fault = ''

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

    def enable(self, now, ramp):
        """
        Begin the start ramp; from READY and FAULT only.

        Parameters
        ----------
        now : float
            Steady clock, s.
        ramp : float
            Duration, s.

        Returns
        -------
        bool
            False if the output is on already or still stopping.

        """
        if self.is_on:
            return False
        self.fault = ''
        self._begin(OutputState.STARTING, now, ramp, 'enabled')
        return True

    def restart(self, now, ramp, reason):
        """
        Begin the start ramp anew; nothing happens unless commands follow the model.

        Parameters
        ----------
        now : float
            Steady clock, s.
        ramp : float
            Duration, s.
        reason : str
            For people.

        """
        if self.is_driving:
            self._begin(OutputState.STARTING, now, ramp, reason)

    def stop(self, now, ramp, reason, is_fault=False):
        """
        Begin to stop; a fault latches when the stop ends, and at once if the output is off.

        Parameters
        ----------
        now : float
            Steady clock, s.
        ramp : float
            Duration, s.
        reason : str
            For people.
        is_fault : bool

        """
        if is_fault:
            self.fault = self.fault or reason
        if self.is_driving:
            self._begin(OutputState.STOPPING, now, ramp, reason)
        elif is_fault and self.state != OutputState.STOPPING:
            self._change(OutputState.FAULT, self.fault)

    def hasten(self, now, ramp):
        """Let a stop that is under way end no later than `ramp` seconds from now."""
        if self.state == OutputState.STOPPING:
            self._duration = min(self._duration, now - self._since + ramp)

    def progress(self, now):
        """
        Return how far the ramp of the present state has come.

        Parameters
        ----------
        now : float
            Steady clock, s.

        Returns
        -------
        float
            From 0 to 1; 1 in a state without a ramp.

        """
        if self.state not in (OutputState.STARTING, OutputState.STOPPING):
            return 1.0
        elapsed = now - self._since
        return 1.0 if elapsed >= self._duration else max(elapsed, 0.0) / self._duration

    def advance(self, now):
        """
        Leave STARTING or STOPPING when its ramp is over.

        Parameters
        ----------
        now : float
            Steady clock, s.

        """
        if self.progress(now) < 1.0:
            return
        if self.state == OutputState.STARTING:
            self._change(OutputState.ACTIVE, 'start ramp done')
        elif self.state == OutputState.STOPPING and self.fault:
            self._change(OutputState.FAULT, self.fault)
        elif self.state == OutputState.STOPPING:
            self._change(OutputState.READY, f'stopped: {self.reason}')

    def _begin(self, state, now, duration, reason):
        self._since, self._duration = now, duration
        self._change(state, reason)

    def _change(self, state, reason):
        self.state, self.reason = state, reason
        if self.on_change is not None:
            self.on_change(state, reason)
