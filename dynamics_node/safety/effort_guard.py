"""The effort guard: passes commands on, and fades the last one to zero after a silence."""

from collections import Counter, deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
import logging
import math
import statistics

from .state_machine import OutputState

_log = logging.getLogger(__name__)

# Period of the commands of a fade, s.
FADE_PERIOD = 0.01
# Largest time of one step of a fade or an approach, s, after any delay.
LONGEST_STEP = 0.02
# Time between the first and the second tick of a silence, s: a command that waits in the queue
# arrives in between.
CONFIRM_AFTER = 0.002
# Longest time between two ticks, s.
MAX_TICK = 0.05
# Time without command or tick that is a standstill of the guard itself, s: twice MAX_TICK.
OWN_STALL = 0.1
# Longest fade, s, for any rate limits.
LONGEST_FADE = 10.0
# Largest distance of a command near the output or near zero, relative to the largest effort.
NEAR = 0.1
# Silence after which the next command is a new beginning, in timeouts.
REST = 2.0
# Smallest number of commands within the timeout; with fewer, one late command begins a fade.
PERIODS = 3
# Number of intervals whose median is the period of the commands.
INTERVALS = 16
# Largest number of efforts in a command; a longer array is refused unread.
MAX_JOINTS = 1000
HOW_TO_GO_ON = '. Commands pass again when they begin near zero after a rest, or after ~/reset'


@dataclass(frozen=True)
class GuardSettings:
    """
    Timing and limits of the guard.

    Attributes
    ----------
    timeout : float
        Longest time without a command while an effort is in force, s.
    stop_ramp : float
        Duration of a fade, s.
    rate_limits : tuple of float
        Largest change of effort per joint in a fade, N m/s or N/s; they make a fade longer than
        `stop_ramp` if necessary, up to `LONGEST_FADE`. Empty: no limits.
    effort_limits : tuple of float
        Largest effort per joint, N m or N. Empty: no limits.

    """

    timeout: float = 0.05
    stop_ramp: float = 1.0
    rate_limits: tuple[float, ...] = ()
    effort_limits: tuple[float, ...] = ()


