"""The buffer: any order, partial messages, other joints, and dropped messages."""

import contextlib
import math

from dynamics_node.safety import JointStateBuffer, MotionLimits, RejectedStateError, StampTolerance
from dynamics_node.safety.joint_state_buffer import MAX_JUMPS, MAX_NAMES
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

NAMES = ('a', 'b', 'c')
SECOND = 1_000_000_000


def buffer(needed=NAMES):
    return JointStateBuffer(NAMES, needed, np.array([0.1, 0.2, 0.3]))


@given(st.lists(st.permutations(['a', 'b', 'c', 'x', 'y']), min_size=1, max_size=3))
def test_order_and_extra_joints_do_not_matter(orders):
    values = {'a': 1.0, 'b': 2.0, 'c': 3.0, 'x': math.nan, 'y': 9.0}
    unit = buffer()
    for names in orders:  # the order may change from message to message
        with pytest.raises(RejectedStateError):  # which does not affect the next one
            unit.update(0.0, ['c', 'c'], [1, 1])
        unit.update(0.0, names, [values[n] for n in names], [-values[n] for n in names])
        np.testing.assert_array_equal(unit.position, [1, 2, 3])
        np.testing.assert_array_equal(unit.velocity, [-1, -2, -3])


def test_partial_states_change_only_their_joints():
    unit = buffer()
    unit.update(0.0, ['b'], [5.0], [math.inf])
    np.testing.assert_array_equal(unit.position, [0.1, 5.0, 0.3])  # neutral before the first
    assert np.isnan(unit.velocity).all()  # an infinite one is unknown, too
    unit.update(0.1, ['c', 'a'], [3.0, 1.0], [-math.inf, 4.0])
    np.testing.assert_array_equal(unit.position, [1.0, 5.0, 3.0])
    np.testing.assert_array_equal(unit.velocity, [4.0, math.nan, math.nan])
    unit.position[:] = 99.0  # a copy
    np.testing.assert_array_equal(unit.position, [1.0, 5.0, 3.0])


def test_every_needed_joint_must_be_fresh():
    unit = buffer(needed=('a', 'b'))
    assert unit.age(0.0) == math.inf
    unit.update(1.0, ['a', 'c'], [1, 3])
    assert unit.age(1.0) == math.inf
    assert unit.stale_joints(1.0, 0.1) == ['b']
    unit.update(2.0, ['b'], [2])
    assert unit.age(2.25) == 1.25
    assert unit.stale_joints(2.0, 0.5) == ['a']
    assert unit.stale_joints(2.0, 1.5) == []
    assert unit.stale_joints(2.0, 0.5, [1, 2]) == ['c']


@pytest.mark.parametrize(
    'names, position, velocity, kind, message',
    [
        (['a', 'b'], [1.0], [], 'length', 'expected 2 positions for 2 names, got 1'),
        (['a'], [], [], 'length', 'expected 1 positions for 1 names, got 0'),
        (['a'], [1.0], [1.0, 2.0], 'length', 'expected 1 velocities or none, got 2'),
        (['a', 'a'], [1.0, 2.0], [], 'name twice', "got twice: 'a'"),
        (['b', 'a'], [1.0, math.nan], [], 'not finite', 'NaN or infinity for a'),
        (['b', 'a'], [-math.inf, 1.0], [], 'not finite', 'for b'),
        ([str(i) for i in range(MAX_NAMES + 1)], [], [], 'too many names', 'at most 4096'),
    ],
)
def test_a_bad_message_is_dropped_whole_and_counted(names, position, velocity, kind, message):
    unit = buffer()
    unit.update(0.0, NAMES, [1, 2, 3], [4, 5, 6])
    with pytest.raises(RejectedStateError, match=message):
        unit.update(1.0, names, position, velocity)
    assert unit.rejected == {kind: 1}
    assert unit.accepted == 1
    assert unit.age(1.0) == 1.0
    np.testing.assert_array_equal(unit.position, [1, 2, 3])
    np.testing.assert_array_equal(unit.velocity, [4, 5, 6])


