"""The limiter: every command is finite, limited and one step from the last one."""

from dynamics_node.safety import EffortLimiter, InvalidEffortError
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

LIMITS, RATES = np.array([10.0, 2.0]), np.array([100.0, 5.0])
any_float = st.floats(allow_nan=True, allow_infinity=True)


def limiter(scale=(1.0, 1.0), offset=(0.0, 0.0)):
    return EffortLimiter(LIMITS, RATES, np.array(scale), offset=np.array(offset))


def command(unit, effort, ramp, dt):
    """Return the next command toward a fraction of an effort."""
    return unit.step([ramp * value for value in unit.target(np.array(effort))], dt)


@given(
    st.lists(
        st.tuples(st.tuples(any_float, any_float), st.floats(0, 1), st.floats(-1, 1)), max_size=30
    )
)
def test_no_sequence_of_efforts_exceeds_the_limits(sequence):
    unit = limiter((1.5, 0.5), (-1.0, 5.0))
    last = np.zeros(2)
    for effort, ramp, dt in sequence:
        try:
            sent = command(unit, effort, ramp, dt)
        except InvalidEffortError:
            assert not np.isfinite(effort).all()
            np.testing.assert_array_equal(unit.last, last)
            continue
        assert sent.shape == (2,)
        assert np.isfinite(sent).all()
        assert (np.abs(sent) <= LIMITS).all()
        assert (np.abs(sent - last) <= RATES * max(dt, 0.0) * (1 + 1e-12) + 1e-15).all()
        last = sent


def test_scale_comes_before_the_clamp_and_the_ramp_after_it():
    unit = limiter((4.0, 1.0))
    np.testing.assert_array_equal(command(unit, [5.0, 1.0], 0.5, 1.0), [5.0, 0.5])
    assert unit.is_saturated
    assert unit.saturations == [1, 0]
    assert unit.saturation() == 'joint 0: 20 limited to 10'
    command(unit, [1.0, 1.0], 1.0, 1.0)
    assert not unit.is_saturated
    assert unit.saturations == [1, 0]
    assert unit.saturation() == ''


def test_the_offset_comes_after_the_scale_and_before_the_clamp_and_the_ramp():
    unit = limiter((4.0, 0.0), (-1.0, 0.5))
    np.testing.assert_array_equal(command(unit, [2.0, 1.0], 1.0, 1.0), [7.0, 0.5])
    np.testing.assert_array_equal(command(unit, [5.0, 1.0], 0.5, 1.0), [5.0, 0.25])
    assert unit.saturation() == 'joint 0: 19 limited to 10'
    np.testing.assert_array_equal(command(unit, [-5.0, 1.0], 0.0, 1.0), [0.0, 0.0])


def test_a_step_is_limited_by_the_time_since_the_last_command():
    unit = limiter()
    np.testing.assert_allclose(command(unit, [9.0, 2.0], 1.0, 0.01), [1.0, 0.05])
    assert unit.rate_limited == 1
    np.testing.assert_allclose(command(unit, [9.0, 2.0], 1.0, 0.01), [2.0, 0.1])
    assert unit.rate_limited == 2
    command(unit, [2.0, 0.1], 1.0, 0.01)
    assert unit.rate_limited == 2


def test_infinity_is_clamped_and_nan_is_refused():
    # +inf is clamped to the limit, which is safe; NaN stays NaN and is refused.
    np.testing.assert_array_equal(command(limiter(), [np.inf, -1.0], 1.0, 1.0), [10.0, -1.0])
    with pytest.raises(InvalidEffortError, match='expected finite efforts'):
        command(limiter(), [np.nan, 0.0], 1.0, 1.0)


def test_the_last_command_is_described_by_joint():
    unit = EffortLimiter(LIMITS, RATES, np.ones(2), ('shoulder', 'elbow'))
    command(unit, [3.0, -1.0], 1.0, 1.0)
    assert unit.describe_last() == 'shoulder: 3, elbow: -1'


def test_another_length_is_refused():
    for effort in ([1.0], [1.0, 1.0, 1.0], []):
        with pytest.raises(InvalidEffortError, match='expected 2 efforts'):
            command(limiter(), effort, 1.0, 1.0)


def test_a_new_limiter_continues_from_the_last_command():
    old, new = limiter(), limiter()
    command(old, [9.0, 2.0], 1.0, 0.01)
    new.carry_on_from(old)
    np.testing.assert_allclose(command(new, [9.0, 2.0], 1.0, 0.01), [2.0, 0.1])
    new.reset()
    np.testing.assert_array_equal(new.last, [0.0, 0.0])


def test_a_stop_may_step_further_than_the_rate_limit():
    unit = limiter()
    unit.resume([5.0, -1.0])
    np.testing.assert_allclose(unit.step([0.0, 0.0], 0.0, [0.5, 0.1]), [4.5, -0.9])
    assert unit.is_held_back


def test_an_unsent_command_is_withdrawn():
    unit = limiter()
    command(unit, [9.0, 2.0], 1.0, 0.01)
    sent = unit.last
    command(unit, [9.0, 2.0], 1.0, 0.01)
    unit.withdraw()
    np.testing.assert_array_equal(unit.last, sent)


def test_a_limit_lowered_below_the_last_command_is_approached_at_the_rate():
    unit = EffortLimiter(np.array([2.0]), np.array([10.0]), np.ones(1))
    unit.resume([8.0])
    np.testing.assert_allclose(unit.step([9.0], 0.1), [8.0])  # never further beyond it
    np.testing.assert_allclose(unit.step(unit.target(np.array([9.0])), 0.1), [7.0])


def test_a_hundredth_of_the_limit_is_negligible():
    unit = limiter()
    assert unit.is_negligible(np.array([0.1, -0.02]))
    assert not unit.is_negligible(np.array([0.0, 0.021]))