class EffortGuard:
    """
    Passes commands on unchanged; after a silence, fades the last one to zero.

    Every method takes the time of one steady clock. The caller must publish the result of
    `on_command` and `tick`; None means that nothing may be published.

    READY: no effort is in force. ACTIVE: commands pass unchanged. STOPPING: the last command
    fades. FAULT: after a fade, or with commands that do not begin near zero; only zeros pass.
    STARTING: the output approaches the commands, after a standstill of the guard itself, after
    an early return of the commands during a fade, or after `reset`.

    Attributes
    ----------
    state : OutputState
    reason : str
        Cause of the state, as text.
    output : list of float
        The last returned command, N m or N; empty before the first one.
    joint_count : int or None
        Number of joints of the controller; None while unknown.
    passed : int
        Number of commands that passed.
    clamped : int
        Number of commands with an effort above `effort_limits`.
    bridged : int
        Number of silences that ended early in their fade.
    fades : int
        Number of fades.
    stalls : int
        Number of standstills of the guard itself.
    refused : Counter
        Number of commands that did not pass, by kind.

    """

    def __init__(
        self,
        settings: GuardSettings,
        on_change: Callable[[OutputState, str], None] | None = None,
        obstacle: Callable[[], str] | None = None,
    ) -> None:
        """
        Start READY.

        Parameters
        ----------
        settings : GuardSettings
        on_change : callable(OutputState, str), optional
            Called after every change of state or reason. Its exceptions are logged.
        obstacle : callable() -> str, optional
            Called before the first effort passes; returns the reason to refuse it, or ''.

        """
        self.settings = settings
        self.state = OutputState.READY
        self.reason = 'no command yet'
        self.output: list[float] = []
        self.joint_count: int | None = None
        self.passed = self.clamped = self.bridged = self.fades = self.stalls = 0
        self.refused: Counter[str] = Counter()
        self._on_change = on_change
        self._obstacle = obstacle or (lambda: '')
        self._largest: list[float] = []  # effort of each joint in the commands that passed
        self._intervals: deque[float] = deque(maxlen=INTERVALS)
        self._source_at = math.inf  # no publisher found yet
        self._received_at = -math.inf
        self._received_zero = False
        self._dropped: Counter[str] = Counter()  # since the last valid command
        self._ran_at = math.inf  # last command or tick
        self._stall = 0.0
        self._is_suspect = False
        self._is_ending = False
        self._must_approach = False
        self._fault = self._refused_kind = ''  # cause of FAULT, kind of the last reported refusal
        # Of a fade or an approach: first output, progress from 0 to 1, duration, last step, s.
        self._start: list[float] = []
        self._progress, self._duration, self._stepped_at = 0.0, 1.0, 0.0

    @property
    def has_effort(self) -> bool:
        """Whether the last returned command is not zero."""
        return any(self.output)

    @property
    def is_passing(self) -> bool:
        """Whether commands pass: ACTIVE and STARTING."""
        return self.state in (OutputState.ACTIVE, OutputState.STARTING)

    def slow_period(self) -> float | None:
        """
        Return the period of the commands if it is too long for the timeout.

        Returns
        -------
        float or None
            The median of the latest intervals, s; None if `PERIODS` of them fit into the timeout,
            or if it is unknown.

        """
        if len(self._intervals) < INTERVALS:
            return None
        period = statistics.median(self._intervals)
        return period if PERIODS * period > self.settings.timeout else None

    def source_appeared(self, now: float) -> None:
        """
        Note that a publisher of commands has been found.

        Commands right after that were sent before it was found: they do not begin near zero.

        Parameters
        ----------
        now : float
            s.

        """
        if not self.is_passing:
            self._source_at = now

    def on_command(self, now: float, efforts: Sequence[float]) -> Sequence[float] | None:
        """
        Pass, change or refuse a command.

        Parameters
        ----------
        now : float
            s.
        efforts : sequence of float
            N m or N.

        Returns
        -------
        sequence of float or None
            N m or N; `efforts` itself if it passes unchanged.

        """
        self._notice_stall(now)
        if problem := self._problem(efforts):
            self.refused[problem] += 1
            self._dropped[problem] += 1
            return None
        rest = REST * self.settings.timeout
        is_beginning = self._received_zero or now - max(self._received_at, self._source_at) >= rest
        self._measure_interval(now)
        self._received_at, self._received_zero = now, not any(efforts)
        self._is_suspect = False
        self._dropped.clear()
        if self._is_ending:
            return None
        command = self._clamp(efforts)
        if self.is_passing:
            return self._pass(now, command)
        if self.state == OutputState.STOPPING:
            return self._come_back(now, command)
        return self._begin(now, command, is_beginning)

    def tick(self, now: float) -> list[float] | None:
        """
        Check for a silence of the commands; return the next command of a fade.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        list of float or None
            N m or N.

        """
        self._notice_stall(now)
        silence = now - self._received_at
        if self.state == OutputState.STOPPING:
            return self._continue_fade(now)
        if self.is_passing and silence >= self.settings.timeout:
            if self.state == OutputState.ACTIVE and self._received_zero:
                self._enter(OutputState.READY, 'the commands have ended at zero')
            elif self._is_suspect:
                self._begin_fade(now, self._describe(silence))
            else:
                # A command may be waiting in the queue, behind this call.
                self._is_suspect = True
        elif (
            self.state == OutputState.FAULT
            and self._received_zero
            and silence >= REST * self.settings.timeout
        ):
            self._enter(OutputState.READY, 'the commands have ended at zero: armed again')
        return None

    def next_tick_in(self, now: float) -> float:
        """
        Return the time until the next call of `tick`.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        float
            s.

        """
        if self.state == OutputState.STOPPING:
            return FADE_PERIOD
        if not self.is_passing:
            return min(MAX_TICK, self.settings.timeout)
        if self._is_suspect:
            return CONFIRM_AFTER
        left = self.settings.timeout - (now - self._received_at)
        return min(MAX_TICK, max(left, CONFIRM_AFTER))

    def reset(self, now: float) -> tuple[bool, str]:
        """
        Leave FAULT: the next commands may have any size and are approached by a ramp.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        success : bool
            False if the state is not FAULT, or the guard is ending.
        message : str

        """
        if self.state != OutputState.FAULT or self._is_ending:
            return False, f'nothing to reset: {self.state.name}, {self.reason}'
        self._must_approach = True
        text = (
            f'reset: the next commands are approached from zero within '
            f'{self.settings.stop_ramp:g} s'
        )
        self._enter(OutputState.READY, text)
        return True, text

    def end(self, now: float, within: float, reason: str) -> None:
        """
        Refuse all further commands, and fade within a time, for any `rate_limits`.

        Parameters
        ----------
        now : float
            s.
        within : float
            Longest duration of the fade, s.
        reason : str
            Cause, as text.

        """
        self._is_ending = True
        if self.state == OutputState.STOPPING:
            left = self._duration * (1.0 - self._progress)
            self._begin_ramp(now, min(left, within))
            self._enter(OutputState.STOPPING, reason)
        elif self.is_passing:
            self._begin_fade(now, reason, within)

    def drop(self) -> list[float]:
        """
        Abort a fade: the output is zero at once.

        Returns
        -------
        list of float
            Zeros, to be published.

        """
        self.output = [0.0] * len(self.output)
        self._enter(OutputState.FAULT, 'the fade did not end in time: zero at once')
        return self.output

    def _problem(self, efforts: Sequence[float]) -> str:
        count = len(efforts)
        if count == 0:
            return 'empty'
        expected = self._expected_count()
        if count > MAX_JOINTS or expected not in (None, count):
            return 'length'
        return '' if all(map(math.isfinite, efforts)) else 'not finite'

    def _expected_count(self) -> int | None:
        # The number of joints may change only while no effort is in force.
        if self.output and self.state != OutputState.READY:
            return len(self.output)
        limits = self.settings.effort_limits or self.settings.rate_limits
        return len(limits) if limits else self.joint_count

    def _measure_interval(self, now: float) -> None:
        interval = now - self._received_at
        if interval < 1.0:
            self._intervals.append(interval)
        else:
            self._intervals.clear()

    def _clamp(self, efforts: Sequence[float]) -> Sequence[float]:
        limits = self.settings.effort_limits
        if not limits or all(
            abs(effort) <= limit for effort, limit in zip(efforts, limits, strict=True)
        ):
            return efforts
        self.clamped += 1
        return [
            min(max(effort, -limit), limit) for effort, limit in zip(efforts, limits, strict=True)
        ]

    # Passing ---------------------------------------------------------------------------------

    def _pass(self, now: float, command: Sequence[float]) -> Sequence[float]:
        if self._stall and not self._is_one_step(command):
            self._approach(
                now,
                self._approach_time(command),
                f'the guard itself stood still for {self._stall:.3f} s: its output '
                'approaches the commands',
            )
        self._stall = 0.0
        if self.state == OutputState.STARTING:
            self._advance(now)
            if self._progress < 1.0:
                command = [
                    start + self._progress * (effort - start)
                    for start, effort in zip(self._start, command, strict=True)
                ]
            else:
                self._enter(OutputState.ACTIVE, 'commands pass')
        return self._returned(command)

    def _returned(self, command: Sequence[float]) -> Sequence[float]:
        self.passed += 1
        self.output = list(command)
        if len(self._largest) == len(command):
            self._largest = list(map(max, self._largest, map(abs, command)))
        else:
            self._largest = list(map(abs, command))
        return command

    def _come_back(self, now: float, command: Sequence[float]) -> Sequence[float] | None:
        if any(
            distance > NEAR * scale
            for distance, scale in zip(self._distance(command), self._scale(), strict=True)
        ):
            self.refused['during a fade'] += 1
            return None
        self.bridged += 1
        self._approach(now, self._approach_time(command), 'commands came again early in the fade')
        return self._pass(now, command)

    def _begin(
        self, now: float, command: Sequence[float], is_beginning: bool
    ) -> Sequence[float] | None:
        if not any(command):
            self._must_approach = False
            if self.state == OutputState.READY:
                self._enter(OutputState.ACTIVE, 'commands pass')
            return self._returned(command)
        is_start = is_beginning and self._is_near_zero(command)
        if (is_start or self._must_approach) and (obstacle := self._obstacle()):
            self._refuse('obstacle', obstacle)
            return None
        if is_start:
            self._stall, self._must_approach = 0.0, False
            self._enter(OutputState.ACTIVE, 'commands pass')
            return self._returned(command)
        if self._must_approach:
            self._must_approach, self._stall = False, 0.0
            if len(self.output) != len(command):
                self.output = [0.0] * len(command)
            self._approach(
                now,
                max(self.settings.stop_ramp, self._approach_time(command)),
                'after ~/reset the output approaches the commands',
            )
            return self._pass(now, command)
        if is_beginning:
            self._refuse(
                'not near zero',
                f'commands begin with up to {max(map(abs, command)):.4g}, too far from zero',
            )
        else:
            self._refuse('under way', 'commands were under way before they could pass')
        return None

    def _refuse(self, kind: str, cause: str) -> None:
        self.refused[kind] += 1
        self._must_approach = False
        if self.state != OutputState.FAULT:
            self._fault, self._refused_kind = cause, kind
            self._enter(OutputState.FAULT, cause + HOW_TO_GO_ON)
        elif kind != self._refused_kind and not (self._refused_kind and kind == 'under way'):
            # Reported once per kind: the number in the text changes with every command, and the
            # commands behind the first refused one are always under way.
            self._refused_kind = kind
            self._enter(OutputState.FAULT, f'{self._fault}; {cause}{HOW_TO_GO_ON}')

    # Distances -------------------------------------------------------------------------------

    def _scale(self) -> list[float]:
        # Largest effort per joint, but at least a tenth of the largest of all joints: a joint
        # without load so far may need it.
        floor = NEAR * max(self._largest, default=0.0)
        return [max(largest, floor) for largest in self._largest]

    def _is_near_zero(self, command: Sequence[float]) -> bool:
        # Without effort limits there is no measure of size; a stream after a rest is trusted.
        scale: Sequence[float] = self.settings.effort_limits
        if self.state == OutputState.FAULT or self._must_approach:
            scale = self._scale() or scale
        elif not scale:
            return True
        return len(scale) == len(command) and all(
            abs(effort) <= NEAR * largest for effort, largest in zip(command, scale, strict=True)
        )

    def _distance(self, command: Sequence[float]) -> list[float]:
        return [abs(effort - last) for effort, last in zip(command, self.output, strict=True)]

    def _rates(self) -> Sequence[float]:
        return self.settings.rate_limits or [
            largest / self.settings.stop_ramp for largest in self._scale()
        ]

    def _is_one_step(self, command: Sequence[float]) -> bool:
        return all(
            distance <= rate * LONGEST_STEP
            for distance, rate in zip(self._distance(command), self._rates(), strict=True)
        )

    def _approach_time(self, command: Sequence[float]) -> float:
        if len(self._largest) != len(command):
            return self.settings.stop_ramp
        times = [
            distance / rate if rate > 0.0 else self.settings.stop_ramp
            for distance, rate in zip(self._distance(command), self._rates(), strict=True)
        ]
        return min(max(times), LONGEST_FADE)

    def _fade_time(self) -> float:
        longest = max(
            (
                abs(effort) / rate
                for effort, rate in zip(self.output, self.settings.rate_limits, strict=False)
            ),
            default=0.0,
        )
        return min(max(self.settings.stop_ramp, longest), LONGEST_FADE)

    # Fade and approach -----------------------------------------------------------------------

    def _approach(self, now: float, duration: float, reason: str) -> None:
        self._begin_ramp(now, duration)
        self._enter(OutputState.STARTING, reason)

    def _begin_fade(self, now: float, reason: str, within: float = math.inf) -> None:
        self.fades += 1
        self._fault, self._refused_kind = reason, ''
        self._is_suspect = False
        self._stall = 0.0
        self._begin_ramp(now, min(self._fade_time(), within))
        self._enter(OutputState.STOPPING, reason)

    def _continue_fade(self, now: float) -> list[float]:
        self._advance(now)
        self.output = [(1.0 - self._progress) * effort for effort in self._start]
        if self._progress == 1.0:
            self.output = [0.0] * len(self.output)
            # The state changes after the output, so that it is not ahead of the command.
            if self._is_ending:
                self._enter(OutputState.READY, f'faded to zero: {self.reason}')
            else:
                self._enter(OutputState.FAULT, self._fault + HOW_TO_GO_ON)
        return self.output

    def _begin_ramp(self, now: float, duration: float) -> None:
        self._start, self._progress = list(self.output), 0.0
        self._duration, self._stepped_at = max(duration, FADE_PERIOD), now

    def _advance(self, now: float) -> None:
        step = min(max(now - self._stepped_at, 0.0), LONGEST_STEP)
        self._stepped_at = now
        self._progress = min(self._progress + step / self._duration, 1.0)

    # Time ------------------------------------------------------------------------------------

    def _notice_stall(self, now: float) -> None:
        if now - self._ran_at > OWN_STALL:
            self.stalls += 1
            self._stall = now - self._ran_at
        self._ran_at = now

    def _describe(self, silence: float) -> str:
        dropped = ', '.join(f'{count} {kind}' for kind, count in self._dropped.most_common())
        return (
            f'no{" valid" if dropped else ""} command for {silence:.3f} s, timeout '
            f'{self.settings.timeout:g} s' + (f' (dropped: {dropped})' if dropped else '')
        )

    def _enter(self, state: OutputState, reason: str) -> None:
        if (state, reason) == (self.state, self.reason):
            return
        self.state, self.reason = state, reason
        if self._on_change is None:
            return
        try:
            self._on_change(state, reason)
        except Exception:
            # The observer only reports; the arm must not depend on it.
            _log.exception('the observer of the guard failed')
