"""Slopes of the spline: polynomials, scipy's own, and points whose slopes are known."""

from dynamics_node.dynamics.spline import spline_slopes
import numpy as np
import pytest
from scipy.interpolate import CubicSpline


def points(seed, count, columns=3):
    """Return times in uneven steps and values, and slopes to be given."""
    rng = np.random.default_rng(seed)
    time = rng.normal() + np.cumsum(rng.uniform(0.05, 1.0, count))
    return time, rng.normal(size=(count, columns)), rng.normal(size=(count, columns))


def ours(time, values, slopes, *given):
    """Return the slopes where some are given."""
    mask = np.zeros(len(time), dtype=bool)
    mask[list(given)] = True
    result = np.where(mask[:, None], slopes, np.nan)
    spline_slopes(time, values, mask, result)
    return result


def scipys(time, values, begin=None, end=None):
    """Return the slopes of scipy's spline; an end without a slope is not a knot."""
    ends = ['not-a-knot' if slope is None else (1, slope) for slope in (begin, end)]
    return CubicSpline(time, values, bc_type=tuple(ends))(time, 1)


@pytest.mark.parametrize('count', [2, 3, 4, 5, 6, 50])
def test_nothing_given_is_the_spline_that_is_not_a_knot_at_the_ends(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes), scipys(time, values), rtol=1e-9, atol=1e-9
    )


@pytest.mark.parametrize('count', [2, 3, 4, 5, 6, 50])
def test_slopes_at_both_ends_clamp_it(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes, 0, count - 1),
        scipys(time, values, slopes[0], slopes[-1]),
        rtol=1e-9,
        atol=1e-9,
    )


@pytest.mark.parametrize('count', [4, 5, 6, 50])
def test_a_slope_at_one_end_clamps_that_end(count):
    time, values, slopes = points(count, count)
    np.testing.assert_allclose(
        ours(time, values, slopes, 0), scipys(time, values, begin=slopes[0]), rtol=1e-9, atol=1e-9
    )
    np.testing.assert_allclose(
        ours(time, values, slopes, count - 1),
        scipys(time, values, end=slopes[-1]),
        rtol=1e-9,
        atol=1e-9,
    )


def test_a_slope_in_the_middle_makes_two_splines_that_do_not_know_of_each_other():
    time, values, slopes = points(1, 20)
    actual = ours(time, values, slopes, 0, 7, 19)
    left = scipys(time[:8], values[:8], slopes[0], slopes[7])
    right = scipys(time[7:], values[7:], slopes[7], slopes[19])
    np.testing.assert_allclose(actual, np.concatenate((left, right[1:])), rtol=1e-9, atol=1e-9)


def test_slopes_that_are_given_stay_bit_for_bit():
    time, values, slopes = points(2, 9)
    given = (0, 3, 4, 8)
    np.testing.assert_array_equal(
        ours(time, values, slopes, *given)[list(given)], slopes[list(given)]
    )
    np.testing.assert_array_equal(ours(time, values, slopes, *range(9)), slopes)


@pytest.mark.parametrize(
    ('count', 'given', 'degree'),
    [
        (2, (), 1),
        (2, (0,), 2),
        (2, (1,), 2),
        (2, (0, 1), 3),
        (3, (), 2),
        (3, (0,), 3),
        (3, (2,), 3),
        (3, (1,), 2),
        (4, (), 3),
        (5, (1,), 2),
        (5, (2,), 3),
        (5, (0, 4), 3),
    ],
)
def test_polynomials_come_back_exactly_up_to_the_degree_that_the_data_fix(count, given, degree):
    time, _, _ = points(count, count)
    polynomial = np.polynomial.Polynomial(np.arange(1.0, degree + 2.0))
    values, slopes = polynomial(time)[:, None], polynomial.deriv()(time)[:, None]
    np.testing.assert_allclose(ours(time, values, slopes, *given), slopes, rtol=1e-10)
    # And not beyond: the next power is not reproduced, or the data fix more than was said.
    if (count, given) != (2, (0, 1)) and degree < 3:
        cube = time[:, None] ** (degree + 1)
        slope = (degree + 1) * time[:, None] ** degree
        assert np.abs(ours(time, cube, slope, *given) - slope).max() > 1e-3


def test_steps_of_very_different_lengths_keep_their_digits():
    # A cubic is its own spline, wherever the points are.
    time = np.cumsum([0.0, 1e-3, 1.0, 1e-4, 1e-4, 2.0, 1e-3, 1e-3])
    values, slopes = time[:, None] ** 3, 3.0 * time[:, None] ** 2
    np.testing.assert_allclose(ours(time, values, slopes), slopes, rtol=1e-8, atol=1e-8)


def test_no_joints_are_no_joints():
    assert ours(np.arange(4.0), np.zeros((4, 0)), np.zeros((4, 0))).shape == (4, 0)