def test_names_in_the_message_are_short_and_printable():
    name = '\x1b]0;title\x07\n' + 'x' * 10_000
    with pytest.raises(RejectedStateError) as caught:
        buffer().update(0.0, [name, name], [1.0, 2.0])
    assert len(str(caught.value)) < 200
    assert str(caught.value).isprintable()


def test_nan_of_an_unneeded_joint_is_ignored():
    unit = buffer(needed=('a',))
    unit.update(0.0, ['b', 'a'], [math.nan, 1.0], [5.0, 6.0])
    np.testing.assert_array_equal(unit.position, [1.0, 0.2, 0.3])
    np.testing.assert_array_equal(unit.velocity, [6.0, math.nan, math.nan])
    assert unit.age(0.0) == 0.0


def moving(needed=NAMES):
    """Return a buffer of joints with 1 rad/s and a state timeout of 0.1 s."""
    return JointStateBuffer(
        NAMES,
        needed,
        np.zeros(3),
        MotionLimits(NAMES, np.ones(3), np.tile([-3.0, 3.0], (3, 1)), np.zeros(3, dtype=bool)),
        StampTolerance(0.1),
    )


def stamped(unit, time, names=NAMES, position=(0.0, 0.0, 0.0), late=0.0):
    """Send a buffer a message that arrives `late` seconds after its stamp."""
    unit.update(
        time,
        list(names),
        list(position),
        (),
        round((100 + time - late) * SECOND),
        round((100 + time) * SECOND),
    )


@pytest.fixture
def unit():
    """Return a moving buffer with a state at 0 s."""
    unit = moving()
    stamped(unit, 0.0)
    return unit


@pytest.mark.parametrize('late', [0.2, -0.2])
def test_a_stamp_far_from_the_clock_makes_nothing_fresh(unit, late):
    with pytest.raises(RejectedStateError, match='synchronize the clocks'):
        stamped(unit, 1.0, late=late)
    assert unit.age(1.0) == 1.0
    assert unit.rejected == {'stamp': 1}
    stamped(unit, 1.0, late=0.09)
    assert unit.age(1.0) == pytest.approx(0.09)  # the age counts from the stamp


@pytest.mark.parametrize('late, text', [(0.05, 'repeated'), (0.06, 'going back by 0.010 s')])
def test_a_stamp_that_is_not_newer_makes_nothing_fresh(unit, late, text):
    with pytest.raises(RejectedStateError, match=text):
        stamped(unit, 0.05, position=(0.01, 0.0, 0.0), late=late)
    assert unit.rejected == {'old stamp': 1}
    assert unit.age(0.05) == 0.05
    assert unit.position[0] == 0.0


def test_the_order_of_stamps_holds_for_each_joint_by_itself():
    # Two broadcasters whose messages overtake each other.
    unit = moving()
    stamped(unit, 0.00, 'ab', (0.0, 0.0))
    stamped(unit, 0.01, 'c', (0.0,), late=0.02)
    stamped(unit, 0.02, 'ab', (0.0, 0.0))
    assert unit.rejected == {}
    assert unit.is_complete


def test_stamps_from_before_a_clock_reset_do_not_block_new_ones():
    unit = moving()
    stamped(unit, 50.0)
    unit.update(50.1, list(NAMES), [0.0, 0.0, 0.0], (), 7 * SECOND, 7 * SECOND)
    assert unit.age(50.1) == 0.0


def test_without_stamps_the_arrival_counts():
    unit = moving()
    for time in (0.0, 0.0, 0.1):
        unit.update(time, list(NAMES), [0.0, 0.0, 0.0])
    assert unit.accepted == 3


def test_an_impossible_step_is_dropped_and_the_next_good_one_counts(unit):
    text = r'got b from 0 to 0\.5 within 0\.100 s, at a velocity limit of 1'
    with pytest.raises(RejectedStateError, match=text) as caught:
        stamped(unit, 0.1, position=(0.0, 0.5, 0.0))
    assert not caught.value.is_fault
    stamped(unit, 0.2, position=(0.0, 0.1, 0.0))
    np.testing.assert_array_equal(unit.position, [0.0, 0.1, 0.0])
    assert unit.rejected == {'jump': 1}


