"""The effort guard: passes commands on, and fades them to zero when no more commands come."""

from collections import Counter, deque
from dataclasses import dataclass
import logging
import math
import statistics

from .state_machine import OutputState

_log = logging.getLogger(__name__)

# How often a fade sends its next command, s.
FADE_PERIOD = 0.01
# No step of the guard's own is larger than what this time allows, however late it comes, s.
LONGEST_STEP = 0.02
# A command that waits in the queue is taken before the second look at a silence, s later.
CONFIRM_AFTER = 0.002
# The longest time between two looks, s.
LOOK_EVERY = 0.05
# A guard that looks at nothing for so long stood still itself, s: twice LOOK_EVERY.
OWN_STALL = 0.1
# Low rate limits do not make a fade longer than this, s.
LONGEST_FADE = 10.0
# The part of the largest effort within which a command is near the output.
NEAR = 0.1
# Timeouts without a command that make a rest: the next command begins anew.
REST = 2.0
# Commands that must fit into the timeout, or a late one begins a fade.
PERIODS = 3
# Number of intervals whose median is the period of the commands.
INTERVALS = 16
# An array with more efforts than any arm has joints is not looked through.
MAX_JOINTS = 1000
HOW_TO_GO_ON = '. Commands pass again when they begin near zero after a rest, or after ~/reset'


@dataclass(frozen=True)
class GuardSettings:
    """
    How the guard fades.

    Attributes
    ----------
    timeout : float
        Longest time without a command while an effort is in force, s.
    stop_ramp : float
        Duration of a fade, s.
    rate_limits : tuple of float
        Largest change of effort per joint in a fade, N m/s or N/s; a fade takes longer than
        `stop_ramp` where they require it, `LONGEST_FADE` at most. Empty: none.
    effort_limits : tuple of float
        Largest effort per joint, N m or N. Empty: none.

    """

    timeout: float = 0.05
    stop_ramp: float = 1.0
    rate_limits: tuple = ()
    effort_limits: tuple = ()


