"""Which points of a trajectory, and which joints, ask for more effort than they may have."""

from typing import NamedTuple

import numpy as np

from ..errors import ArgumentError


class OverLimit(NamedTuple):
    """
    Where efforts are over their limits.

    Attributes
    ----------
    points : numpy.ndarray of int
        The points at which some joint is, ascending, counted from 0; empty if all is well.
    joints : numpy.ndarray of int
        The joints that are at some point, ascending, counted from 0.
    peak_effort : numpy.ndarray, shape (n,)
        The largest absolute effort of each joint, N m or N.

    """

    points: np.ndarray
    joints: np.ndarray
    peak_effort: np.ndarray


def over_limit(efforts, limits):
    """
    Return which points and joints are over the effort limits.

    Parameters
    ----------
    efforts : array_like, shape (N, n)
        Of N points, N m or N. One that is NaN is not within any limit.
    limits : array_like, shape (n,)
        Largest absolute efforts; NaN: the joint has no limit.

    Returns
    -------
    OverLimit

    Raises
    ------
    ArgumentError
        If there is no point or shapes do not fit, or a limit is negative.

    """
    efforts = np.abs(np.asarray(efforts, dtype=float))
    if efforts.ndim != 2 or len(efforts) == 0:
        raise ArgumentError(
            f'efforts: expected shape (N, n) with at least one point, got {efforts.shape}'
        )
    limits = checked_limits(limits, efforts.shape[1])
    over = ~(efforts <= limits) & ~np.isnan(limits)
    return OverLimit(
        np.flatnonzero(over.any(axis=1)), np.flatnonzero(over.any(axis=0)), efforts.max(axis=0)
    )


def checked_limits(limits, count):
    """
    Return effort limits as an array.

    Parameters
    ----------
    limits : array_like, shape (n,)
        N m or N, not negative; NaN: none.
    count : int
        n.

    Returns
    -------
    numpy.ndarray, shape (n,)

    Raises
    ------
    ArgumentError
        If the shape is another one or a limit is negative.

    """
    limits = np.asarray(limits, dtype=float)
    if limits.shape != (count,):
        raise ArgumentError(
            f'effort limits: expected shape ({count},), one per joint, got {limits.shape}'
        )
    if (limits < 0.0).any():
        joint = int(np.argmax(limits < 0.0))
        raise ArgumentError(
            f'effort limits: joint {joint}: expected at least 0, or NaN for '
            f'none, got {float(limits[joint])}'
        )
    return limits
