"""The output as a whole, with a clock that the test turns."""

import math

from dynamics_node.safety import EffortOutput
from dynamics_node.safety.effort_output import (
    LONGEST_SATURATION,
    MAX_RESTARTS,
    OutputSettings,
    SHORTEST_LOOK,
    STOP_STEP,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

LIMITS, RATES = np.array([10.0, 5.0]), np.array([100.0, 50.0])
TORQUE = np.array([4.0, -2.0])


def channel(stop_behavior='ramp_to_zero', limits=LIMITS, **changes):
    settings = {'state_timeout': 0.1, 'start_ramp': 0.5, 'stop_ramp': 1.0, **changes}
    unit = EffortOutput(OutputSettings(stop_behavior=stop_behavior, **settings))
    unit.set_limiter(limits, RATES, np.ones(2))
    return unit


def active(**options):
    """Return a channel that is ACTIVE at t = 1 with the whole torque out."""
    unit = channel(**options)
    unit.enable(0.0)
    for now in np.arange(0.0, 1.001, 0.01):
        unit.on_effort(now, TORQUE)
    assert unit.machine.name == 'ACTIVE'
    np.testing.assert_array_equal(unit.limiter.last, TORQUE)
    return unit


def stopped(unit, now):
    """Tick until nothing more comes; return the commands."""
    commands = []
    while (command := unit.tick(now, 0.0)) is not None:
        commands.append(command)
        now += 0.01
        assert len(commands) < 500
    return np.array(commands)


def test_nothing_goes_out_while_off():
    unit = channel()
    assert unit.on_effort(0.0, TORQUE) is None
    assert unit.tick(0.0, math.inf) is None
    assert unit.machine.name == 'READY'


def test_the_start_ramps_from_zero_to_the_torque():
    unit = channel()
    unit.enable(0.0)
    np.testing.assert_array_equal(unit.on_effort(0.0, TORQUE), [0, 0])
    np.testing.assert_allclose(unit.on_effort(0.25, TORQUE), TORQUE / 2)
    np.testing.assert_allclose(unit.on_effort(0.5, TORQUE), TORQUE)
    assert unit.machine.name == 'ACTIVE'


def test_the_rate_limit_counts_from_when_the_last_command_went_out():
    unit = channel(start_ramp=0.0)
    unit.enable(0.0)
    np.testing.assert_allclose(unit.on_effort(0.01, TORQUE), [1.0, -0.5])
    unit.published(0.018)
    np.testing.assert_allclose(unit.on_effort(0.02, TORQUE), [1.2, -0.6])
    unit.published(0.03)
    unit.stop(0.03, 'disabled on request')
    unit.tick(0.03, 0.0)
    np.testing.assert_allclose(unit.limiter.last, [1.2, -0.6])


def test_a_stop_ramps_to_zero_and_ends_with_zeros():
    unit = active()
    unit.stop(1.0, 'disabled on request')
    assert unit.on_effort(1.0, TORQUE) is None
    commands = stopped(unit, 1.0)
    np.testing.assert_allclose(commands[50], TORQUE / 2, rtol=0.03)
    np.testing.assert_array_equal(commands[-1], [0, 0])
    assert unit.machine.name == 'READY'


def test_zero_stops_as_fast_as_the_rate_limits_allow():
    unit = active(stop_behavior='zero')
    unit.stop(1.0, 'disabled on request')
    commands = stopped(unit, 1.01)
    np.testing.assert_allclose(commands[0], [3.0, -1.5])
    np.testing.assert_array_equal(commands[-1], [0, 0])
    assert len(commands) <= 6


def test_hold_leaves_the_last_command_in_force():
    unit = active(stop_behavior='hold')
    unit.stop(1.0, 'disabled on request')
    assert len(stopped(unit, 1.0)) == 0
    np.testing.assert_array_equal(unit.limiter.last, TORQUE)
    assert unit.machine.name == 'READY'
    assert 'the last efforts stay in force' in unit.machine.reason


def test_enabling_after_hold_starts_from_what_was_held():
    unit = active(stop_behavior='hold')
    unit.stop(1.0, 'disabled on request')
    stopped(unit, 1.0)
    unit.enable(5.0)
    np.testing.assert_allclose(unit.on_effort(5.0, TORQUE / 2), TORQUE)
    np.testing.assert_allclose(unit.on_effort(5.25, TORQUE / 2), 0.75 * TORQUE)
    np.testing.assert_allclose(unit.on_effort(5.5, TORQUE / 2), TORQUE / 2)


def test_what_was_held_belongs_to_its_joints():
    unit = active(stop_behavior='hold')
    unit.stop(1.0, 'disabled on request')
    stopped(unit, 1.0)
    unit.set_limiter(LIMITS, RATES, np.ones(2), ('of another', 'robot'))
    unit.enable(5.0)
    np.testing.assert_array_equal(unit.on_effort(5.0, TORQUE), [0, 0])


def test_a_stale_state_stops_and_latches_with_both_numbers():
    unit = active()
    assert unit.tick(1.05, 0.05) is None
    unit.tick(1.134, 0.134)
    assert unit.machine.name == 'STOPPING'
    stopped(unit, 1.14)
    assert (unit.machine.name, unit.machine.reason) == (
        'FAULT', 'joint_states stale: last 0.134 s ago, limit 0.100 s')


def test_an_effort_that_is_not_finite_stops_from_the_last_valid_one():
    unit = active()
    assert unit.on_effort(1.01, np.array([np.nan, 0.0])) is None
    commands = stopped(unit, 1.01)
    np.testing.assert_allclose(commands[0], TORQUE, rtol=0.02)
    assert unit.machine.name == 'FAULT'
    assert 'invalid effort' in unit.machine.reason


def test_a_stop_is_bounded_when_the_process_has_to_end():
    unit = active(stop_ramp=60.0)
    unit.stop(1.0, 'SIGINT', within=2.5)
    assert len(stopped(unit, 1.0)) <= 252
    unit = active(stop_ramp=60.0)
    unit.stop(1.0, 'disabled on request')
    unit.tick(2.0, 0.0)
    unit.stop(2.0, 'SIGINT', within=2.5)
    assert len(stopped(unit, 2.0)) <= 252


def test_a_stop_during_the_start_begins_from_what_was_reached():
    unit = channel()
    unit.enable(0.0)
    unit.on_effort(0.0, TORQUE)
    reached = unit.on_effort(0.1, TORQUE)
    unit.stop(0.1, 'disabled on request')
    assert (np.abs(stopped(unit, 0.1)) <= np.abs(reached) + 1e-12).all()


def test_enabling_again_starts_from_zero():
    unit = active()
    unit.stop(1.0, 'disabled on request')
    assert not unit.enable(1.1)
    stopped(unit, 1.1)
    assert unit.enable(5.0)
    np.testing.assert_array_equal(unit.on_effort(5.0, TORQUE), [0, 0])


def test_new_limits_while_active_are_approached_at_the_rate():
    unit = active()
    unit.set_limiter(LIMITS / 5, RATES, np.ones(2))
    np.testing.assert_allclose(unit.on_effort(1.01, TORQUE), [3.0, -1.5])
    np.testing.assert_allclose(unit.on_effort(1.02, TORQUE), [2.0, -1.0])
    np.testing.assert_allclose(unit.on_effort(1.10, TORQUE), LIMITS / 5 * [1, -1])
    unit.set_limiter(LIMITS, RATES, np.ones(2))
    np.testing.assert_allclose(unit.on_effort(1.11, TORQUE), [3.0, -1.5])


def test_limits_that_are_no_numbers_cannot_keep_a_stop_from_ending():
    unit = active()
    unit.set_limiter(np.full(2, np.nan), np.full(2, np.nan), np.ones(2))
    assert unit.on_effort(1.01, TORQUE) is None
    commands = stopped(unit, 1.01)
    np.testing.assert_array_equal(commands[-1], [0, 0])
    assert unit.machine.name == 'FAULT'


EVENTS = st.one_of(
    st.just(('enable',)), st.just(('stop',)), st.just(('fault',)),
    st.tuples(st.just('tick'), st.floats(0, 0.2)),
    st.tuples(st.just('limits'), st.floats(0.05, 1.0)),
    st.tuples(st.just('effort'), st.floats(allow_nan=True), st.floats(allow_nan=True)))


@given(st.sampled_from(['ramp_to_zero', 'zero', 'hold']),
       st.lists(st.tuples(st.floats(0, 0.5), EVENTS), max_size=60))
def test_no_sequence_of_events_publishes_what_must_not_be_published(behavior, events):
    unit = channel(stop_behavior=behavior)
    now, last, last_time = 0.0, np.zeros(2), 0.0
    for step, (event, *values) in events:
        now += step
        command = None
        if event == 'enable':
            if unit.enable(now):
                last_time = now
        elif event in ('stop', 'fault'):
            unit.stop(now, event, is_fault=event == 'fault')
        elif event == 'limits':
            unit.set_limiter(LIMITS * values[0], RATES, np.ones(2))
        elif event == 'tick':
            was_on = unit.machine.is_on
            command = unit.tick(now, values[0])
            assert command is None or was_on
        else:
            was_driving = unit.machine.is_driving
            command = unit.on_effort(now, np.array(values))
            assert command is None or was_driving
        if command is not None:
            assert command.shape == (2,)
            assert np.isfinite(command).all()
            assert (np.abs(command) <= LIMITS).all()
            allowed = RATES * (now - last_time) * (1 + 1e-9) + 1e-12
            assert (np.abs(command - last) <= allowed).all()
            last, last_time = command, now


def test_the_next_look_is_when_the_newest_state_becomes_stale_or_a_stop_goes_on():
    unit = active(state_timeout=0.1)
    assert unit.next_look(0.03) == pytest.approx(0.07)
    assert unit.next_look(0.1) == SHORTEST_LOOK
    assert unit.next_look(math.inf) == SHORTEST_LOOK
    unit.stop(1.1, 'on request')
    assert unit.next_look(0.03) == STOP_STEP


def test_a_restart_goes_from_the_last_command_to_the_new_torque_by_the_start_ramp():
    unit = active()
    unit.restart(1.0, 'the clock went back')
    assert unit.machine.name == 'STARTING'
    np.testing.assert_allclose(unit.on_effort(1.0, -TORQUE), TORQUE)
    np.testing.assert_allclose(unit.on_effort(1.25, -TORQUE), 0.0 * TORQUE, atol=1e-12)
    np.testing.assert_allclose(unit.on_effort(1.5, -TORQUE), -TORQUE)
    assert unit.machine.name == 'ACTIVE'


def test_restarts_that_let_no_start_end_are_a_fault():
    unit, now = active(), 1.0

    def restart(times, pause):
        nonlocal now
        for _ in range(times):
            unit.restart(now, 'the clock went back')
            for step in np.arange(0.0, pause, 0.01):
                unit.on_effort(now + step, -TORQUE)
            now += pause
    restart(2 * MAX_RESTARTS, 0.6)
    assert unit.machine.name == 'ACTIVE'
    restart(MAX_RESTARTS, 0.1)
    assert unit.machine.name == 'STARTING'
    restart(1, 0.1)
    assert unit.machine.name == 'STOPPING'
    assert unit.machine.fault == ('the clock went back, 4 times before the start ramp was over')
    stopped(unit, now)
    assert unit.enable(now + 2.0)
    unit.restart(now + 2.0, 'the clock went back')
    assert unit.machine.name == 'STARTING'


def test_a_fault_of_the_arm_stops_an_output_that_is_on_and_only_that():
    unit = channel()
    unit.fault(0.0, 'runaway')
    assert unit.machine.name == 'READY'
    unit = active()
    unit.fault(1.0, 'runaway')
    assert unit.machine.name == 'STOPPING'
    stopped(unit, 1.0)
    assert (unit.machine.name, unit.machine.reason) == ('FAULT', 'runaway')
    # While it stops on request, a fault latches too.
    unit = active()
    unit.stop(1.0, 'disabled on request')
    unit.fault(1.1, 'runaway')
    stopped(unit, 1.1)
    assert unit.machine.name == 'FAULT'


def test_an_effort_above_its_limit_for_too_long_is_a_fault_and_a_moment_is_not():
    too_much = np.array([40.0, 0.0])

    def run(unit, start, seconds, effort):
        for now in start + np.arange(0.0, seconds, 0.01):
            unit.on_effort(now, effort)
        return start + seconds
    unit = active()
    now = run(unit, 1.01, LONGEST_SATURATION - 0.1, too_much)
    now = run(unit, now, 0.05, TORQUE)
    now = run(unit, now, LONGEST_SATURATION - 0.1, too_much)
    assert unit.machine.name == 'ACTIVE'
    run(unit, now, 0.2, too_much)
    assert unit.machine.name == 'STOPPING'
    assert unit.machine.reason == 'effort above its limit for 2 s: joint 0: 40 limited to 10'
    assert unit.machine.fault


def test_an_arm_that_must_not_be_driven_is_not_held_either():
    unit = active(stop_behavior='hold')
    unit.fault(1.0, 'runaway')
    np.testing.assert_array_equal(stopped(unit, 1.0)[-1], [0, 0])
    assert (unit.machine.name, unit.machine.reason) == ('FAULT', 'runaway')


def test_a_fault_takes_away_what_a_stop_has_just_begun_to_hold():
    unit = active(stop_behavior='hold')
    unit.stop(1.0, 'disabled on request')
    unit.fault(1.005, 'runaway')
    np.testing.assert_array_equal(stopped(unit, 1.01)[-1], [0, 0])
    assert (unit.machine.name, unit.machine.reason) == ('FAULT', 'runaway')
