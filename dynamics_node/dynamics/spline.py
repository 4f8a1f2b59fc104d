"""The slopes of a cubic spline through values, some of whose slopes are known."""

import itertools

import numpy as np


def spline_slopes(time, values, given, slopes):
    """
    Compute the slopes of the cubic spline through some values where they are not given.

    The spline is twice differentiable at every point whose slope is not given. At an end without
    a slope the two outermost pieces are one cubic; if that does not fix the slope, because there
    are no more points, the piece is a parabola, or a line.

    Parameters
    ----------
    time : numpy.ndarray, shape (N,)
        Strictly increasing, s; N >= 2.
    values : numpy.ndarray, shape (N, n)
        n functions of time.
    given : numpy.ndarray of bool, shape (N,)
        Where the slopes are known.
    slopes : numpy.ndarray, shape (N, n)
        Overwritten where they are not given; unit of the values per s. NaN if they are beyond
        what numbers can hold.

    References
    ----------
    docs/mathematics.md, equation (30).

    """
    # A point whose slope is known divides the spline into two that know nothing of each other.
    last = len(time) - 1
    ends = np.union1d(np.flatnonzero(given), [0, last])
    for begin, end in itertools.pairwise(ends):
        if end - begin > 1 or not (given[begin] and given[end]):
            _fill(
                time[begin : end + 1],
                values[begin : end + 1],
                given[[begin, end]],
                slopes[begin : end + 1],
            )


def _fill(time, values, given, slopes):
    if len(time) == 2:
        # scipy would take the secant for the slope of an end that is free.
        secant = (values[1] - values[0]) / (time[1] - time[0])
        if not given[0]:
            slopes[0] = 2.0 * secant - slopes[1] if given[1] else secant
        if not given[1]:
            slopes[1] = 2.0 * secant - slopes[0]
        return
    # Loading it takes as long as loading the rest of the library.
    from scipy.interpolate import CubicSpline

    kinds = tuple(
        (1, slopes[end]) if is_given else 'not-a-knot'
        for end, is_given in zip((0, -1), given, strict=True)
    )
    inner = slice(1 if given[0] else 0, -1 if given[1] else None)
    try:
        slopes[inner] = CubicSpline(time, values, bc_type=kinds)(time, 1)[inner]
    except ValueError:  # slopes beyond what numbers can hold
        slopes[inner] = np.nan