def test_the_time_of_a_step_is_that_between_the_stamps(unit):
    # The messages come 0.001 s apart, the measurements were 0.09 s apart.
    stamped(unit, 0.1, late=0.09)
    stamped(unit, 0.101, position=(0.15, 0.0, 0.0), late=0.001)
    assert unit.rejected == {}


def test_several_impossible_steps_in_a_row_are_a_fault_and_then_accepted(unit):
    there = (2.0, 0.0, 0.0)
    for i in range(1, MAX_JUMPS):
        with pytest.raises(RejectedStateError) as caught:
            stamped(unit, 0.01 * i, position=there)
        assert not caught.value.is_fault
    with pytest.raises(RejectedStateError, match='3 times in a row') as caught:
        stamped(unit, 0.01 * MAX_JUMPS, position=there)
    assert caught.value.is_fault
    assert not unit.is_complete
    stamped(unit, 0.04, position=there)
    np.testing.assert_array_equal(unit.position, there)
    assert unit.is_complete


def test_good_steps_restart_the_count(unit):
    for i in range(10):
        with pytest.raises(RejectedStateError) as caught:
            stamped(unit, 0.02 * i + 0.01, position=(2.5, 0.0, 0.0))
        assert not caught.value.is_fault
        stamped(unit, 0.02 * i + 0.02)


def test_states_of_other_joints_do_not_restart_the_count(unit):
    # An arm and its gripper have a broadcaster each.
    for i in range(MAX_JUMPS):
        stamped(unit, 0.02 * i + 0.01, 'c', (0.0,))
        with pytest.raises(RejectedStateError) as caught:
            stamped(unit, 0.02 * i + 0.02, 'ab', (2.5, 0.0))
    assert caught.value.is_fault


def test_any_position_is_accepted_after_a_silence(unit):
    stamped(unit, 0.11, position=(3.0, -3.0, 3.0))
    np.testing.assert_array_equal(unit.position, [3.0, -3.0, 3.0])


def test_joints_that_are_not_needed_may_jump():
    unit = moving(needed=('a',))
    stamped(unit, 0.0)
    stamped(unit, 0.01, position=(0.0, 2.0, 0.0))
    assert unit.position[1] == 2.0


def test_forget_requires_new_measurements_and_is_none(unit):
    unit.forget()
    assert not unit.is_complete
    assert unit.age(0.5) == 0.5
    assert unit.stale_joints(0.0, 1e9) == list(NAMES)
    stamped(unit, 0.6, 'ab', (0.0, 0.0))
    unit.forget()
    assert unit.age(0.7) == 0.7
    stamped(unit, 0.8, 'ab', (3.0, 0.0))
    stamped(unit, 0.9, 'c', (0.0,))
    assert unit.is_complete
    assert unit.age(0.9) == pytest.approx(0.1)


def test_runaway_and_outside_cover_the_needed_joints():
    unit = moving(needed=('a', 'b'))
    unit.update(0.0, list(NAMES), [0.0, 5.0, 5.0], [2.5, 0.0, 9.0])
    assert unit.runaway() == 'a at 2.5 (limit 1)'
    assert unit.outside() == 'b at 5 (limits -3 to 3)'


# Efforts -------------------------------------------------------------------------------------


def test_efforts_are_merged_by_name_and_forgotten():
    unit = buffer()
    assert np.isnan(unit.effort).all()
    unit.update(0.0, ['c', 'x', 'a'], [3.0, 9.0, 1.0], efforts=[-3.0, -9.0, -1.0])
    np.testing.assert_array_equal(unit.effort, [-1.0, math.nan, -3.0])
    unit.effort[:] = 99.0  # a copy
    with pytest.raises(RejectedStateError):  # a dropped state changes none
        unit.update(0.1, NAMES, [math.nan, 0, 0], efforts=[4.0, 5.0, 6.0])
    np.testing.assert_array_equal(unit.effort, [-1.0, math.nan, -3.0])
    unit.update(0.2, NAMES, [0, 0, 0], efforts=[math.nan, 2.0, 3.0])
    np.testing.assert_array_equal(unit.effort, [math.nan, 2.0, 3.0])
    assert unit.breaks == 0
    unit.forget()
    assert unit.breaks == 1
    assert np.isnan(unit.effort).all()


