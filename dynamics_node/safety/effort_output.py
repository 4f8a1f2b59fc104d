"""The next command: ramps, steps between joint states, and every stop to its end."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .effort_limiter import EffortLimiter
from .state_machine import OutputState, OutputStateMachine
from ..errors import InvalidEffortError

# Period of the commands of a stop, and of a ramp between two joint states, s.
STOP_PERIOD = 0.01
# Largest time of a step toward the model's effort, in nominal periods of the joint states, and at
# most STOP_PERIOD: after a gap the effort catches up over several commands.
MAX_PERIODS = 3
# Largest advance of a ramp per command, s: after a standstill of the process the ramp continues
# instead of being skipped.
MAX_RAMP_STEP = 0.1
# Largest time of a step of a stop, s, for the same reason.
MAX_STOP_STEP = 0.02
# Longest stop without a ramp, s, for any rate limits.
ZERO_WITHIN = 1.0
# Longest ramp of a stop after a fault, s.
MAX_FAULT_RAMP = 2.0
# Longest time above an effort limit, s: the arm is then not held by its limit.
LONGEST_SATURATION = 2.0
STOP_BEHAVIORS = ('ramp_to_zero', 'hold', 'zero')


@dataclass(frozen=True)
class OutputSettings:
    """
    Timing of the output, and its behavior at a stop.

    Attributes
    ----------
    state_timeout : float
        Largest age of the joint state, s.
    start_ramp, stop_ramp : float
        Durations, s.
    stop_behavior : str
        'ramp_to_zero'; 'zero': as fast as the rate limits allow, at most ZERO_WITHIN; or 'hold':
        without fresh joint states the last command stays in force, every other stop ramps to
        zero.

    """

    state_timeout: float
    start_ramp: float
    stop_ramp: float
    stop_behavior: str


class _Ramp:
    """Progress from 0 to 1 over a duration, s; standstills of the process do not count."""

    def __init__(self, now: float = 0.0, duration: float = 0.0) -> None:
        self.duration = duration
        self._time, self._elapsed = now, 0.0

    def advance(self, now: float) -> None:
        """Advance to a time, s, by at most MAX_RAMP_STEP."""
        self._elapsed += min(max(now - self._time, 0.0), MAX_RAMP_STEP)
        self._time = now

    @property
    def progress(self) -> float:
        """From 0 to 1."""
        return 1.0 if self._elapsed >= self.duration else self._elapsed / self.duration

    @property
    def remaining(self) -> float:
        """Time to the end, s."""
        return max(self.duration - self._elapsed, 0.0)


class EffortOutput:
    """
    State machine, ramps and limiter: from model efforts to commands.

    Every method takes the time of one steady clock. The caller must publish a returned command
    and then call `published`; None means that nothing may be published.

    Attributes
    ----------
    machine : OutputStateMachine
    limiter : EffortLimiter
        Without joints until `set_limiter`.
    settings : OutputSettings

    """

    def __init__(
        self, settings: OutputSettings, on_change: Callable[[OutputState, str], None] | None = None
    ) -> None:
        self.machine = OutputStateMachine(on_change)
        self.limiter = EffortLimiter(np.zeros(0), np.zeros(0), np.zeros(0))
        self.settings = settings
        self._ramp, self._change = _Ramp(), _Ramp()
        self._is_ramping = False
        self._start_from = self._stop_from = np.zeros(0)
        self._stop_within = ZERO_WITHIN
        self._difference = np.zeros(0)
        self._effort: NDArray[np.float64] | None = None
        self._period = STOP_PERIOD
        self._last_time = 0.0
        self._is_first = False
        self._saturated_since: float | None = None

    @property
    def has_effort_in_force(self) -> bool:
        """Whether the output is off and its last command was not zero."""
        return not self.machine.is_on and bool(self.limiter.last.any())

    def set_limiter(self, limiter: EffortLimiter) -> None:
        """
        Replace the limiter; the last command to the same joints is kept.

        Parameters
        ----------
        limiter : EffortLimiter

        """
        if limiter.names == self.limiter.names:
            limiter.carry_on_from(self.limiter)
        else:
            self._effort = None
        self.limiter = limiter

    def start(self, now: float, start_from: NDArray[np.float64], reason: str = 'enabled') -> None:
        """
        Begin the start ramp.

        Parameters
        ----------
        now : float
            s.
        start_from : numpy.ndarray, shape (m,)
            The efforts in force, N m or N.
        reason : str
            Cause, as text.

        """
        # All fields before the state: its observer finds them complete.
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

    def blend(self, now: float, difference: NDArray[np.float64]) -> None:
        """
        Spread a change of model, gains, offsets or limits over the start ramp.

        Parameters
        ----------
        now : float
            s.
        difference : numpy.ndarray, shape (m,)
            Target before the change minus target after it, at the same state, N m or N. The rest
            of an earlier change is added, so that many small changes never add up to a step.

        """
        self._difference = self._remaining_difference() + difference
        self._change = _Ramp(now, self.settings.start_ramp)
        self._is_ramping = True
        self._effort = None  # computed with the previous model

    def follow(
        self, now: float, effort: NDArray[np.float64], period: float
    ) -> NDArray[np.float64] | None:
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
            N m or N.

        """
        if not self.machine.is_driving:
            return None
        self._effort, self._period = effort, period
        return self._drive(now)

    def between(self, now: float) -> NDArray[np.float64] | None:
        """
        Return the next command of a stop, or of a ramp between two joint states.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None
            N m or N.

        """
        waited = now - self._last_time
        if self.machine.state == OutputState.STOPPING and waited >= 0.5 * STOP_PERIOD:
            return self._fade(now)
        if self.machine.is_driving and waited >= 0.9 * STOP_PERIOD and not self._is_settled():
            return self._drive(now)
        return None

    def published(self, now: float) -> None:
        """
        Note that the last command is published.

        The next step is limited by the time since then. ACTIVE and READY, which tell the user
        about commands, are entered only now.

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

    def stop(
        self,
        now: float,
        reason: str,
        *,
        is_fault: bool = False,
        may_hold: bool = False,
        within: float | None = None,
    ) -> None:
        """
        Begin a stop, or shorten it.

        Parameters
        ----------
        now : float
            s.
        reason : str
            Cause, as text.
        is_fault : bool
            Whether the stop ends in FAULT.
        may_hold : bool
            Whether `settings.stop_behavior` 'hold' applies.
        within : float, optional
            Longest duration of the stop, s.

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

    def abandon(self, reason: str) -> None:
        """
        End at once in FAULT without another command, because no controller takes it.

        The last command is kept: the hardware may hold it, and the next start begins there.

        Parameters
        ----------
        reason : str
            Cause, as text.

        """
        # Appended to an earlier fault, whose stop is cut short here: an effort may be left.
        self.machine.fault = f'{self.machine.fault}; {reason}' if self.machine.fault else reason
        self.machine.enter(OutputState.FAULT, self.machine.fault)

    def next_tick_in(self, now: float) -> float:
        """Return the time until the next command of `between`, s; infinite without one."""
        if self.machine.state == OutputState.STOPPING:
            return STOP_PERIOD
        if self.machine.is_driving and self._effort is not None and not self._is_settled():
            return max(self._last_time + STOP_PERIOD - now, 0.0)
        return np.inf

    def _drive(self, now: float) -> NDArray[np.float64] | None:
        if self._effort is None:
            return None
        if self._is_first:
            # The first command repeats the efforts in force; ramp and steps begin here.
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

    def _on_the_ramps(self, now: float, target: NDArray[np.float64]) -> NDArray[np.float64]:
        self._ramp.advance(now)
        self._change.advance(now)
        progress = self._ramp.progress
        self._is_ramping = progress < 1.0 or self._change.progress < 1.0
        return (
            progress * (target + self._remaining_difference())
            + (1.0 - progress) * self._start_from
        )

    def _remaining_difference(self) -> NDArray[np.float64]:
        return (1.0 - self._change.progress) * self._difference

    def _is_settled(self) -> bool:
        # The command is the model's effort, without ramp or rate limit. Gravity may change 100
        # times a second: the rest of that is negligible, but never zero.
        return (
            self._ramp.progress == 1.0
            and self._effort is not None
            and not self.limiter.is_held_back
            and self.limiter.is_negligible(self._remaining_difference())
        )

    def _begin_fade(self, now: float, ramp: float, longest: float) -> None:
        self._ramp = _Ramp(now, ramp)
        self._stop_from = self.limiter.last
        self._stop_within = min(max(ramp, ZERO_WITHIN), longest)
        if not self.machine.is_on:
            self._last_time = now
        self._effort = None

    def _fade(self, now: float) -> NDArray[np.float64] | None:
        if self._end_stop():
            return None
        dt = now - self._last_time
        self._ramp.advance(now)
        # Smallest steps with which the stop keeps its bound, for any rate limits.
        least = np.abs(self._stop_from) * (
            min(max(dt, 0.0), MAX_RAMP_STEP) / max(self._stop_within, STOP_PERIOD)
        )
        target = (1.0 - self._ramp.progress) * self._stop_from
        try:
            command = self.limiter.step(target.tolist(), min(dt, MAX_STOP_STEP), least.tolist())
        except InvalidEffortError:  # limits that are not finite: the stop ends at once
            self.limiter.reset()
            command = self.limiter.last
        self._last_time = now
        return command

    def _end_stop(self) -> bool:
        if self._ramp.progress < 1.0 or self.limiter.last.any():
            return False
        if self.machine.fault:
            self.machine.enter(OutputState.FAULT, self.machine.fault)
        else:
            self.machine.enter(OutputState.READY, f'stopped: {self.machine.reason}')
        return True

    def _watch_saturation(self, now: float) -> None:
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
