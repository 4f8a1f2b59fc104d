"""From a joint state to a command, with random faults in between."""

import math

from dynamics_node.safety import (
    EffortLimiter,
    JointStateBuffer,
    MotionLimits,
    OutputSettings,
    RejectedStateError,
    StampTolerance,
    TorquePath,
)
from dynamics_node.safety.effort_output import STOP_PERIOD
from dynamics_node.safety.torque_path import MAX_MONITOR_AGE
from hypothesis import example, given, note
from hypothesis import strategies as st
import numpy as np
import pytest

NAMES = ['elbow', 'wrist']
LIMITS, RATES = np.array([10.0, 5.0]), np.array([100.0, 50.0])
SECOND = 1_000_000_000
BEHAVIORS = ['ramp_to_zero', 'zero', 'hold']


class Model:
    """A compensation: G of an arm with a gain, as `dynamics.Compensation` returns it."""

    needs_velocity = True

    def __init__(self, gain=1.0):
        self.gain = gain

    def torques(self, q, qd):
        effort = self.gain * np.array([30.0 * math.cos(q[0]), 8.0 * q[1]])
        return effort, effort


class Arm:
    """A torque path with an arm of two joints, and a caller that publishes its commands."""

    def __init__(self, behavior='ramp_to_zero', timeout=0.1, velocity=3.0, rates=RATES):
        self.path = TorquePath(
            self.settings(behavior, timeout), lambda state, reason: self.states.append(state.name)
        )
        self.states, self.sent = [], []
        self.rates = rates
        self.behavior, self.timeout = behavior, timeout
        self.limits = MotionLimits(
            NAMES, np.full(2, velocity), np.tile([-3.0, 3.0], (2, 1)), np.zeros(2, dtype=bool)
        )
        self.path.use(
            JointStateBuffer(NAMES, NAMES, np.zeros(2), self.limits, StampTolerance(timeout))
        )
        self.configure()

    @staticmethod
    def settings(behavior, timeout):
        return OutputSettings(timeout, 0.5, 1.0, behavior)

    def configure(self, gain=1.0, limits=LIMITS, now=0.0):
        self.path.configure(
            now,
            self.settings(self.behavior, self.timeout),
            Model(gain),
            EffortLimiter(limits, self.rates, np.ones(2), NAMES),
            self.limits,
        )

    def publish(self, now, command):
        if command is not None:
            self.sent.append(command)
            self.path.published(now)
        return command

    def take(self, now, position, velocity=(), stamp=None, names=NAMES, clock=None, efforts=()):
        """Process a message, stamped at its arrival by default; return the command."""
        clock = round((100 + now) * SECOND) if clock is None else clock
        stamp = clock if stamp is None else stamp
        return self.publish(
            now,
            self.path.process_joint_state(
                now, list(names), list(position), list(velocity), stamp, clock, list(efforts)
            ),
        )

    def tick(self, now):
        self.path.monitored(now)
        return self.publish(now, self.path.tick(now))

    def run(self, now, seconds, position, period=0.01, clock=None, **message):
        """Process states and tick for some time; return the time. clock: of the i-th state, ns."""
        for i in range(1, round(seconds / period) + 1):
            now += period
            self.take(now, position, clock=clock and clock(i), **message)
            self.tick(now)
        return now

    @property
    def name(self):
        return self.path.state.name

    @property
    def fault(self):
        return self.path.output.machine.fault


def active(**options):
    """Return an arm that is ACTIVE at t = 1, and its joint state."""
    arm, state = Arm(**options), [1.4, 0.2]
    arm.take(0.0, state)
    assert arm.path.enable(0.0)
    assert arm.run(0.0, 1.0, state) == pytest.approx(1.0)
    assert arm.name == 'ACTIVE'
    return arm, state


def test_a_state_is_usable_when_every_joint_is_known_and_fresh():
    arm = Arm()
    arm.take(0.0, [0.0], names=['elbow'])
    assert not arm.path.is_usable
    arm.take(0.2, [0.0], names=['wrist'])
    assert not arm.path.is_usable
    arm.take(0.21, [0.0], names=['elbow'])
    assert arm.path.is_usable
    np.testing.assert_allclose(arm.path.gravity_torque, [30.0, 0.0])


