"""Which command goes out next: ramps, steps between states, and every stop to its end."""

from dataclasses import dataclass

import numpy as np

from .effort_limiter import EffortLimiter, InvalidEffortError
from .state_machine import OutputState, OutputStateMachine

# Period of the commands of a stop, and of a ramp between two joint states, s.
STOP_PERIOD = 0.01
# A step toward the model's effort counts at most this many nominal periods of the joint states,
# and never more than STOP_PERIOD: after a gap the effort catches up over several commands.
MAX_PERIODS = 3
# A ramp advances by at most this time per command, and a step of a stop counts at most the
# second: a process that stood still goes on where it was instead of skipping the ramp, s.
MAX_RAMP_STEP = 0.1
MAX_STOP_STEP = 0.02
# A stop without a ramp ends within this time whatever the rate limits say, s.
ZERO_WITHIN = 1.0
# The ramp of a stop after a fault is at most this long, s.
MAX_FAULT_RAMP = 2.0
# An arm that needs more than its limit for this long is not held by it, s.
LONGEST_SATURATION = 2.0
STOP_BEHAVIORS = ('ramp_to_zero', 'hold', 'zero')


@dataclass(frozen=True)
class OutputSettings:
    """
    How the output starts and stops.

    Attributes
    ----------
    state_timeout : float
        Largest age of the joint state, s.
    start_ramp, stop_ramp : float
        Durations, s.
    stop_behavior : str
        'ramp_to_zero', 'zero' (as fast as the rate limits allow, at most ZERO_WITHIN) or 'hold':
        after silence of the joint states the last command stays in force; every other stop
        ramps to zero.

    """

    state_timeout: float
    start_ramp: float
    stop_ramp: float
    stop_behavior: str


class _Ramp:
    """Progress from 0 to 1 in the time of a steady clock, without pauses of the process."""

    def __init__(self, now=0.0, duration=0.0):
        self.duration = duration
        self._time, self._elapsed = now, 0.0

    def advance(self, now):
        """Go on to a time, s; of a pause only MAX_RAMP_STEP counts."""
        self._elapsed += min(max(now - self._time, 0.0), MAX_RAMP_STEP)
        self._time = now

    @property
    def progress(self):
        """From 0 to 1."""
        return 1.0 if self._elapsed >= self.duration else self._elapsed / self.duration

    @property
    def remaining(self):
        """Time to the end, s."""
        return max(self.duration - self._elapsed, 0.0)


