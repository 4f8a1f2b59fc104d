"""From a message to a command, with every fault that can be dealt between them."""

import math

from dynamics_node.safety import (
    EffortOutput,
    JointStateBuffer,
    MotionLimits,
    RejectedStateError,
    StampTolerance,
    take_state,
)
from dynamics_node.safety.effort_output import OutputSettings
from hypothesis import example, given, note
from hypothesis import strategies as st
import numpy as np
import pytest

NAMES = ['elbow', 'wrist']
LIMITS, RATES = np.array([10.0, 5.0]), np.array([100.0, 50.0])
SECOND = 1_000_000_000


class Path:
    """Buffer and channel of an arm of two joints, as the node connects them."""

    def __init__(self, behavior='ramp_to_zero'):
        self.buffer = JointStateBuffer(NAMES, NAMES, np.zeros(2), MotionLimits(
            NAMES, np.full(2, 3.0), np.tile([-3.0, 3.0], (2, 1)), np.zeros(2, dtype=bool)),
            StampTolerance(0.1))
        self.channel = EffortOutput(OutputSettings(0.1, 0.5, 1.0, behavior))
        self.channel.set_limiter(LIMITS, RATES, np.ones(2), NAMES)

    def take(self, now, position, velocity=(), stamp=None, names=NAMES, clock=None):
        """Take a message, stamped when it arrives unless told otherwise; return the command."""
        clock = round((100 + now) * SECOND) if clock is None else clock
        stamp = clock if stamp is None else stamp
        if not take_state(self.buffer, self.channel, now, list(names), list(position),
                          list(velocity), stamp, clock):
            return None
        q = self.buffer.position
        return self.channel.on_effort(now, np.array([30.0 * math.cos(q[0]), 8.0 * q[1]]))

    def tick(self, now):
        return self.channel.tick(now, self.buffer.age(now))


def active():
    """Return a path that is ACTIVE at t = 1, and the state it stands at."""
    path = Path()
    state = [1.4, 0.2]
    path.take(0.0, state)
    path.channel.enable(0.0)
    for i in range(1, 101):
        path.take(i / 100, state)
    assert path.channel.machine.name == 'ACTIVE'
    return path, state


def test_a_state_is_usable_when_every_joint_is_known_and_fresh():
    path = Path()
    assert not take_state(path.buffer, path.channel, 0.0, ['elbow'], [0.0], clock=1)
    assert not take_state(path.buffer, path.channel, 0.2, ['wrist'], [0.0], clock=2)
    assert take_state(path.buffer, path.channel, 0.21, ['elbow'], [0.0], clock=3)


def test_one_jump_is_passed_over_and_three_in_a_row_stop_the_arm():
    path, (elbow, wrist) = active()
    with pytest.raises(RejectedStateError):
        path.take(1.01, [0.0, wrist])
    assert path.take(1.02, [elbow, wrist]) is not None
    for i in range(3):
        with pytest.raises(RejectedStateError):
            path.take(1.03 + 0.01 * i, [0.0, wrist])
    assert path.channel.machine.name == 'STOPPING'
    assert path.channel.machine.fault == (
        'expected a position that the joint can have reached, got elbow from 1.4 to 0 within '
        '0.030 s, at a velocity limit of 3, 3 times in a row')


def test_a_runaway_stops_the_arm_at_once():
    path, state = active()
    path.take(1.01, state, [0.0, 6.1])
    assert path.channel.machine.name == 'STOPPING'
    assert path.channel.machine.fault == ('runaway: wrist at 6.1 (limit 3), more than 2 times the '
                                          'velocity limit')