def test_the_age_of_a_delayed_state_counts_from_its_stamp():
    arm = Arm(timeout=0.02)
    late = round((100 + 0.5 - 0.09) * SECOND)
    arm.take(0.5, [1.4, 0.2], stamp=late)
    assert not arm.path.is_usable
    assert arm.path.buffer.age(0.5) == pytest.approx(0.09)
    arm.take(0.6, [1.4, 0.2], stamp=round((100 + 0.6 + 0.05) * SECOND))  # ahead: arrival counts
    assert arm.path.is_usable
    assert arm.path.buffer.age(0.6) == 0.0


def test_one_jump_is_ignored_and_three_in_a_row_stop_the_arm():
    arm, (elbow, wrist) = active()
    with pytest.raises(RejectedStateError):
        arm.take(1.01, [0.0, wrist])
    assert arm.take(1.02, [elbow, wrist]) is not None
    for i in range(3):
        with pytest.raises(RejectedStateError):
            arm.take(1.03 + 0.01 * i, [0.0, wrist])
    assert arm.name == 'STOPPING'
    assert arm.fault == (
        'expected a position that the joint can have reached, got elbow from 1.4 to 0 within '
        '0.030 s, at a velocity limit of 3, 3 times in a row'
    )


def test_an_arm_above_its_velocity_limits_stops_at_once():
    arm, state = active()
    arm.take(1.01, state, [0.0, 2.9])
    assert arm.name == 'ACTIVE'
    arm.take(1.02, state, [0.0, 3.1])
    assert arm.name == 'STOPPING'
    assert arm.fault == 'runaway: wrist at 3.1 (limit 3), above velocity_limits'


def test_stale_joint_states_stop_by_the_ramp_with_both_numbers():
    arm, state = active()
    arm.take(1.01, state)
    assert arm.path.next_tick_in(1.04) == pytest.approx(0.07)  # when it becomes stale
    arm.tick(1.10)
    assert arm.name == 'ACTIVE'
    arm.tick(1.12)
    assert arm.fault == 'joint_states stale: last 0.110 s ago, limit 0.100 s'
    assert arm.name == 'STOPPING'
    assert arm.path.next_tick_in(1.12) == STOP_PERIOD


@pytest.mark.parametrize(
    ('cause', 'state'),
    [
        (lambda arm, _: arm.tick(1.2), 'HOLDING'),
        (lambda arm, state: arm.take(1.01, state, [0.0, 4.0]), 'STOPPING'),
        (lambda arm, _: arm.path.disable(1.01, 'request'), 'STOPPING'),
        (lambda arm, _: arm.path.fault(1.01, 'conflicting publisher'), 'STOPPING'),
        (lambda arm, _: arm.path.fail(1.01, 'error'), 'STOPPING'),
        (lambda arm, _: arm.path.close(1.01, 'SIGTERM', 2.5), 'STOPPING'),
    ],
    ids=['stale', 'runaway', 'disable', 'fault', 'error', 'signal'],
)
def test_only_stale_joint_states_lead_to_hold(cause, state):
    arm, position = active(behavior='hold')
    cause(arm, position)
    assert arm.name == state


def test_saturation_is_not_held():
    arm, state = active(behavior='hold')
    arm.configure(gain=10.0, now=1.0)
    arm.run(1.0, 4.0, state)
    assert arm.fault.startswith('effort above its limit for 2 s')
    assert arm.name == 'FAULT'
    np.testing.assert_array_equal(arm.sent[-1], [0.0, 0.0])


@pytest.mark.parametrize(
    'release',
    [
        lambda arm, _: arm.path.disable(1.3, 'disabled on request'),
        lambda arm, state: arm.take(1.3, state, [0.0, 3.5]),
    ],
    ids=['disable', 'runaway'],
)
def test_disable_and_a_runaway_release_the_held_efforts(release):
    arm, state = active(behavior='hold')
    arm.tick(1.2)
    assert arm.name == 'HOLDING'
    release(arm, state)
    assert arm.name == 'STOPPING'
    for i in range(120):
        arm.tick(1.3 + 0.01 * i)
    np.testing.assert_array_equal(arm.sent[-1], [0.0, 0.0])
    assert not arm.path.disable(3.0, 'again')