class EffortOutput:
    """
    State machine, ramps and limiter: what is sent for a model effort, and when nothing is.

    Every method takes the time of one steady clock. A returned command must be published, and
    then `published` be called; None means that nothing may be published.

    Attributes
    ----------
    machine : OutputStateMachine
    limiter : EffortLimiter
        Without joints until `set_limiter`.
    settings : OutputSettings

    """

    def __init__(self, settings, on_change=None):
        self.machine = OutputStateMachine(on_change)
        self.limiter = EffortLimiter(np.zeros(0), np.zeros(0), np.zeros(0))
        self.settings = settings
        self._ramp, self._change = _Ramp(), _Ramp()
        self._is_ramping = False
        self._start_from = self._stop_from = np.zeros(0)
        self._stop_within = ZERO_WITHIN
        self._difference = np.zeros(0)
        self._effort = None
        self._period = STOP_PERIOD
        self._last_time = 0.0
        self._is_first = False
        self._saturated_since = None

    @property
    def has_effort_in_force(self):
        """Whether the output is off and has left an effort at the controller."""
        return not self.machine.is_on and bool(self.limiter.last.any())

    def set_limiter(self, limiter):
        """
        Replace the limiter; the last command to the same joints stays what it is.

        Parameters
        ----------
        limiter : EffortLimiter

        """
        if limiter.names == self.limiter.names:
            limiter.carry_on_from(self.limiter)
        else:
            self._effort = None
        self.limiter = limiter

    def start(self, now, start_from, reason='enabled'):
        """
        Begin the start ramp.

        Parameters
        ----------
        now : float
            s.
        start_from : numpy.ndarray, shape (m,)
            The efforts in force now, N m or N.
        reason : str
            For people.

        """
        # All fields first: an observer of the new state finds it complete.
        self.limiter.resume(start_from)
        self._start_from = self.limiter.last
        self._difference = np.zeros(len(self._start_from))
        self._ramp, self._change = _Ramp(now, self.settings.start_ramp), _Ramp()
        self._is_ramping = True
        self._last_time = now
        self._is_first = True
        self._saturated_since = None
        self._effort = None
        if not self.machine.is_on:
            self.machine.fault = ''
        self.machine.enter(OutputState.STARTING, reason)

    def blend(self, now, difference):
        """
        Let a change of model, gains or limits go out over the start ramp.

        Parameters
        ----------
        now : float
            s.
        difference : numpy.ndarray, shape (m,)
            Target before the change minus target after it, at the same state, N m or N. What is
            left of an earlier change is added, so that many small changes lag behind and never
            add up to a step.

        """
        self._difference = self._remaining_difference() + difference
        self._change = _Ramp(now, self.settings.start_ramp)
        self._is_ramping = True
        self._effort = None  # of the model before

    def follow(self, now, effort, period):
        """
        Return the command for a model effort computed from a fresh state.

        Parameters
        ----------
        now : float
            s.
        effort : numpy.ndarray, shape (m,)
            N m or N.
        period : float
            Nominal period of the joint states, s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        """
        if not self.machine.is_driving:
            return None
        self._effort, self._period = effort, period
        return self._drive(now)

    def between(self, now):
        """
        Return the next command of a stop, or of a ramp while no new state comes.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        """
        waited = now - self._last_time
        if self.machine.state == OutputState.STOPPING and waited >= 0.5 * STOP_PERIOD:
            return self._fade(now)
        if self.machine.is_driving and waited >= 0.9 * STOP_PERIOD and not self._is_settled():
            return self._drive(now)
        return None

    def published(self, now):
        """
        Note that the last command has gone out.

        The next step is limited by the time since then, and states that promise something about
        commands (ACTIVE, READY) are entered only now.

        Parameters
        ----------
        now : float
            s.

        """
        self._last_time = now
        self._is_first = False
        if self.machine.state == OutputState.STARTING and self._is_settled():
            self.machine.enter(OutputState.ACTIVE, 'the full effort has been reached')
        elif self.machine.state == OutputState.STOPPING:
            self._end_stop()

    def stop(self, now, reason, *, is_fault=False, may_hold=False, within=None):
        """
        Begin to stop, or hasten a stop.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.
        is_fault : bool
            Whether the stop ends in FAULT.
        may_hold : bool
            Whether `settings.stop_behavior` 'hold' is obeyed.
        within : float, optional
            Longest time that the stop may take, s.

        """
        if is_fault:
            self.machine.latch(reason)
        if (
            may_hold
            and self.settings.stop_behavior == 'hold'
            and self.machine.is_driving
            and self.limiter.last.any()
        ):
            self.machine.enter(
                OutputState.HOLDING,
                f'{reason} (stop_behavior hold: the last '
                'efforts stay in force; ~/enable with false releases them)',
            )
            return
        longest = min(MAX_FAULT_RAMP if is_fault else np.inf, np.inf if within is None else within)
        if self.machine.state == OutputState.STOPPING:
            if self._ramp.remaining > longest or self._stop_within > longest:
                self._begin_fade(now, min(self._ramp.remaining, longest), longest)
        elif self.machine.is_on or self.has_effort_in_force:
            ramp = 0.0 if self.settings.stop_behavior == 'zero' else self.settings.stop_ramp
            self._begin_fade(now, min(ramp, longest), longest)
            self.machine.enter(OutputState.STOPPING, reason)
        elif is_fault:
            self.machine.enter(OutputState.FAULT, self.machine.fault)

    def abandon(self, reason):
        """
        End at once in FAULT without another command, because no controller takes it.

        The last command is kept: the hardware may hold it, and the next start begins there.

        Parameters
        ----------
        reason : str
            For people.

        """
        # Also behind a fault whose stop has been cut short: an effort may be left.
        self.machine.fault = f'{self.machine.fault}; {reason}' if self.machine.fault else reason
        self.machine.enter(OutputState.FAULT, self.machine.fault)

    def next_tick_in(self, now):
        """Return when `between` has the next command, s; infinite if it has none."""
        if self.machine.state == OutputState.STOPPING:
            return STOP_PERIOD
        if self.machine.is_driving and self._effort is not None and not self._is_settled():
            return max(self._last_time + STOP_PERIOD - now, 0.0)
        return np.inf

    def _drive(self, now):
        if self._effort is None:
            return None
        if self._is_first:
            # It repeats the efforts in force: ramp and steps count the time since a command.
            self._ramp, self._last_time = _Ramp(now, self._ramp.duration), now
        dt = now - self._last_time
        try:
            target = self.limiter.target(self._effort)
            if self._is_ramping:
                target = self._on_the_ramps(now, np.array(target)).tolist()
            command = self.limiter.step(target, min(dt, MAX_PERIODS * self._period, STOP_PERIOD))
        except InvalidEffortError as error:
            self.stop(now, f'invalid effort: {error}', is_fault=True)
            return None
        self._last_time = now
        self._watch_saturation(now)
        return command

    def _on_the_ramps(self, now, target):
        self._ramp.advance(now)
        self._change.advance(now)
        progress = self._ramp.progress
        self._is_ramping = progress < 1.0 or self._change.progress < 1.0
        return (
            progress * (target + self._remaining_difference())
            + (1.0 - progress) * self._start_from
        )

    def _remaining_difference(self):
        return (1.0 - self._change.progress) * self._difference

    def _is_settled(self):
        # The command is what the model wants: no ramp, no rate limit in between. Gravity may
        # change a hundred times a second: what is left of that is small, and never nothing.
        return (
            self._ramp.progress == 1.0
            and self._effort is not None
            and not self.limiter.is_held_back
            and self.limiter.is_negligible(self._remaining_difference())
        )

    def _begin_fade(self, now, ramp, longest):
        self._ramp = _Ramp(now, ramp)
        self._stop_from = self.limiter.last
        self._stop_within = min(max(ramp, ZERO_WITHIN), longest)
        if not self.machine.is_on:
            self._last_time = now
        self._effort = None

    def _fade(self, now):
        if self._end_stop():
            return None
        dt = now - self._last_time
        self._ramp.advance(now)
        # However small the rate limits are, or have become, the stop keeps its bound.
        least = np.abs(self._stop_from) * (
            min(max(dt, 0.0), MAX_RAMP_STEP) / max(self._stop_within, STOP_PERIOD)
        )
        target = (1.0 - self._ramp.progress) * self._stop_from
        try:
            command = self.limiter.step(target.tolist(), min(dt, MAX_STOP_STEP), least.tolist())
        except InvalidEffortError:  # limits that are no numbers: a stop has to end all the same
            self.limiter.reset()
            command = self.limiter.last
        self._last_time = now
        return command

    def _end_stop(self):
        if self._ramp.progress < 1.0 or self.limiter.last.any():
            return False
        if self.machine.fault:
            self.machine.enter(OutputState.FAULT, self.machine.fault)
        else:
            self.machine.enter(OutputState.READY, f'stopped: {self.machine.reason}')
        return True

    def _watch_saturation(self, now):
        if not self.limiter.is_saturated:
            self._saturated_since = None
        elif self._saturated_since is None:
            self._saturated_since = now
        elif now - self._saturated_since > LONGEST_SATURATION:
            self.stop(
                now,
                f'effort above its limit for {LONGEST_SATURATION:g} s: '
                f'{self.limiter.saturation()}',
                is_fault=True,
            )
