"""Gravity while an arm is driven: it turns slowly, for any number of calls."""

import math

from dynamics_node.safety import GravityChange
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

DOWN = (0.0, 0.0, -9.81)


def turned(degrees, size=9.81):
    """Return gravity turned about y."""
    return size * np.array(
        [math.sin(math.radians(degrees)), 0.0, -math.cos(math.radians(degrees))]
    )


@pytest.fixture
def change():
    unit = GravityChange()
    unit.begin(0.0, DOWN)
    return unit


def test_a_small_turn_is_accepted_at_once_and_a_large_one_is_not(change):
    assert change.refusal(0.0, turned(29.0)) == ''
    refusal = change.refusal(0.0, turned(31.0))
    assert 'expected a turn of at most 30 degrees at once and 30 degrees per second' in refusal
    assert 'got 31 degrees' in refusal
    assert 'opposite' in change.refusal(0.0, (0.0, 0.0, 9.81))


def test_several_calls_turn_gravity_no_further_than_one(change):
    # 84, 12 and 84 degrees: each below 90, together upside down.
    sequence = [(9.7, 0.0, -1.0), (9.7, 0.0, 1.0), (0.0, 0.0, 9.81)]
    assert all(change.refusal(0.001 * i, gravity) for i, gravity in enumerate(sequence))


@given(st.lists(st.tuples(st.floats(0.0, 0.5), st.floats(-40.0, 40.0)), max_size=60))
def test_no_sequence_turns_faster_than_the_rate(steps):
    unit, now, angle = GravityChange(), 0.0, 0.0
    unit.begin(now, DOWN)
    history = [(0.0, 0.0)]
    for dt, turn in steps:
        now += dt
        if unit.refusal(now, turned(angle + turn)) == '':
            unit.accept(now, turned(angle + turn))
            angle += turn
            history.append((now, angle))
    for i, (time, before) in enumerate(history):
        for later, after in history[i:]:
            assert abs(after - before) <= 60.0 + 30.0 * (later - time) + 1e-6


def test_a_slowly_tilting_base_is_always_followed(change):
    for i in range(1, 2000):
        gravity = turned(25.0 * i * 0.01)
        assert change.refusal(0.01 * i, gravity) == '', i
        change.accept(0.01 * i, gravity)


def test_the_magnitude_is_limited(change):
    assert change.refusal(0.0, turned(0.0, 11.0)) == ''
    assert 'size that changes by at most 2 m/s^2' in change.refusal(0.0, turned(0.0, 20.0))
    assert 'not zero while output is on' in change.refusal(0.0, (0.0, 0.0, 0.0))
