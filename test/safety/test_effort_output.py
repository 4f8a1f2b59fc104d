"""Ramps, steps and stops, with a simulated clock."""

from dynamics_node.safety import EffortLimiter, EffortOutput, OutputSettings
from dynamics_node.safety.effort_output import (
    LONGEST_SATURATION,
    MAX_FAULT_RAMP,
    MAX_PERIODS,
    MAX_RAMP_STEP,
    STOP_PERIOD,
    ZERO_WITHIN,
)
import numpy as np
import pytest

LIMITS, RATES = np.array([10.0, 5.0]), np.array([100.0, 50.0])
TORQUE, UNKNOWN = np.array([4.0, -2.0]), np.full(2, np.nan)
PERIOD = 0.01


class Bench:
    """An output and the loop around it: states every PERIOD, ticks, and the sent commands."""

    def __init__(self, stop_behavior='ramp_to_zero', limits=LIMITS, rates=RATES, **changes):
        settings = {'state_timeout': 0.1, 'start_ramp': 0.5, 'stop_ramp': 1.0, **changes}
        self.states = []
        self.output = EffortOutput(
            OutputSettings(stop_behavior=stop_behavior, **settings),
            lambda state, reason: self.states.append(
                (state.name, self.sent[-1].tolist() if self.sent else None)
            ),
        )
        self.output.set_limiter(EffortLimiter(limits, rates, np.ones(2)))
        self.now, self.sent, self.times = 0.0, [], []

    def _publish(self, command):
        if command is not None:
            self.sent.append(command)
            self.times.append(self.now)
            self.output.published(self.now)
        return command

    def start(self):
        self.output.start(self.now, self.output.limiter.last)
        return self

    def follow(self, effort=TORQUE, seconds=0.0, period=PERIOD):
        """Process states for some time, at least one."""
        end = self.now + seconds
        while True:
            self.now += period
            command = self._publish(self.output.follow(self.now, np.array(effort), period))
            if self.now >= end - 1e-9:
                return command

    def tick(self, seconds, period=STOP_PERIOD):
        """Tick for some time; return the sent commands."""
        begin, end = len(self.sent), self.now + seconds
        while self.now < end - 1e-9:
            self.now += period
            self._publish(self.output.between(self.now))
        return np.array(self.sent[begin:])

    def active(self):
        """Return self, ACTIVE with the full torque."""
        self.start().follow(seconds=1.0)
        assert self.name == 'ACTIVE'
        np.testing.assert_array_equal(self.sent[-1], TORQUE)
        return self

    @property
    def name(self):
        return self.output.machine.name


def test_the_start_ramps_from_zero_to_the_torque():
    bench = Bench().start()
    bench.follow(seconds=0.25)
    np.testing.assert_allclose(bench.sent[-1], 0.5 * TORQUE, rtol=0.05)
    bench.follow(seconds=0.3)
    np.testing.assert_array_equal(bench.sent[-1], TORQUE)
    assert [name for name, _ in bench.states] == ['STARTING', 'ACTIVE']


def test_the_first_command_repeats_the_efforts_in_force_and_steps_count_from_it():
    bench = Bench(start_ramp=0.0).start()
    bench.now += 0.5  # from the start to the first state
    np.testing.assert_array_equal(bench.follow(), [0.0, 0.0])
    np.testing.assert_allclose(bench.follow(period=0.004), 0.004 * RATES * [1.0, -1.0])


def test_a_stop_before_the_first_command_ends():
    bench = Bench().start()
    bench.output.stop(bench.now, 'disabled')
    bench.tick(1.5)
    assert bench.name == 'READY'


def test_active_is_entered_after_the_full_effort_is_published():
    # Rate limits so small that the effort is far from full at the end of the ramp.
    bench = Bench(rates=np.array([2.0, 2.0])).start()
    bench.follow(seconds=1.0)
    assert bench.name == 'STARTING'
    assert abs(bench.sent[-1][0]) < 0.6 * TORQUE[0]
    bench.follow(seconds=1.5)
    assert bench.states[-1] == ('ACTIVE', TORQUE.tolist())


def test_a_slow_stream_of_states_does_not_skip_the_ramp():
    # States once a second; in between the ramp continues by ticks.
    bench = Bench(state_timeout=2.0).start()
    bench.follow(period=1.0)
    bench.tick(0.99)
    bench.follow(period=0.01)
    steps = np.abs(np.diff([np.zeros(2), *bench.sent], axis=0))
    assert (steps <= RATES * STOP_PERIOD + 1e-12).all()
    np.testing.assert_array_equal(bench.sent[-1], TORQUE)
    assert len(bench.sent) > 40


def test_a_step_is_limited_by_nominal_periods_and_not_by_the_length_of_a_gap():
    bench = Bench().active()
    bench.now += 0.099 - 0.002
    bench.follow(-TORQUE, period=0.002)  # the first state after the gap has the other sign
    step = np.abs(bench.sent[-1] - bench.sent[-2])
    np.testing.assert_allclose(step, RATES * MAX_PERIODS * 0.002)