def test_enable_starts_from_the_held_efforts_unless_the_measured_ones_differ():
    for efforts, begins_at in ((), 5.0), ([5.0, 1.5], 5.0), ([0.01, 0.0], 0.0):
        arm, state = active(behavior='hold')
        held = arm.path.output.limiter.last
        arm.tick(1.2)
        arm.take(1.5, state, efforts=efforts)
        assert arm.path.enable(1.5)
        first = arm.take(1.51, state, efforts=efforts)
        np.testing.assert_allclose(first, held if begins_at else np.zeros(2), atol=0.15)


@pytest.mark.parametrize('gap', [0.11, 1.0, 60.0])
def test_a_process_that_stood_still_is_a_fault_although_the_newest_state_is_fresh(gap):
    arm, (elbow, wrist) = active()
    command = arm.take(1.0 + gap, [elbow - 0.1, wrist])
    assert arm.name == 'STOPPING'
    assert arm.fault.startswith(f'the node itself stood still for {gap:.3f} s, limit 0.100 s')
    assert command is None


def test_a_delayed_command_is_not_sent():
    arm, _state = active()
    sent = arm.path.output.limiter.last
    command = arm.path.process_joint_state(
        1.01, NAMES, [1.39, 0.2], stamp=round(101.01 * SECOND), clock=round(101.01 * SECOND)
    )
    assert command is not None
    assert arm.path.is_timely(1.02)
    assert not arm.path.is_timely(2.0)
    np.testing.assert_array_equal(arm.path.output.limiter.last, sent)  # the command in force
    assert arm.name == 'STOPPING'


@pytest.mark.parametrize(
    ('missing', 'reason'),
    [
        ('search', 'the search for other publishers and controllers has not run'),
        ('watchdog', 'the watchdog has not run for'),
    ],
)
def test_a_search_or_a_watchdog_that_no_longer_runs_is_a_fault(missing, reason):
    arm, state = active()
    for now in 1.0 + 0.01 * np.arange(1, round((MAX_MONITOR_AGE + 0.4) / 0.01)):
        arm.take(now, state)
        if missing == 'search':
            arm.publish(now, arm.path.tick(now))
        else:
            arm.path.monitored(now)
    assert arm.fault.startswith(reason)


@pytest.mark.parametrize(
    ('change', 'between', 'end'),
    [
        # compensate.gravity switched off
        ({'gain': 0.0}, (2.4, 2.7), [0.0, 0.0]),
        ({'limits': np.array([1.0, 1.0])}, (2.0, 4.5), [1.0, 1.0]),
    ],
    ids=['model', 'limits'],
)
def test_a_change_goes_out_over_the_start_ramp(change, between, end):
    arm, state = active()
    arm.configure(**change, now=1.0)
    arm.run(1.0, 0.25, state)
    assert between[0] < arm.sent[-1][0] < between[1]
    arm.run(1.25, 0.3, state)
    np.testing.assert_allclose(arm.sent[-1], end)
    assert arm.states == ['STARTING', 'ACTIVE']


def test_the_same_parameters_again_change_nothing():
    arm, state = active()
    last = arm.sent[-1]
    for i in range(50):
        arm.configure()
        np.testing.assert_array_equal(arm.take(1.01 + 0.01 * i, state), last)
        arm.tick(1.01 + 0.01 * i)


def test_a_second_close_shortens_the_stop_and_the_output_cannot_start_after_it():
    arm, state = active()
    arm.path.close(1.0, 'SIGINT', 2.5)
    now = arm.run(1.0, 0.2, state)
    arm.path.close(now, 'SIGINT', 0.3)
    now = arm.run(now, 0.4, state)
    assert arm.name == 'READY'
    assert not arm.path.enable(now)
    assert arm.name == 'READY'


@pytest.mark.parametrize('held', [True, False], ids=['held', 'set to zero'])
def test_after_a_deactivation_the_next_start_begins_at_the_efforts_in_force(held):
    arm, state = active()
    last = arm.sent[-1]
    in_force = last if held else np.zeros(2)
    arm.path.lose_controller(1.01, '/effort_controller is inactive')
    assert arm.name == 'FAULT'
    assert arm.fault == (
        '/effort_controller is inactive; the last efforts sent, which the '
        'hardware may hold: elbow: 5.09901, wrist: 1.6'
    )
    assert arm.run(1.01, 0.5, state, efforts=in_force) and arm.sent[-1] is last
    assert arm.path.enable(1.6)
    first = arm.take(1.61, state, efforts=in_force)
    np.testing.assert_allclose(first, in_force, atol=0.0 if held else 0.2)


