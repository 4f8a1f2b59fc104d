"""The effort guard without ROS: passing, fading and the begin of commands."""

from array import array
from dataclasses import replace
import itertools
import math

from dynamics_node.safety.effort_guard import (
    CONFIRM_AFTER,
    EffortGuard,
    FADE_PERIOD,
    GuardSettings,
    LONGEST_FADE,
    LONGEST_STEP,
    MAX_TICK,
    NEAR,
    OWN_STALL,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest

SETTINGS = GuardSettings(timeout=0.05, stop_ramp=0.5)
FULL, ZERO = (40.0, -8.0, 0.5), (0.0, 0.0, 0.0)
PERIOD = 0.01


class Bench:
    """A guard with a simulated clock; all outputs are recorded."""

    def __init__(self, settings=SETTINGS, obstacle=None, is_found=True):
        self.states = []
        self.guard = EffortGuard(
            settings, lambda state, reason: self.states.append(state.name), obstacle
        )
        self.now, self.outputs, self._next_tick = 100.0, [], 0.0
        self.tick()
        if is_found:
            self.guard.source_appeared(self.now)
            self.wait(0.2)

    @property
    def state(self):
        return self.guard.state.name

    @property
    def last(self):
        return self.outputs[-1][1] if self.outputs else None

    @property
    def values(self):
        """The recorded outputs without their times."""
        return [output for _, output in self.outputs]

    def tick(self):
        self._record(self.guard.tick(self.now))
        self._next_tick = self.now + self.guard.next_tick_in(self.now)

    def send(self, *efforts):
        """Send one command; return the output."""
        return self._record(self.guard.on_command(self.now, array('d', efforts)))

    def wait(self, seconds):
        """Let time pass, with all ticks of the guard."""
        end = self.now + seconds
        while self._next_tick <= end:
            self.now = max(self.now, self._next_tick)
            self.tick()
        self.now = end

    def stream(self, seconds, efforts=FULL, period=PERIOD):
        """Send the same command for a time."""
        for _ in range(round(seconds / period)):
            self.send(*efforts)
            self.wait(period)

    def ramp(self, efforts=FULL, steps=range(1, 51)):
        """Send the start ramp of the node, or other fiftieths of the efforts."""
        for i in steps:
            self.send(*(i / 50 * effort for effort in efforts))
            self.wait(PERIOD)

    def start(self):
        self.ramp()
        assert self.state == 'ACTIVE'

    def freeze(self, seconds):
        """Let time pass while the guard stands still."""
        self.now += seconds

    def _record(self, output):
        if output is not None:
            self.outputs.append((self.now, list(output)))
        return output


@pytest.fixture
def bench():
    return Bench()


@pytest.fixture
def active(bench):
    """Return a bench whose guard passes commands; nothing recorded yet."""
    bench.start()
    bench.stream(0.2)
    bench.outputs.clear()
    return bench


@pytest.fixture
def faded(active):
    """Return a bench after a fade; nothing recorded yet."""
    active.wait(1.0)
    assert active.state == 'FAULT'
    active.outputs.clear()
    return active


def assert_faded(bench, start=FULL):
    """Check that the outputs decrease monotonically and in proportion, to zero."""
    factors = [output[0] / start[0] for output in bench.values]
    assert factors == sorted(factors, reverse=True)
    for factor, output in zip(factors, bench.values, strict=True):
        assert output == pytest.approx([factor * effort for effort in start])
    assert bench.last == list(ZERO)


def assert_no_step(bench, start, scale=FULL):
    """Check that no output is further from the one before than a step of the stop ramp."""
    for before, after in itertools.pairwise([list(start), *bench.values]):
        for a, b, largest in zip(before, after, scale, strict=True):
            most = max(abs(largest), NEAR * max(map(abs, scale)))
            assert abs(b - a) <= most * LONGEST_STEP / SETTINGS.stop_ramp + 1e-9


# Commands that pass --------------------------------------------------------------------------


def test_commands_pass_unchanged_also_with_a_step(bench):
    command = array('d', FULL)
    assert bench.guard.on_command(bench.now, command) is command
    assert bench.send(-40.0, 8.0, 0.0) is not None
    assert bench.states == ['ACTIVE']


def test_there_is_no_output_without_commands_and_they_can_begin_again(bench):
    bench.wait(1.0)
    assert bench.outputs == []
    bench.start()
    bench.send(*ZERO)
    count = len(bench.outputs)
    bench.wait(10.0)
    assert len(bench.outputs) == count
    assert bench.state == 'READY' and not bench.guard.has_effort
    assert bench.guard.fades == 0
    bench.start()
    assert bench.last == list(FULL)
    assert bench.states == ['ACTIVE', 'READY', 'ACTIVE']


def test_an_effort_above_its_limit_is_clamped():
    bench = Bench(replace(SETTINGS, effort_limits=(30.0, 10.0, 1.0)))
    bench.start()
    assert bench.last == [30.0, -8.0, 0.5]
    assert bench.guard.clamped > 0


# Silence -------------------------------------------------------------------------------------


def test_silence_fades_in_time_and_ends_in_fault(active):
    silent_since = active.now - PERIOD
    active.wait(2.0)
    assert_faded(active)
    begin, end = (active.outputs[i][0] - silent_since for i in (0, -1))
    assert SETTINGS.timeout < begin <= SETTINGS.timeout + 2 * CONFIRM_AFTER + FADE_PERIOD + 1e-6
    assert end <= SETTINGS.timeout + 2 * CONFIRM_AFTER + SETTINGS.stop_ramp + 2 * FADE_PERIOD
    assert active.state == 'FAULT'
    assert 'no command for 0.05' in active.guard.reason and '~/reset' in active.guard.reason


@pytest.mark.parametrize(
    ('bad', 'kind'),
    [
        ((), 'empty'),
        ((1.0,), 'length'),
        ((1.0,) * 4, 'length'),
        ((math.nan, 0.0, 0.0), 'not finite'),
        ((0.0, math.inf, 0.0), 'not finite'),
    ],
)
def test_an_invalid_command_counts_as_silence(active, bad, kind):
    for _ in range(100):
        assert active.send(*bad) is None
        active.wait(PERIOD)
    assert_faded(active)
    assert active.state == 'FAULT'
    assert active.guard.refused[kind] == 100
    assert 'no valid command for 0.05' in active.guard.reason and kind in active.guard.reason


def test_the_number_of_joints_of_the_controller_counts_before_the_first_command(bench):
    bench.guard.joint_count = 3
    assert bench.send(1.0, 2.0) is None
    assert bench.send(1.0, 2.0, 3.0) is not None


def test_rate_limits_make_a_fade_longer_but_not_endless():
    bench = Bench(replace(SETTINGS, rate_limits=(20.0, 100.0, 100.0)))
    bench.start()
    bench.wait(1.9)
    assert bench.guard.has_effort
    bench.wait(0.3)
    assert not bench.guard.has_effort
    steps = [b[0] - a[0] for a, b in itertools.pairwise(bench.values[50:])]
    assert min(steps) >= -20.0 * LONGEST_STEP
    slow = Bench(replace(SETTINGS, rate_limits=(1e-9,) * 3))
    slow.start()
    slow.wait(LONGEST_FADE + 0.5)
    assert not slow.guard.has_effort


def test_a_short_silence_is_bridged_without_a_step(active):
    active.wait(0.08)
    assert active.state == 'STOPPING' and active.guard.has_effort
    before = active.last
    assert active.send(*FULL) == pytest.approx(before)
    active.wait(PERIOD)
    active.stream(0.2)
    assert active.state == 'ACTIVE' and active.last == list(FULL)
    assert active.guard.bridged == 1
    assert_no_step(active, FULL)


def test_the_period_of_slow_commands_is_reported(bench):
    bench.stream(1.0, period=0.015)
    assert bench.guard.slow_period() is None
    bench.stream(1.0, period=0.02)
    assert bench.guard.slow_period() == pytest.approx(0.02)
    fast = Bench()
    fast.send(*FULL)
    assert fast.guard.slow_period() is None


def test_a_command_waiting_behind_a_late_tick_is_in_time(active):
    active.freeze(SETTINGS.timeout + 0.01)
    active.tick()
    assert active.send(*FULL) is not None
    active.wait(PERIOD)
    assert active.state == 'ACTIVE' and active.guard.fades == 0


# After a fade --------------------------------------------------------------------------------


def test_commands_that_go_on_after_a_fade_do_not_pass(faded):
    faded.stream(1.0)
    assert faded.outputs == []
    assert faded.state == 'FAULT'
    assert 'commands begin with up to 40, too far from zero' in faded.guard.reason
    assert faded.states.count('FAULT') == 2  # not repeated with every command
    # Nor does their ramp to zero, but the start after it does.
    faded.ramp(steps=range(50, -1, -1))
    assert faded.values == [list(ZERO)]
    faded.wait(0.2)
    assert faded.state == 'READY' and faded.guard.reason.endswith('armed again')
    faded.start()
    assert faded.last == list(FULL)


def test_a_new_source_that_begins_near_zero_passes(faded):
    # The node has died without sending zeros, and another one is enabled.
    faded.guard.source_appeared(faded.now)
    faded.wait(1.0)
    faded.start()
    assert faded.last == list(FULL)


def test_commands_that_go_on_late_in_a_fade_do_not_pass(active):
    active.wait(0.05 + 0.25)
    assert active.state == 'STOPPING'
    assert active.send(*FULL) is None
    active.stream(1.0)
    assert_faded(active)
    assert active.state == 'FAULT'
    assert active.guard.refused['during a fade'] > 10


def test_commands_pass_by_a_ramp_after_reset(faded):
    faded.stream(0.1)
    success, message = faded.guard.reset(faded.now)
    assert success and 'within 0.5 s' in message
    faded.stream(1.0)
    assert faded.state == 'ACTIVE' and faded.last == list(FULL)
    assert_no_step(faded, ZERO)
    efforts = [output[0] for output in faded.values]
    assert efforts == sorted(efforts)
    assert 'STARTING' in faded.states
    success, message = faded.guard.reset(faded.now)
    assert not success and 'nothing to reset: ACTIVE' in message


def test_a_silence_in_the_ramp_after_reset_cancels_the_reset(faded):
    faded.guard.reset(faded.now)
    faded.send(*FULL)
    faded.wait(3.0)
    assert faded.send(*FULL) is None
    assert faded.state == 'FAULT'


# Start of the commands -----------------------------------------------------------------------


def test_a_guard_started_after_the_commands_does_not_pass_them():
    bench = Bench(is_found=False)
    bench.stream(0.3)
    assert bench.outputs == [] and bench.state == 'FAULT'
    assert 'under way' in bench.guard.reason
    bench.guard.source_appeared(bench.now)
    bench.stream(0.3)
    assert bench.outputs == []
    bench.send(*ZERO)
    bench.wait(0.3)
    bench.start()
    assert bench.last == list(FULL)


def test_with_effort_limits_a_beginning_far_from_zero_is_refused():
    bench = Bench(replace(SETTINGS, effort_limits=(87.0, 87.0, 5.0)))
    assert bench.send(0.11 * 87.0, 0.0, 0.0) is None
    assert bench.state == 'FAULT'
    bench.wait(0.3)
    assert bench.send(0.09 * 87.0, 0.0, 0.0) is not None


def test_an_obstacle_refuses_first_efforts_but_not_zeros():
    reasons = ['nothing listens']
    bench = Bench(obstacle=lambda: reasons[0])
    assert bench.send(0.1, 0.0, 0.0) is None
    assert bench.state == 'FAULT' and bench.guard.reason.startswith('nothing listens')
    assert bench.send(*ZERO) is not None
    reasons[0] = ''
    bench.wait(0.3)
    assert bench.state == 'READY'
    bench.start()


# End and suspension of the guard -------------------------------------------------------------


@pytest.mark.parametrize('within', [2.5, 0.2])
def test_end_fades_and_refuses_all_commands(active, within):
    begin = active.now
    active.guard.end(begin, within, 'SIGTERM')
    active.tick()
    active.stream(1.0)
    assert_faded(active)
    assert not active.guard.has_effort and active.state == 'READY'
    assert active.outputs[-1][0] - begin <= min(within, SETTINGS.stop_ramp) + 2 * FADE_PERIOD


def test_a_second_end_shortens_the_fade(active):
    active.guard.end(active.now, 2.5, 'SIGINT')
    active.tick()
    active.wait(0.1)
    active.guard.end(active.now, 0.1, 'SIGINT again')
    active.wait(0.13)
    assert not active.guard.has_effort
    assert active.guard.drop() == list(ZERO)


def test_end_without_effort_has_no_effect(bench):
    bench.guard.end(bench.now, 2.5, 'SIGTERM')
    assert not bench.guard.has_effort
    assert bench.send(*FULL) is None


def test_after_a_standstill_of_the_guard_it_approaches_the_commands(active):
    active.freeze(1.0)
    other = (20.0, 8.0, 0.0)
    active.send(*other)
    assert active.state == 'STARTING' and 'stood still for 1.0' in active.guard.reason
    active.tick()
    active.stream(1.2, other)
    assert active.state == 'ACTIVE' and active.last == list(other)
    assert_no_step(active, FULL)
    assert active.guard.stalls == 1
    assert OWN_STALL >= 2 * MAX_TICK  # a tick is no standstill


def test_after_a_standstill_of_the_guard_unchanged_commands_pass(active):
    active.freeze(1.0)
    active.tick()
    active.send(*FULL)
    assert active.state == 'ACTIVE' and active.last == list(FULL)


def test_a_failing_observer_has_no_effect():
    def fail(state, reason):
        raise RuntimeError('observer')

    guard = EffortGuard(SETTINGS, fail)
    guard.source_appeared(0.0)
    assert guard.on_command(1.0, array('d', FULL)) is not None
    assert guard.state.name == 'ACTIVE'


# Random sequences ----------------------------------------------------------------------------

EFFORT = st.one_of(st.floats(-50.0, 50.0), st.just(0.0))
COMMAND = st.one_of(
    st.tuples(EFFORT, EFFORT),
    st.just((30.0, -5.0)),
    st.just((0.0, 0.0)),
    st.just((0.3, 0.0)),
    st.sampled_from([(), (1.0,), (1.0, 2.0, 3.0), (math.nan, 1.0), (1.0, math.inf)]),
)
EVENT = st.one_of(
    st.tuples(st.just('send'), COMMAND),
    st.tuples(st.just('stream'), st.tuples(COMMAND, st.integers(1, 30))),
    st.tuples(st.just('start'), st.tuples(EFFORT, EFFORT)),
    st.tuples(st.just('wait'), st.floats(0.0, 1.5)),
    st.tuples(st.just('freeze'), st.floats(0.0, 3.0)),
    st.tuples(st.just('late'), st.floats(0.0, 0.2)),
    st.tuples(st.just('reset'), st.none()),
    st.tuples(st.just('source'), st.none()),
)
LIMITS = st.one_of(st.just(()), st.just((40.0, 8.0)))
RATES = st.one_of(st.just(()), st.just((60.0, 30.0)))


class Judge(Bench):
    """Checks every output against the specification, from observable values only."""

    def __init__(self, settings):
        self.force, self.scale, self.input = [0.0, 0.0], [0.0, 0.0], None
        super().__init__(settings)
        self.guard.joint_count = 2

    def tick(self):
        before = list(self.force)
        self.input = None
        super().tick()
        # A tick never starts and never increases an effort, and its steps are small.
        ramp = self.guard.settings.stop_ramp
        for last, new, largest in zip(before, self.force, self.scale, strict=True):
            assert abs(new) <= abs(last) and new * last >= 0.0
            assert abs(new - last) <= largest * LONGEST_STEP / ramp + 1e-9

    def send(self, *efforts):
        before, was = list(self.force), self.guard.state.name
        output = super().send(*efforts)
        if output is None:
            return None
        assert len(efforts) == 2 and all(map(math.isfinite, efforts))
        limits = self.guard.settings.effort_limits or (math.inf, math.inf)
        wanted = [
            min(max(effort, -limit), limit) for effort, limit in zip(efforts, limits, strict=True)
        ]
        if list(output) != list(efforts):
            # Between the effort in force (or the first output of the approach) and the command.
            start = self.guard._start if self.guard.state.name == 'STARTING' else before
            for low, value, high in zip(start, output, wanted, strict=True):
                assert min(low, high) - 1e-9 <= value <= max(low, high) + 1e-9
        if was == 'FAULT' and any(output):
            # After a fade, commands only pass if they begin near zero.
            most = max(self.scale) or max(limits)
            assert max(map(abs, output)) <= NEAR * most + 1e-9
        self.scale = [
            max(largest, abs(effort)) for largest, effort in zip(self.scale, output, strict=True)
        ]
        return output

    def _record(self, output):
        if output is not None:
            assert all(map(math.isfinite, output))
            self.force = list(output)
        return super()._record(output)


@given(st.lists(EVENT, max_size=25), LIMITS, RATES)
def test_whatever_comes_no_effort_starts_by_itself_and_every_silence_ends_at_zero(
    events, limits, rates
):
    judge = Judge(replace(SETTINGS, effort_limits=limits, rate_limits=rates))
    actions = {
        'send': lambda value: judge.send(*value),
        'stream': lambda value: judge.stream(value[1] * PERIOD, value[0]),
        'start': judge.ramp,
        'wait': judge.wait,
        'freeze': judge.freeze,
        'late': lambda value: (judge.freeze(value), judge.tick()),
        'reset': lambda _: judge.guard.reset(judge.now),
        'source': lambda _: judge.guard.source_appeared(judge.now),
    }
    for kind, value in events:
        actions[kind](value)
    longest = max(
        [SETTINGS.stop_ramp] + [abs(effort) / rate for effort, rate in zip(judge.force, rates)]
    )
    judge.wait(SETTINGS.timeout + MAX_TICK + CONFIRM_AFTER + longest + 3 * FADE_PERIOD)
    assert judge.force == [0.0, 0.0] and not judge.guard.has_effort
    assert judge.state in ('READY', 'FAULT')