@pytest.mark.parametrize('is_stopping', [False, True], ids=['start', 'stop'])
def test_a_pause_of_the_process_does_not_skip_a_ramp(is_stopping):
    bench = Bench().active() if is_stopping else Bench().start()
    bench.follow()
    if is_stopping:
        bench.output.stop(bench.now, 'test')
        bench.tick(0.05)
    bench.now += 5.0
    before = bench.sent[-1]
    bench.tick(STOP_PERIOD) if is_stopping else bench.follow()
    assert (np.abs(bench.sent[-1] - before) <= 2.1 * MAX_RAMP_STEP * np.abs(TORQUE)).all()


def test_a_stop_ramps_to_zero_and_ends_with_zeros():
    bench = Bench().active()
    bench.output.stop(bench.now, 'disabled on request')
    commands = bench.tick(1.5)
    np.testing.assert_array_equal(commands[-1], [0.0, 0.0])
    assert (np.diff(np.abs(commands[:, 0])) <= 0).all()
    assert len(commands) * STOP_PERIOD == pytest.approx(1.0, abs=0.03)
    assert bench.states[-1] == ('READY', [0.0, 0.0])
    assert bench.output.machine.reason == 'stopped: disabled on request'


@pytest.mark.parametrize(
    'limits, rates',
    [(LIMITS, RATES), (LIMITS, np.full(2, 1e-6)), (LIMITS / 100, RATES / 100), (UNKNOWN, UNKNOWN)],
    ids=['limits', 'small rates', 'lower limits', 'nan'],
)
@pytest.mark.parametrize(
    'behavior, ramp', [('zero', 60.0), ('ramp_to_zero', 0.0), ('ramp_to_zero', 0.3)]
)
@pytest.mark.parametrize('is_fault', [False, True], ids=['disabled', 'fault'])
def test_every_stop_ends_in_time_for_any_limits(behavior, ramp, limits, rates, is_fault):
    bench = Bench(behavior, stop_ramp=ramp).active()
    bench.output.set_limiter(EffortLimiter(limits, rates, np.ones(2)))
    bench.output.stop(bench.now, 'test', is_fault=is_fault)
    bench.tick(ZERO_WITHIN + 0.05)
    assert bench.name == ('FAULT' if is_fault else 'READY')
    np.testing.assert_array_equal(bench.sent[-1], [0.0, 0.0])


def test_a_fault_has_a_short_ramp_and_shortens_a_long_one():
    bench = Bench(stop_ramp=60.0).active()
    bench.output.stop(bench.now, 'disabled')
    bench.tick(5.0)
    assert abs(bench.sent[-1][0]) > 0.9 * TORQUE[0]
    bench.output.stop(bench.now, 'runaway', is_fault=True)
    bench.tick(MAX_FAULT_RAMP + 0.05)
    assert bench.name == 'FAULT'
    assert bench.output.machine.reason == 'runaway'


def test_a_second_stop_can_only_shorten_the_first():
    bench = Bench(stop_ramp=60.0).active()
    bench.output.stop(bench.now, 'SIGTERM', within=2.5)
    bench.tick(0.5)
    bench.output.stop(bench.now, 'SIGTERM', within=0.3)
    bench.output.stop(bench.now, 'SIGTERM', within=2.5)
    bench.tick(0.35)
    assert bench.name == 'READY'
    np.testing.assert_array_equal(bench.sent[-1], [0.0, 0.0])


@pytest.fixture
def holding():
    bench = Bench('hold').active()
    count = len(bench.sent)
    bench.output.stop(bench.now, 'stale', is_fault=True, may_hold=True)
    assert bench.name == 'HOLDING'
    assert bench.output.has_effort_in_force
    assert bench.tick(0.5).size == 0
    assert len(bench.sent) == count
    return bench


def test_held_efforts_are_released_by_the_stop_ramp_and_the_fault_stays(holding):
    holding.output.stop(holding.now, 'disabled on request')
    commands = holding.tick(1.1)
    assert (np.abs(np.diff(commands[:, 0])) <= 0.05 * TORQUE[0]).all()
    assert holding.name == 'FAULT'
    assert not holding.output.has_effort_in_force


def test_a_start_after_hold_begins_at_the_held_efforts(holding):
    holding.now += 4.0
    holding.start().follow()
    np.testing.assert_allclose(holding.sent[-1], TORQUE)
    holding.follow(seconds=0.6)
    assert holding.name == 'ACTIVE'
    assert holding.output.machine.fault == ''


def test_held_efforts_belong_to_their_joints(holding):
    holding.output.set_limiter(EffortLimiter(LIMITS, RATES, np.ones(2), ('other', 'joints')))
    np.testing.assert_array_equal(holding.output.limiter.last, [0.0, 0.0])