def test_a_controller_lost_during_the_stop_of_a_fault_is_named_after_the_fault():
    arm, _ = active()
    arm.path.fault(1.01, '2 publishers')
    arm.path.lose_controller(1.02, '/effort_controller no longer listens')
    assert arm.name == 'FAULT'
    assert arm.fault.startswith(
        '2 publishers; /effort_controller no longer listens; the last '
        'efforts sent, which the hardware may hold: elbow: '
    )


def test_restart_from_zero_ramps_for_a_new_controller():
    arm, state = active()
    arm.path.restart_from_zero(1.01, 'a controller has begun to listen')
    assert arm.name == 'STARTING'
    assert np.abs(arm.take(1.02, state)).max() < 0.2


def test_a_clock_that_goes_back_drops_the_state_and_ramps_again():
    arm, (elbow, wrist) = active()
    last = arm.path.output.limiter.last
    # A simulation restarts with the arm elsewhere: this is no jump.
    elsewhere = [-elbow, -wrist]
    command = arm.take(1.01, elsewhere, clock=3 * SECOND)
    assert arm.name == 'STARTING'
    assert 'the clock went back by 98.000 s' in arm.path.output.machine.reason
    np.testing.assert_array_equal(command, last)
    arm.run(1.01, 0.69, elsewhere, clock=lambda i: 3 * SECOND + i * SECOND // 100)
    assert arm.name == 'ACTIVE'
    np.testing.assert_allclose(arm.sent[-1], [30.0 * math.cos(elbow), -8.0 * wrist])


def test_repeated_clock_resets_are_no_fresh_measurement():
    arm, (elbow, _) = active()
    sent = len(arm.sent)

    def clock(i):
        return (50 - i) * SECOND if i <= 3 else 47 * SECOND + i * SECOND // 100

    arm.run(1.0, 0.08, [elbow], names=['elbow'], clock=clock)
    assert len(arm.sent) == sent
    arm.run(1.08, 0.11, [elbow], names=['elbow'], clock=lambda i: clock(i + 8))
    assert arm.name == 'STOPPING'
    assert 'stale' in arm.fault


def test_while_the_simulation_pauses_the_steady_clock_goes_on():
    arm, state = active()
    paused = 101 * SECOND
    for i in range(1, 13):
        with pytest.raises(RejectedStateError, match='repeated'):
            arm.take(1.0 + 0.01 * i, state, clock=paused)
        arm.tick(1.0 + 0.01 * i)
    assert arm.name == 'STOPPING'
    assert arm.fault.startswith('joint_states stale: last 0.1')


def test_two_alternating_clocks_do_not_freeze_the_effort():
    arm, state = active()
    arm.run(1.0, 0.39, state, clock=lambda i: (50 - i % 2) * SECOND)
    assert arm.name == 'STOPPING'
    assert arm.fault.startswith('the clock went back by 1.000 s')


def test_without_a_clock_there_is_no_torque():
    arm = Arm()
    with pytest.raises(RejectedStateError, match='use_sim_time is true, but nothing has come'):
        arm.take(0.0, [0.0, 0.0], clock=0)
    assert arm.path.buffer.rejected == {'no clock': 1}
    assert not arm.path.buffer.is_complete


number = st.one_of(st.floats(-3, 3), st.floats(allow_nan=True, allow_infinity=True))
MESSAGES = st.tuples(
    st.just('state'),
    st.lists(st.sampled_from([*NAMES, 'other']), max_size=4),
    st.lists(number, max_size=4),
    st.lists(number, max_size=4),
    # The stamp: none, in time, late, ahead, random.
    st.one_of(st.none(), st.floats(-0.3, 0.3), st.integers(-(2**31), 2**31)),
)
CALLS = ('enable', 'disable', 'fault', 'error', 'signal', 'lost', 'late controller', 'tick')
EVENTS = st.one_of(
    MESSAGES,
    st.tuples(st.just('good'), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)),
    st.tuples(st.just('good'), st.floats(-0.01, 0.01), st.floats(-0.01, 0.01)),
    st.tuples(st.sampled_from(CALLS)),
    st.tuples(st.just('change'), st.floats(-2.0, 2.0), st.floats(0.1, 1.0)),
    st.tuples(st.just('clock'), st.one_of(st.just(0.0), st.floats(-1e6, 1e6))),
)


