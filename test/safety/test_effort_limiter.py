"""The limiter: whatever comes in, what goes out is finite, limited and one step away."""

from dynamics_node.safety import EffortLimiter, InvalidEffortError
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

LIMITS, RATES = np.array([10.0, 2.0]), np.array([100.0, 5.0])
any_float = st.floats(allow_nan=True, allow_infinity=True)


def limiter(scale=(1.0, 1.0)):
    return EffortLimiter(LIMITS, RATES, np.array(scale))


@given(st.lists(st.tuples(st.tuples(any_float, any_float), st.floats(0, 1), st.floats(-1, 1)),
                max_size=30))
def test_no_sequence_of_efforts_gets_past_the_limits(sequence):
    unit = limiter((1.5, 0.5))
    last = np.zeros(2)
    for effort, ramp, dt in sequence:
        try:
            command = unit.command(np.array(effort), ramp, dt)
        except InvalidEffortError:
            assert not np.isfinite(effort).all()
            np.testing.assert_array_equal(unit.last, last)
            continue
        assert command.shape == (2,)
        assert np.isfinite(command).all()
        assert (np.abs(command) <= LIMITS).all()
        assert (np.abs(command - last) <= RATES * max(dt, 0.0) * (1 + 1e-12) + 1e-15).all()
        last = command


def test_an_effort_within_everything_passes_unchanged():
    np.testing.assert_array_equal(limiter().command([3.0, -1.0], 1.0, 1.0), [3.0, -1.0])


def test_scale_comes_before_the_clamp_and_the_ramp_after_it():
    unit = limiter((4.0, 1.0))
    np.testing.assert_array_equal(unit.command([5.0, 1.0], 0.5, 1.0), [5.0, 0.5])
    assert unit.is_saturated
    assert unit.saturations == [1, 0]
    assert unit.saturation() == 'joint 0: 20 limited to 10'
    unit.command([1.0, 1.0], 1.0, 1.0)
    assert not unit.is_saturated
    assert unit.saturations == [1, 0]
    assert unit.saturation() == ''


def test_a_step_is_limited_by_the_time_since_the_last_command():
    unit = limiter()
    np.testing.assert_allclose(unit.command([9.0, 2.0], 1.0, 0.01), [1.0, 0.05])
    assert unit.rate_limited == 1
    np.testing.assert_allclose(unit.command([9.0, 2.0], 1.0, 0.01), [2.0, 0.1])
    assert unit.rate_limited == 2
    unit.command([2.0, 0.1], 1.0, 0.01)
    assert unit.rate_limited == 2


def test_infinity_is_refused_although_a_clamp_would_swallow_it_only_if_not_finite_after_all():
    # +inf clamps to the limit, which is a safe number; NaN stays NaN and is refused.
    np.testing.assert_array_equal(limiter().command([np.inf, 0.0], 1.0, 1.0), [10.0, 0.0])
    with pytest.raises(InvalidEffortError, match='expected finite efforts'):
        limiter().command([np.nan, 0.0], 1.0, 1.0)


def test_the_last_command_is_told_by_joint():
    unit = EffortLimiter(LIMITS, RATES, np.ones(2), ('shoulder', 'elbow'))
    unit.command([3.0, -1.0], 1.0, 1.0)
    assert unit.describe_last() == 'shoulder: 3, elbow: -1'


def test_another_length_is_refused():
    for effort in ([1.0], [1.0, 1.0, 1.0], []):
        with pytest.raises(InvalidEffortError, match='expected 2 efforts'):
            limiter().command(effort, 1.0, 1.0)


def test_a_new_limiter_carries_on_from_the_old_ones_command():
    old, new = limiter(), limiter()
    old.command([9.0, 2.0], 1.0, 0.01)
    new.carry_on_from(old)
    np.testing.assert_allclose(new.command([9.0, 2.0], 1.0, 0.01), [2.0, 0.1])
    new.reset()
    np.testing.assert_array_equal(new.last, [0.0, 0.0])
