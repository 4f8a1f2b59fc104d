"""The output as a whole: state machine, limiter and watchdog, one command at a time."""

from dataclasses import dataclass

import numpy as np

from .effort_limiter import EffortLimiter, InvalidEffortError
from .state_machine import OutputState, OutputStateMachine

# How often a stop sends its next command, and the shortest time between two looks, s.
STOP_STEP = 0.01
SHORTEST_LOOK = 0.001
# An arm that needs more than its limit for so long is not held by it, s.
LONGEST_SATURATION = 2.0
# Starts that begin anew before the one before was over: more of them in a row follow no state.
MAX_RESTARTS = 3
STOP_BEHAVIORS = ('ramp_to_zero', 'hold', 'zero')


@dataclass(frozen=True)
class OutputSettings:
    """
    How the output starts, stops and is limited.

    Attributes
    ----------
    state_timeout : float
        Largest age of the joint state, s.
    start_ramp, stop_ramp : float
        Durations, s.
    stop_behavior : str
        'ramp_to_zero', 'zero' (as fast as the rate limits allow) or 'hold' (the last command
        stays in force).

    """

    state_timeout: float
    start_ramp: float
    stop_ramp: float
    stop_behavior: str


class EffortOutput:
    """
    Decides for every model effort and every tick whether a command goes out, and which.

    Every method takes the time of one steady clock. A returned command must be published; None
    means that nothing may be.

    Attributes
    ----------
    machine : OutputStateMachine
    limiter : EffortLimiter
        Of no joint at all until `set_limiter`.
    settings : OutputSettings

    """

    def __init__(self, settings, on_change=None):
        """Start with output off and no limits."""
        self.machine = OutputStateMachine(on_change)
        self.limiter = EffortLimiter(np.zeros(0), np.zeros(0), np.zeros(0))
        self.settings = settings
        self._last_time = 0.0
        self._saturated_since = None
        self._start_from = self._stop_from = np.zeros(0)
        self._holds = False
        self._restarts = 0

    def set_limiter(self, limits, rate_limits, scale, names=()):
        """
        Take new limits; the last command to the same joints stays what it is: nothing jumps.

        Parameters
        ----------
        limits, rate_limits, scale : numpy.ndarray, shape (m,)
            See `EffortLimiter`.
        names : sequence of str, optional
            Of the m joints.

        """
        last = self.limiter
        self.limiter = EffortLimiter(limits, rate_limits, scale, names)
        if last.names == self.limiter.names:
            self.limiter.carry_on_from(last)

    def enable(self, now):
        """
        Begin to publish commands, from zero, or from the command that a stop has held.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        bool
            False if the output is on already or still stopping.

        """
        if not self.machine.enable(now, self.settings.start_ramp):
            return False
        self._start_from = self.limiter.last
        self._last_time = now
        self._saturated_since = None
        self._restarts = 0
        return True

    def restart(self, now, reason):
        """
        Go from the last command to the model's by the start ramp, because the state is new.

        Nothing happens unless commands follow the model. More than MAX_RESTARTS of them without
        a start that came to its end are a fault: the effort would stay where it is for ever.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.

        """
        self._restarts = self._restarts + 1 if self.machine.state == OutputState.STARTING else 1
        if self._restarts > MAX_RESTARTS:
            self.fault(now, f'{reason}, {self._restarts} times before the start ramp was over')
            return
        self._start_from = self.limiter.last
        self.machine.restart(now, self.settings.start_ramp, reason)

    def fault(self, now, reason):
        """
        Stop because the arm must not be driven any further; nothing happens while output is off.

        The last command is not held, whatever `settings.stop_behavior` says: it may be what the
        arm runs away with.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.

        """
        if self.machine.is_on:
            self.stop(now, reason, is_fault=True, may_hold=False)

    def stop(self, now, reason, is_fault=False, within=None, may_hold=True):
        """
        Begin to stop, as `settings.stop_behavior` says.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.
        is_fault : bool
            Whether the stop ends in FAULT.
        within : float, optional
            Longest time that the stop may take, s: when the process has to end.
        may_hold : bool
            Whether stop_behavior 'hold' is obeyed; otherwise the effort goes to zero.

        """
        behavior = self.settings.stop_behavior
        holds = behavior == 'hold' and may_hold
        ramp = 0.0 if holds or behavior == 'zero' else self.settings.stop_ramp
        if within is not None:
            ramp = min(ramp, within)
            self.machine.hasten(now, within)
        if self.machine.is_driving:
            self._stop_from = self.limiter.last
            self._holds = holds
            if holds:
                reason += ' (stop_behavior hold: the last efforts stay in force)'
        elif not may_hold:
            self._holds = False
        self.machine.stop(now, ramp, reason, is_fault)

    def on_effort(self, now, effort):
        """
        Take a model effort computed from a fresh state.

        Parameters
        ----------
        now : float
            s.
        effort : numpy.ndarray, shape (m,)
            N m or N.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        """
        if not self.machine.is_driving:
            return None
        try:
            command = self.limiter.command(effort, self.machine.progress(now), self._dt(now),
                                           self._start_from)
        except InvalidEffortError as error:
            self.stop(now, f'invalid effort: {error}', is_fault=True)
            return None
        self._last_time = now
        self.machine.advance(now)
        self._watch_saturation(now)
        return command

    def published(self, now):
        """
        Take note that the last command has gone out.

        The next step is limited by the time since then, and not since its state arrived: however
        late a command goes out, the next one keeps the rate limit as others see it.

        Parameters
        ----------
        now : float
            s.

        """
        self._last_time = now

    def tick(self, now, state_age):
        """
        Watch the age of the joint state, and walk the stop to its end.

        Parameters
        ----------
        now : float
            s.
        state_age : float
            Age of the newest usable joint state, s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        """
        timeout = self.settings.state_timeout
        if self.machine.is_driving and state_age > timeout:
            self.stop(now, f'joint_states stale: last {state_age:.3f} s ago, '
                           f'limit {timeout:.3f} s', is_fault=True)
        if self.machine.state != OutputState.STOPPING:
            return None
        return self._stopping(now)

    def next_look(self, state_age):
        """
        Return when `tick` has to be called next while the output is on.

        Parameters
        ----------
        state_age : float
            Age of the newest usable joint state, s.

        Returns
        -------
        float
            s: the next step of a stop, or the moment at which the newest state becomes stale.

        """
        if not self.machine.is_driving:
            return STOP_STEP
        return max(self.settings.state_timeout - state_age, SHORTEST_LOOK)

    def _stopping(self, now):
        is_over = self.machine.progress(now) >= 1.0
        if is_over and (self._holds or not self.limiter.last.any()):
            # Only now, so that whoever hears of the new state has got the last command before.
            self.machine.advance(now)
            return None
        try:
            command = self.limiter.fade(self._stop_from, 1.0 - self.machine.progress(now),
                                        self._dt(now))
        except InvalidEffortError:  # limits that are no numbers: a stop has to end all the same
            self.limiter.reset()
            command = self.limiter.last
        self._last_time = now
        return command

    def _watch_saturation(self, now):
        if not self.limiter.is_saturated:
            self._saturated_since = None
        elif self._saturated_since is None:
            self._saturated_since = now
        elif now - self._saturated_since > LONGEST_SATURATION:
            self.stop(now, f'effort above its limit for {LONGEST_SATURATION:g} s: '
                           f'{self.limiter.saturation()}', is_fault=True)

    def _dt(self, now):
        return now - self._last_time