def stamp_of(choice, clock):
    """Return the stamp for a choice, ns."""
    if choice is None:
        return 0
    return clock - round(choice * SECOND) if isinstance(choice, float) else choice * SECOND


def call(path, event, now):
    """Stop or restart by one of the calls for it."""
    if event == 'signal':
        path.close(now, event, 2.5)
    else:
        {
            'disable': path.disable,
            'fault': path.fault,
            'error': path.fail,
            'lost': path.lose_controller,
            'late controller': path.restart_from_zero,
        }[event](now, event)


# An arm that moves as fast as it can while ACTIVE needs a larger step than its rate limit.
SWING = [
    (0.0, ('good', 1.4, 0.2)),
    (0.0, ('enable',)),
    *[(0.01, ('good', 1.4, 0.2))] * 60,
    (0.01, ('good', 1.345, 0.2)),
]


@example(behavior='hold', events=SWING)
@given(
    st.sampled_from(BEHAVIORS),
    st.lists(st.tuples(st.one_of(st.just(0.01), st.floats(0, 0.5)), EVENTS), max_size=80),
)
def test_any_sequence_of_events_gives_valid_commands_and_none_while_off(behavior, events):
    arm = Arm(behavior)
    path = arm.path
    now, offset = 0.0, 1000.0
    last, last_time = np.zeros(2), 0.0
    for step, (event, *values) in events:
        now += step
        clock = max(round((now + offset) * SECOND), 0)
        was_on, was_stopping, command = path.is_on, arm.name == 'STOPPING', None
        if event == 'enable':
            is_closed = path.is_closed
            assert path.enable(now) == (not was_on and not is_closed)
        elif event == 'clock':
            offset += values[0]
        elif event == 'change':
            arm.configure(values[0], values[1] * LIMITS, now)
        elif event == 'tick':
            command = arm.tick(now)
        elif event in ('state', 'good'):
            names, position, velocity, stamp = (
                values if event == 'state' else (NAMES, values, [], 0.0)
            )
            try:
                command = arm.take(now, position, velocity, stamp_of(stamp, clock), names, clock)
            except RejectedStateError as error:
                note(str(error))
        else:
            call(path, event, now)
        if event in ('late controller', 'enable') and path.is_driving:
            last = path.output.limiter.last  # the efforts in force may have changed
        if command is None:
            continue
        assert was_on
        assert command.shape == (2,)
        assert np.isfinite(command).all()
        assert (np.abs(command) <= np.maximum(LIMITS, np.abs(last))).all()
        # The time of one step is at most 10 ms, that of a stop at most 50 ms.
        dt = min(now - last_time, STOP_PERIOD)
        allowed = RATES * dt
        if was_stopping or arm.name == 'STOPPING':
            allowed = np.maximum(RATES * min(now - last_time, 0.02), 0.55 * LIMITS)
            assert (np.abs(command) <= np.abs(last) + 1e-12).all() or not was_stopping
        assert (np.abs(command - last) <= allowed * (1 + 1e-9) + 1e-12).all()
        last, last_time = command, now
    assert np.isfinite(path.buffer.position).all()


@given(
    st.sampled_from(BEHAVIORS),
    st.floats(0.01, 60.0),
    st.floats(1e-9, 1e3),
    st.sampled_from(['fault', 'signal', 'error']),
)
def test_every_stop_that_protects_the_arm_ends_within_its_bound(behavior, ramp, rate, cause):
    arm, state = active()
    arm.rates, arm.behavior = np.full(2, rate), behavior
    arm.settings = lambda behavior, timeout: OutputSettings(timeout, 0.5, ramp, behavior)
    arm.configure()
    {
        'fault': lambda: arm.path.fault(1.0, cause),
        'error': lambda: arm.path.fail(1.0, cause),
        'signal': lambda: arm.path.close(1.0, cause, 2.5),
    }[cause]()
    arm.run(1.0, 2.6, state)
    assert not arm.path.is_on
    np.testing.assert_array_equal(arm.sent[-1], [0.0, 0.0])