class EffortGuard:
    """
    Passes commands on unchanged; when they cease, fades the last one to zero.

    Every method takes the time of one steady clock. What `on_command` and `look` return must be
    published; None means that nothing may be.

    READY: no effort is in force. ACTIVE: commands pass unchanged. STOPPING: the last command
    fades. FAULT: faded, or commands that do not begin near zero; nothing but zeros passes.
    STARTING: the output approaches the commands, because the guard itself stood still, because
    they came again early in a fade, or after `reset`.

    Attributes
    ----------
    state : OutputState
    reason : str
        Why the state is what it is, for people.
    output : list of float
        The last command that was returned; empty before the first one.
    joint_count : int or None
        How many efforts the controller takes; None while unknown.
    passed, clamped, bridged, fades, stalls : int
        Commands that passed, commands with an effort above `effort_limits`, silences that ended
        early in their fade, fades, and standstills of the guard itself.
    refused : Counter
        Commands that did not pass, by kind.

    """

    def __init__(self, settings, on_change=None, obstacle=None):
        """
        Start READY.

        Parameters
        ----------
        settings : GuardSettings
        on_change : callable(OutputState, str), optional
            Called after every change of state or reason. An exception in it is logged.
        obstacle : callable() -> str, optional
            Called when an effort is about to begin: why it must not; '' if it may.

        """
        self.settings = settings
        self.state = OutputState.READY
        self.reason = 'no command yet'
        self.output: list[float] = []
        self.joint_count = None
        self.passed = self.clamped = self.bridged = self.fades = self.stalls = 0
        self.refused: Counter[str] = Counter()
        self._on_change = on_change
        self._obstacle = obstacle or (lambda: '')
        self._largest: list[float] = []  # effort of each joint that has passed so far
        self._intervals: deque[float] = deque(maxlen=INTERVALS)
        self._source_at = math.inf  # no source has been there for any time
        self._heard_at = -math.inf
        self._heard_zero = False
        self._dropped: Counter[str] = Counter()  # since the last valid command
        self._looked_at = math.inf
        self._stall = 0.0
        self._is_suspect = False
        self._is_ending = False
        self._must_approach = False
        self._fault = self._told = ''  # why it is FAULT, and the kind of the refusal told
        # Of a fade or an approach: where it began, how much of it is done.
        self._start: list[float] = []
        self._done, self._duration, self._stepped_at = 0.0, 1.0, 0.0

    @property
    def has_effort(self):
        """Whether the last command that was returned is not zero."""
        return any(self.output)

    @property
    def is_passing(self):
        """Whether commands pass: ACTIVE and STARTING."""
        return self.state in (OutputState.ACTIVE, OutputState.STARTING)

    def slow_period(self):
        """
        Return the period of commands that come too slowly for the timeout.

        Returns
        -------
        float or None
            The median of the latest periods, s; None while `PERIODS` of them fit into the
            timeout, and while it is unknown.

        """
        if len(self._intervals) < INTERVALS:
            return None
        period = statistics.median(self._intervals)
        return period if PERIODS * period > self.settings.timeout else None

    def source_appeared(self, now):
        """
        Take note that a publisher of commands has been found.

        If commands come right after it, they were under way before, and do not begin near zero.

        Parameters
        ----------
        now : float
            s.

        """
        if not self.is_passing:
            self._source_at = now

    def on_command(self, now, efforts):
        """
        Take a command.

        Parameters
        ----------
        now : float
            s.
        efforts : sequence of float
            N m or N.

        Returns
        -------
        sequence of float or None
            `efforts` itself where it passes unchanged.

        """
        self._notice_stall(now)
        if problem := self._problem(efforts):
            self.refused[problem] += 1
            self._dropped[problem] += 1
            return None
        rest = REST * self.settings.timeout
        is_beginning = self._heard_zero or now - max(self._heard_at, self._source_at) >= rest
        self._measure(now)
        self._heard_at, self._heard_zero = now, not any(efforts)
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

    def look(self, now):
        """
        Look whether commands still come, and walk a fade to its end.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        list of float or None

        """
        self._notice_stall(now)
        silence = now - self._heard_at
        if self.state == OutputState.STOPPING:
            return self._fade_on(now)
        if self.is_passing and silence >= self.settings.timeout:
            if self.state == OutputState.ACTIVE and self._heard_zero:
                self._enter(OutputState.READY, 'the commands have ended at zero')
            elif self._is_suspect:
                self._begin_fade(now, self._describe(silence))
            else:
                # A command may be waiting in the queue, behind this call.
                self._is_suspect = True
        elif (
            self.state == OutputState.FAULT
            and self._heard_zero
            and silence >= REST * self.settings.timeout
        ):
            self._enter(OutputState.READY, 'the commands have ended at zero: armed again')
        return None

    def next_look(self, now):
        """
        Return in how many seconds `look` has to be called next.

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
            return min(LOOK_EVERY, self.settings.timeout)
        if self._is_suspect:
            return CONFIRM_AFTER
        left = self.settings.timeout - (now - self._heard_at)
        return min(LOOK_EVERY, max(left, CONFIRM_AFTER))

    def reset(self, now):
        """
        Leave FAULT: the next commands are taken whatever they are, and approached by a ramp.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        success : bool
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

    def end(self, now, within, reason):
        """
        Take no more commands, and fade within a time, whatever `rate_limits` are.

        Parameters
        ----------
        now : float
            s.
        within : float
            s.
        reason : str
            For people.

        """
        self._is_ending = True
        if self.state == OutputState.STOPPING:
            left = self._duration * (1.0 - self._done)
            self._walk(now, min(left, within))
            self._enter(OutputState.STOPPING, reason)
        elif self.is_passing:
            self._begin_fade(now, reason, within)

    def drop(self):
        """
        Give up a fade: the output is zero at once.

        Returns
        -------
        list of float
            Zeros, to be published.

        """
        self.output = [0.0] * len(self.output)
        self._enter(OutputState.FAULT, 'the fade did not end in time: zero at once')
        return self.output

    def _problem(self, efforts):
        count = len(efforts)
        if count == 0:
            return 'empty'
        expected = self._expected_count()
        if count > MAX_JOINTS or expected not in (None, count):
            return 'length'
        return '' if all(map(math.isfinite, efforts)) else 'not finite'

    def _expected_count(self):
        # Only at rest commands may have begun to drive other joints.
        if self.output and self.state != OutputState.READY:
            return len(self.output)
        limits = self.settings.effort_limits or self.settings.rate_limits
        return len(limits) if limits else self.joint_count

    def _measure(self, now):
        interval = now - self._heard_at
        if interval < 1.0:
            self._intervals.append(interval)
        else:
            self._intervals.clear()

    def _clamp(self, efforts):
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

    def _pass(self, now, command):
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
            if self._done < 1.0:
                command = [
                    start + self._done * (effort - start)
                    for start, effort in zip(self._start, command, strict=True)
                ]
            else:
                self._enter(OutputState.ACTIVE, 'commands pass')
        return self._returned(command)

    def _returned(self, command):
        self.passed += 1
        self.output = list(command)
        if len(self._largest) == len(command):
            self._largest = list(map(max, self._largest, map(abs, command)))
        else:
            self._largest = list(map(abs, command))
        return command

    def _come_back(self, now, command):
        if any(
            distance > NEAR * scale
            for distance, scale in zip(self._distance(command), self._scale(), strict=True)
        ):
            self.refused['during a fade'] += 1
            return None
        self.bridged += 1
        self._approach(now, self._approach_time(command), 'commands came again early in the fade')
        return self._pass(now, command)

    def _begin(self, now, command, is_beginning):
        if not any(command):
            self._must_approach = False
            if self.state == OutputState.READY:
                self._enter(OutputState.ACTIVE, 'commands pass')
            return self._returned(command)
        is_start = is_beginning and self._is_near_zero(command)
        if (is_start or self._must_approach) and (obstacle := self._obstacle()):
            return self._refuse('obstacle', obstacle)
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
        if not is_beginning:
            return self._refuse('under way', 'commands were under way before they could pass')
        return self._refuse(
            'not near zero',
            f'commands begin with up to {max(map(abs, command)):.4g}, too far from zero',
        )

    def _refuse(self, kind, why):
        self.refused[kind] += 1
        self._must_approach = False
        if self.state != OutputState.FAULT:
            self._fault, self._told = why, kind
            self._enter(OutputState.FAULT, why + HOW_TO_GO_ON)
        elif kind != self._told and not (self._told and kind == 'under way'):
            # Once: its number changes with every command, and those that follow the first one
            # of a stream are under way.
            self._told = kind
            self._enter(OutputState.FAULT, f'{self._fault}; {why}{HOW_TO_GO_ON}')

    # Distances -------------------------------------------------------------------------------

    def _scale(self):
        # Per joint, but not less than a tenth of the largest of all: a joint that carried
        # nothing so far may have to.
        floor = NEAR * max(self._largest, default=0.0)
        return [max(largest, floor) for largest in self._largest]

    def _is_near_zero(self, command):
        # Without a limit nothing says what is large, and a stream after a rest is trusted.
        scale = self.settings.effort_limits
        if self.state == OutputState.FAULT or self._must_approach:
            scale = self._scale() or scale
        elif not scale:
            return True
        return len(scale) == len(command) and all(
            abs(effort) <= NEAR * most for effort, most in zip(command, scale, strict=True)
        )

    def _distance(self, command):
        return [abs(effort - last) for effort, last in zip(command, self.output, strict=True)]

    def _rates(self):
        return self.settings.rate_limits or [
            most / self.settings.stop_ramp for most in self._scale()
        ]

    def _is_one_step(self, command):
        return all(
            distance <= rate * LONGEST_STEP
            for distance, rate in zip(self._distance(command), self._rates(), strict=True)
        )

    def _approach_time(self, command):
        if len(self._largest) != len(command):
            return self.settings.stop_ramp
        times = [
            distance / rate if rate > 0.0 else self.settings.stop_ramp
            for distance, rate in zip(self._distance(command), self._rates(), strict=True)
        ]
        return min(max(times), LONGEST_FADE)

    def _fade_time(self):
        longest = max(
            (
                abs(effort) / rate
                for effort, rate in zip(self.output, self.settings.rate_limits, strict=False)
            ),
            default=0.0,
        )
        return min(max(self.settings.stop_ramp, longest), LONGEST_FADE)

    # Ways to zero and back -------------------------------------------------------------------

    def _approach(self, now, duration, reason):
        self._walk(now, duration)
        self._enter(OutputState.STARTING, reason)

    def _begin_fade(self, now, reason, within=math.inf):
        self.fades += 1
        self._fault, self._told = reason, ''
        self._is_suspect = False
        self._stall = 0.0
        self._walk(now, min(self._fade_time(), within))
        self._enter(OutputState.STOPPING, reason)

    def _fade_on(self, now):
        self._advance(now)
        self.output = [(1.0 - self._done) * effort for effort in self._start]
        if self._done == 1.0:
            self.output = [0.0] * len(self.output)
            # After the command, so that the state is not ahead of it.
            if self._is_ending:
                self._enter(OutputState.READY, f'faded to zero: {self.reason}')
            else:
                self._enter(OutputState.FAULT, self._fault + HOW_TO_GO_ON)
        return self.output

    def _walk(self, now, duration):
        self._start, self._done = list(self.output), 0.0
        self._duration, self._stepped_at = max(duration, FADE_PERIOD), now

    def _advance(self, now):
        step = min(max(now - self._stepped_at, 0.0), LONGEST_STEP)
        self._stepped_at = now
        self._done = min(self._done + step / self._duration, 1.0)

    # Time ------------------------------------------------------------------------------------

    def _notice_stall(self, now):
        if now - self._looked_at > OWN_STALL:
            self.stalls += 1
            self._stall = now - self._looked_at
        self._looked_at = now

    def _describe(self, silence):
        dropped = ', '.join(f'{count} {kind}' for kind, count in self._dropped.most_common())
        return (
            f'no{" valid" if dropped else ""} command for {silence:.3f} s, timeout '
            f'{self.settings.timeout:g} s' + (f' (dropped: {dropped})' if dropped else '')
        )

    def _enter(self, state, reason):
        if (state, reason) == (self.state, self.reason):
            return
        self.state, self.reason = state, reason
        if self._on_change is None:
            return
        try:
            self._on_change(state, reason)
        except Exception:
            # The observer informs people; the arm must not depend on that.
            _log.exception('the observer of the guard failed')