@pytest.mark.parametrize(
    'efforts', [[], [1.0], [1.0] * 4, [math.nan] * 3, [math.inf, -math.inf, math.nan]], ids=str
)
def test_wrong_efforts_are_unknown_and_drop_no_state(efforts):
    unit = buffer()
    unit.update(0.0, NAMES, [0, 0, 0], [0, 0, 0], efforts=[1.0, 2.0, 3.0])
    unit.update(0.1, NAMES, [1, 2, 3], [4, 5, 6], efforts=efforts)
    assert np.isnan(unit.effort).all()
    assert unit.rejected == {} and unit.accepted == 2 and unit.age(0.1) == 0.0
    np.testing.assert_array_equal(unit.position, [1, 2, 3])
    np.testing.assert_array_equal(unit.velocity, [4, 5, 6])


@given(
    st.lists(st.floats(), max_size=5),
    st.permutations(['a', 'b', 'c', 'x']),
    st.lists(st.floats(), min_size=4, max_size=4),
)
def test_efforts_do_not_change_the_rest_of_the_state(efforts, names, positions):
    units = [buffer(needed=('a', 'b')), buffer(needed=('a', 'b'))]
    for unit, given_efforts in zip(units, ((), efforts), strict=True):
        with contextlib.suppress(RejectedStateError):
            unit.update(1.0, names, positions, (), efforts=given_efforts)
        assert not np.isinf(unit.effort).any()
    with_none, with_some = units
    assert with_none.rejected == with_some.rejected
    assert with_none.accepted == with_some.accepted
    assert with_none.age(2.0) == with_some.age(2.0)
    assert with_none.position.tobytes() == with_some.position.tobytes()


def test_measured_is_the_stamp_of_the_oldest_needed_joint():
    unit = moving(needed=('a', 'b'))
    assert unit.measured == 0
    stamped(unit, 0.01, 'ac', (0.0, 0.0))
    assert unit.measured == 0
    stamped(unit, 0.02, 'b', (0.0,))
    assert unit.measured == round(100.01 * SECOND)
    stamped(unit, 0.03, 'ac', (0.0, 0.0))
    assert unit.measured == round(100.02 * SECOND)
    # Without a stamp the time of the measurement is unknown.
    unit.update(0.04, ['a'], [0.0])
    assert unit.measured == 0


NOW = 1_700_000_000 * SECOND


@pytest.mark.parametrize(
    'timeout, late',
    [(0.3, 0), (0.3, 0.05), (0.3, 0.3), (0.3, -0.05), (0.3, -0.3), (0.005, 1 / 11)],
)
def test_a_stamp_within_the_state_timeout_passes_at_least_a_tenth_of_a_second(timeout, late):
    StampTolerance(timeout).check(NOW - round(late * SECOND), NOW)


@pytest.mark.parametrize(
    'late, text',
    [
        (0.301, r'within 0\.3 s of the clock, got one 0\.301 s old'),
        (3600, r'3600\.000 s old: synchronize the clocks'),
        (-0.4, r'0\.400 s in the future'),
        (NOW / SECOND, 'set use_sim_time on both sides or on neither'),
    ],
)
def test_a_stamp_beyond_it_is_refused_with_the_difference(late, text):
    with pytest.raises(RejectedStateError, match=text) as caught:
        StampTolerance(0.3).check(NOW - round(late * SECOND), NOW)
    assert caught.value.kind == 'stamp'
    assert not caught.value.is_fault


def test_a_stamp_far_ahead_of_the_clock_is_from_before_a_reset():
    tolerance = StampTolerance(0.1)
    assert tolerance.is_ahead(NOW + SECOND, NOW)
    assert not tolerance.is_ahead(NOW + SECOND // 20, NOW)
    assert not tolerance.is_ahead(NOW - SECOND, NOW)