def test_a_clock_that_goes_back_drops_the_state_and_ramps_again():
    path, (elbow, wrist) = active()
    last = path.channel.limiter.last
    # A simulation begins anew: the arm stands elsewhere, and no jump is seen in that.
    command = path.take(1.01, [-elbow, -wrist], clock=3 * SECOND)
    assert path.channel.machine.name == 'STARTING'
    assert 'the clock went back by 98.000 s' in path.channel.machine.reason
    np.testing.assert_array_equal(command, last)
    for i in range(1, 60):
        command = path.take(1.01 + 0.01 * i, [-elbow, -wrist],
                            clock=3 * SECOND + i * SECOND // 100)
    assert path.channel.machine.name == 'ACTIVE'
    np.testing.assert_allclose(command, [30.0 * math.cos(elbow), -8.0 * wrist])


def test_a_clock_that_goes_back_again_and_again_is_no_sign_of_life():
    path, (elbow, _) = active()
    for i in range(1, 20):
        clock = (50 - i) * SECOND if i <= 3 else 47 * SECOND + i * SECOND // 100
        assert path.take(1.0 + 0.01 * i, [elbow], names=['elbow'], clock=clock) is None
        path.tick(1.0 + 0.01 * i)
    assert path.channel.machine.name == 'STOPPING'
    assert 'stale' in path.channel.machine.fault


def test_while_the_simulation_pauses_the_steady_clock_goes_on():
    path, state = active()
    paused = 101 * SECOND
    for i in range(1, 13):
        with pytest.raises(RejectedStateError, match='repeated'):
            path.take(1.0 + 0.01 * i, state, clock=paused)
        path.tick(1.0 + 0.01 * i)
    assert path.channel.machine.name == 'STOPPING'
    assert path.channel.machine.fault.startswith('joint_states stale: last 0.1')


def test_two_clocks_at_once_do_not_freeze_the_effort():
    path, (elbow, wrist) = active()
    for i in range(1, 40):
        path.take(1.0 + 0.01 * i, [elbow, wrist], clock=(50 - i % 2) * SECOND)
    assert path.channel.machine.name == 'STOPPING'
    assert path.channel.machine.fault.startswith('the clock went back by 1.000 s')


def test_without_a_clock_there_is_no_torque():
    path = Path()
    with pytest.raises(RejectedStateError, match='use_sim_time is true, but nothing has come'):
        path.take(0.0, [0.0, 0.0], clock=0)
    assert path.buffer.rejected == {'no clock': 1}
    assert not path.buffer.is_complete


number = st.one_of(st.floats(-3, 3), st.floats(allow_nan=True, allow_infinity=True))
MESSAGES = st.tuples(
    st.just('state'), st.lists(st.sampled_from([*NAMES, 'other']), max_size=4),
    st.lists(number, max_size=4), st.lists(number, max_size=4),
    # The stamp: none, in time, late, ahead, from anywhere.
    st.one_of(st.none(), st.floats(-0.3, 0.3), st.integers(-2**31, 2**31)))
EVENTS = st.one_of(
    MESSAGES, st.tuples(st.just('good'), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)),
    st.tuples(st.just('good'), st.floats(-0.01, 0.01), st.floats(-0.01, 0.01)),
    st.tuples(st.sampled_from(['enable', 'stop', 'fault', 'tick', 'error', 'signal'])),
    st.tuples(st.just('clock'), st.one_of(st.just(0.0), st.floats(-1e6, 1e6))))


def stamp_of(choice, clock):
    """Return the stamp that a message with this choice has, ns."""
    if choice is None:
        return 0
    return clock - round(choice * SECOND) if isinstance(choice, float) else choice * SECOND


# An arm that moves as fast as it can while ACTIVE needs a larger step than its rate limit.
SWING = [(0.0, ('good', 1.4, 0.2)), (0.0, ('enable',)), *[(0.01, ('good', 1.4, 0.2))] * 60,
         (0.01, ('good', 1.345, 0.2))]


@example(behavior='hold', events=SWING)
@given(st.sampled_from(['ramp_to_zero', 'zero', 'hold']),
       st.lists(st.tuples(st.one_of(st.just(0.01), st.floats(0, 0.5)), EVENTS), max_size=80))
def test_whatever_comes_no_command_is_wrong_and_none_comes_while_off(behavior, events):
    path = Path(behavior)
    machine = path.channel.machine
    now, offset = 0.0, 1000.0
    last, last_time = np.zeros(2), 0.0
    for step, (event, *values) in events:
        now += step
        clock = max(round((now + offset) * SECOND), 0)
        was_on, command = machine.is_on, None
        if event == 'enable':
            if path.channel.enable(now):
                last_time = now
        elif event == 'clock':
            offset += values[0]
        elif event == 'tick':
            command = path.tick(now)
        elif event in ('state', 'good'):
            names, position, velocity, stamp = (
                values if event == 'state' else (NAMES, values, [], 0.0))
            try:
                command = path.take(now, position, velocity, stamp_of(stamp, clock), names,
                                    clock)
            except RejectedStateError as error:
                note(str(error))
        else:
            path.channel.stop(now, event, is_fault=event in ('fault', 'error'),
                              within=2.5 if event == 'signal' else None)
        if command is None:
            continue
        assert was_on
        assert command.shape == (2,)
        assert np.isfinite(command).all()
        assert (np.abs(command) <= LIMITS).all()
        assert (np.abs(command - last) <= RATES * (now - last_time) * (1 + 1e-9) + 1e-12).all()
        last, last_time = command, now
    assert np.isfinite(path.buffer.position).all()
