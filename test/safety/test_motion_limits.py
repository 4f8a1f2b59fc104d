"""Impossible steps, runaway and positions outside, with values computed by hand."""

import math

from dynamics_node.safety import MotionLimits
from dynamics_node.safety.motion_limits import JUMP_MARGIN, SHORTEST_STEP
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

# A hinge of 3 rad/s, a wheel of 3 rad/s, a joint without limits.
LIMITS = MotionLimits(
    ('hinge', 'wheel', 'unknown'),
    np.array([3.0, 3.0, math.nan]),
    np.array([[-1.0, 2.0], [-math.inf, math.inf], [-math.inf, math.inf]]),
    np.array([False, True, False]),
)
EVERY = (0, 1, 2)


@pytest.mark.parametrize(
    'step, dt, is_impossible',
    [
        (0.59, 0.1, False),
        (0.61, 0.1, True),
        (-0.61, 0.1, True),
        # Two messages at nearly the same time: still the shortest step.
        (JUMP_MARGIN * 3.0 * SHORTEST_STEP * 0.99, 0.0, False),
        (JUMP_MARGIN * 3.0 * SHORTEST_STEP * 1.01, 0.0, True),
        (JUMP_MARGIN * 3.0 * SHORTEST_STEP * 1.01, -5.0, True),
        (1e300, 1.0, True),
        (1e300, math.inf, False),
    ],
)
def test_a_step_beyond_twice_the_velocity_limit_is_impossible(step, dt, is_impossible):
    for joint in (0, 1):
        # 1e300 rad is a whole number of turns from every position: only the hinge detects it.
        if joint == 0 or abs(step) < 1e9:
            assert LIMITS.is_impossible(joint, 0.25, 0.25 + step, dt) == is_impossible


@given(st.integers(-5, 5), st.floats(-0.59, 0.59))
def test_whole_turns_of_a_wheel_are_no_step(turns, step):
    assert not LIMITS.is_impossible(1, 0.5, 0.5 + turns * 2 * math.pi + step, 0.1)
    assert LIMITS.is_impossible(1, 0.5, 0.5 + (turns + 0.5) * 2 * math.pi, 0.1)
    assert LIMITS.is_impossible(0, 0.5, 0.5 + turns * 2 * math.pi + step, 0.1) == (turns != 0)


@given(
    st.integers(0, 1),
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(allow_nan=False, allow_infinity=False),
    st.floats(-1, 1),
)
def test_is_impossible_never_raises(joint, before, after, dt):
    LIMITS.is_impossible(joint, before, after, dt)
    LIMITS.describe_jump(joint, before, after, dt)


def test_every_step_of_a_joint_without_limits_is_possible():
    assert not LIMITS.is_impossible(2, 0.0, 1e6, 0.0)
    assert LIMITS.runaway((2,), (0.0, 0.0, 1e6)) == ''
    everything = MotionLimits.none(('a',))
    assert not everything.is_impossible(0, -1e300, 1e300, 0.0)
    assert everything.outside((0,), (1e300,)) == ''


def test_a_runaway_is_a_joint_above_its_velocity_limit():
    assert LIMITS.runaway(EVERY, (2.9, -2.9, 0.0)) == ''
    assert LIMITS.runaway(EVERY, (0.0, -3.1, 0.0)) == 'wheel at -3.1 (limit 3)'
    assert LIMITS.runaway((0,), (0.0, -3.1, 0.0)) == ''
    assert LIMITS.runaway(EVERY, (math.nan, math.nan, math.nan)) == ''


def test_the_allowed_velocity_decides_on_runaway_and_the_possible_one_on_jumps():
    def limits(allowed):
        return MotionLimits(
            ('hinge',),
            np.array([3.0]),
            np.array([[-1.0, 2.0]]),
            np.array([False]),
            np.array([allowed]),
        )

    slow, fast, free = limits(0.5), limits(10.0), limits(math.nan)
    assert slow.runaway((0,), (0.6,)) == 'hinge at 0.6 (limit 0.5)'
    assert fast.runaway((0,), (9.9,)) == free.runaway((0,), (1e9,)) == ''
    assert not slow.is_impossible(0, 0.0, 0.59, 0.1)  # within the possible velocity
    assert slow.is_impossible(0, 0.0, 0.61, 0.1)
    assert not fast.is_impossible(0, 0.0, 1.9, 0.1)
    assert fast.is_impossible(0, 0.0, 2.1, 0.1)


def test_joints_beyond_their_position_limits_are_named():
    assert LIMITS.outside(EVERY, (2.0, 99.0, 99.0)) == ''
    assert LIMITS.outside(EVERY, (2.5, 99.0, 99.0)) == 'hinge at 2.5 (limits -1 to 2)'
    assert LIMITS.outside((1, 2), (2.5, 99.0, 99.0)) == ''
