"""The buffer: any order, parts, extras; and what it drops."""

import math

from dynamics_node.output import JointStateBuffer, RejectedStateError
from dynamics_node.output.joint_state_buffer import MAX_NAMES
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

NAMES = ('a', 'b', 'c')


def buffer(needed=NAMES):
    return JointStateBuffer(NAMES, needed, np.array([0.1, 0.2, 0.3]))


@given(st.permutations(['a', 'b', 'c', 'x', 'y']))
def test_order_and_extra_joints_do_not_matter(names):
    values = {'a': 1.0, 'b': 2.0, 'c': 3.0, 'x': math.nan, 'y': 9.0}
    unit = buffer()
    unit.update(0.0, names, [values[name] for name in names], [-values[n] for n in names])
    np.testing.assert_array_equal(unit.position, [1, 2, 3])
    np.testing.assert_array_equal(unit.velocity, [-1, -2, -3])


def test_the_order_may_change_from_message_to_message():
    unit = buffer()
    unit.update(0.0, ['a', 'b', 'c'], [1, 2, 3])
    unit.update(0.1, ['c', 'b', 'a'], [3, 2, 1])
    unit.update(0.2, ['b'], [2.5])
    np.testing.assert_array_equal(unit.position, [1, 2.5, 3])


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


def test_a_joint_never_measured_stands_at_its_neutral_position():
    unit = buffer()
    unit.update(0.0, ['b'], [5.0])
    np.testing.assert_array_equal(unit.position, [0.1, 5.0, 0.3])
    assert np.isnan(unit.velocity).all()


@pytest.mark.parametrize('names, position, velocity, kind, message', [
    (['a', 'b'], [1.0], [], 'length', 'expected 2 positions for 2 names, got 1'),
    (['a'], [], [], 'length', 'expected 1 positions for 1 names, got 0'),
    (['a'], [1.0], [1.0, 2.0], 'length', 'expected 1 velocities or none, got 2'),
    (['a', 'a'], [1.0, 2.0], [], 'name twice', "got twice: 'a'"),
    (['b', 'a'], [1.0, math.nan], [], 'not finite', 'NaN or infinity for a'),
    (['b', 'a'], [-math.inf, 1.0], [], 'not finite', 'for b'),
    ([str(i) for i in range(MAX_NAMES + 1)], [], [], 'too many names', 'at most 4096'),
])
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


def test_a_bad_message_does_not_spoil_the_next_one():
    unit = buffer()
    unit.update(0.0, ['a', 'b', 'c'], [1, 2, 3])
    for _ in range(2):
        with pytest.raises(RejectedStateError):
            unit.update(1.0, ['c', 'c'], [1, 1])
        unit.update(1.0, ['c'], [7])
        unit.update(1.0, ['a', 'b', 'c'], [1, 2, 3])
    np.testing.assert_array_equal(unit.position, [1, 2, 3])


def test_what_is_handed_out_is_a_copy():
    unit = buffer()
    unit.position[:] = 99
    np.testing.assert_array_equal(unit.position, [0.1, 0.2, 0.3])


def test_nan_of_a_joint_that_is_not_needed_is_passed_over():
    unit = buffer(needed=('a',))
    unit.update(0.0, ['b', 'a'], [math.nan, 1.0], [5.0, 6.0])
    np.testing.assert_array_equal(unit.position, [1.0, 0.2, 0.3])
    np.testing.assert_array_equal(unit.velocity, [6.0, math.nan, math.nan])
    assert unit.age(0.0) == 0.0
