"""
The slopes of a cubic spline, equation (30) of docs/mathematics.md.

scipy has cubic splines too. But importing it takes a third of a second, and a node that holds an
arm may not stand still that long when the first trajectory arrives; nor does scipy take slopes
in the middle.

"""

import numpy as np

from .jit import compiled, formula


@compiled
def spline_slopes(time, values, given, slopes):
    """
    Compute the slopes of the cubic spline through some values where they are not given.

    The spline is twice differentiable at every point whose slope is not given. At an end without
    a slope the two outermost pieces are one cubic; if that does not fix the slope, because the
    slope of the neighbour is given or there are no more points, the outermost piece is a parabola,
    or a line.

    Parameters
    ----------
    time : numpy.ndarray, shape (N,)
        Strictly increasing, s; N >= 2.
    values : numpy.ndarray, shape (N, n)
        n functions of time.
    given : numpy.ndarray of bool, shape (N,)
        Where the slopes are known.
    slopes : numpy.ndarray, shape (N, n)
        Overwritten where they are not given; unit of the values per s.

    """
    # Row i of the equations: below * m[i - 1] + middle * m[i] + above[i] * m[i + 1] = slopes[i],
    # solved by Gauss without exchanging rows: no pivot vanishes, the middle outweighs the sides.
    last = len(time) - 1
    above = np.zeros(last + 1)
    for i in range(last + 1):
        below, middle = 0.0, 1.0
        if not given[i]:
            if i == 0:
                middle, above[i] = _end_row(time, values, given, i, 1, slopes)
            elif i == last:
                middle, below = _end_row(time, values, given, i, -1, slopes)
            else:
                below, middle, above[i] = _middle_row(time, values, i, slopes)
        if below != 0.0:
            middle -= below * above[i - 1]
            slopes[i] -= below * slopes[i - 1]
        above[i] /= middle
        slopes[i] /= middle
    for i in range(last - 1, -1, -1):
        if above[i] != 0.0:
            slopes[i] -= above[i] * slopes[i + 1]


@formula
def _middle_row(time, values, i, slopes):
    # The second derivatives from both sides are the same.
    h, k = time[i] - time[i - 1], time[i + 1] - time[i]
    slopes[i] = 3.0 * (k * ((values[i] - values[i - 1]) / h)
                       + h * ((values[i + 1] - values[i]) / k))
    return k, 2.0 * (h + k), h


@formula
def _end_row(time, values, given, i, side, slopes):
    # Mirrored at the right end, where `side` is -1: all steps and slopes change their signs.
    last, a, b = len(time) - 1, i + side, i + 2 * side
    h = abs(time[a] - time[i])
    first = side * ((values[a] - values[i]) / h)
    if last == 1 and not given[a]:  # a line
        slopes[i] = first
        return 1.0, 0.0
    if last == 1 or given[a] or (last == 2 and not given[b]):  # a parabola
        slopes[i] = 2.0 * first
        return 1.0, 1.0
    k = abs(time[b] - time[a])
    second = side * ((values[b] - values[a]) / k)
    slopes[i] = ((3.0 * h + 2.0 * k) * k * first + h * h * second) / (h + k)
    return k, h + k