def test_an_effort_that_is_not_finite_stops_from_the_last_valid_one():
    bench = Bench().active()
    assert bench.follow([np.nan, 0.0]) is None
    assert bench.name == 'STOPPING'
    commands = bench.tick(1.1)
    np.testing.assert_allclose(commands[0], TORQUE, rtol=0.05)
    assert bench.name == 'FAULT'
    assert 'invalid effort: expected finite efforts' in bench.output.machine.reason


def test_a_change_goes_out_over_the_start_ramp_while_the_arm_is_followed():
    bench = Bench().active()
    bench.output.blend(bench.now, TORQUE - 2.0 * TORQUE)  # a payload: from now on twice the torque
    begin = len(bench.sent)
    bench.follow(2.0 * TORQUE, seconds=0.25)
    np.testing.assert_allclose(bench.sent[-1], 1.5 * TORQUE, rtol=0.05)
    bench.follow(2.0 * TORQUE, seconds=0.3)
    np.testing.assert_array_equal(bench.sent[-1], 2.0 * TORQUE)
    steps = np.abs(np.diff(np.array(bench.sent[begin - 1 :]), axis=0))
    assert (steps <= 1.05 * np.abs(TORQUE) * PERIOD / 0.5 + 1e-12).all()
    assert bench.name == 'ACTIVE'


def test_many_small_changes_never_add_up_to_a_step():
    bench = Bench().active()
    total = 1.0
    for _ in range(100):
        total += 0.01
        bench.output.blend(bench.now, -0.01 * TORQUE)
        bench.follow(total * TORQUE)
    steps = np.abs(np.diff(np.array(bench.sent[-101:]), axis=0))
    assert (steps <= 0.0101 * np.abs(TORQUE)).all()
    assert 1.3 < bench.sent[-1][0] / TORQUE[0] < 2.0  # it lags by the ramp
    bench.follow(total * TORQUE, seconds=0.6)
    np.testing.assert_allclose(bench.sent[-1], total * TORQUE)


def test_a_change_during_the_start_has_its_own_ramp():
    bench = Bench().start()
    bench.follow(seconds=0.45)
    bench.output.blend(bench.now, TORQUE - 2.0 * TORQUE)
    begin = len(bench.sent)
    bench.follow(2.0 * TORQUE, seconds=0.6)
    steps = np.abs(np.diff(np.array(bench.sent[begin - 1 :]), axis=0))
    assert (steps <= 2.2 * np.abs(TORQUE) * PERIOD / 0.5).all()
    assert bench.states[-1][0] == 'ACTIVE'
    np.testing.assert_allclose(bench.sent[-1], 2.0 * TORQUE)


def test_endless_small_changes_do_not_delay_active():
    bench = Bench().start()
    for _ in range(100):
        bench.output.blend(bench.now, np.full(2, 1e-4))
        bench.follow()
    assert bench.name == 'ACTIVE'


def test_an_effort_above_its_limit_for_too_long_is_a_fault_and_a_moment_is_not():
    bench = Bench().active()
    bench.follow(3.0 * TORQUE, seconds=LONGEST_SATURATION - 0.1)
    bench.follow(TORQUE)
    bench.follow(3.0 * TORQUE, seconds=LONGEST_SATURATION - 0.1)
    assert bench.name == 'ACTIVE'
    bench.follow(3.0 * TORQUE, seconds=0.3)
    assert bench.name == 'STOPPING'
    assert bench.output.machine.fault == (
        'effort above its limit for 2 s: joint 0: 12 limited to 10; joint 1: -6 limited to 5'
    )


def test_a_lost_controller_ends_the_output_and_its_last_efforts_are_kept():
    bench = Bench().active()
    count = len(bench.sent)
    bench.output.abandon('controller deactivated')
    assert bench.name == 'FAULT'
    assert bench.tick(0.5).size == 0
    assert len(bench.sent) == count
    assert bench.output.has_effort_in_force
    np.testing.assert_array_equal(bench.output.limiter.last, TORQUE)


def test_a_fault_while_off_latches_at_once():
    bench = Bench()
    bench.output.stop(0.0, 'internal error', is_fault=True)
    assert bench.name == 'FAULT'
    bench.start()
    assert bench.output.machine.fault == ''


def test_the_next_tick_is_that_of_a_ramp_or_none():
    bench = Bench()
    assert bench.output.next_tick_in(0.0) == np.inf
    bench.start()
    assert bench.output.next_tick_in(bench.now) == np.inf  # no state yet, so no effort
    bench.follow()
    assert bench.output.next_tick_in(bench.now) == pytest.approx(STOP_PERIOD)
    bench.follow(seconds=1.0)
    assert bench.output.next_tick_in(bench.now) == np.inf
    bench.output.stop(bench.now, 'test')
    assert bench.output.next_tick_in(bench.now) == STOP_PERIOD
