"""Rotations as quaternions, and frames around an axis."""

import numpy as np


def quaternions(rotations):
    """
    Return the unit quaternions of rotation matrices.

    Parameters
    ----------
    rotations : numpy.ndarray, shape (K, 3, 3)

    Returns
    -------
    numpy.ndarray, shape (K, 4)
        x, y, z, w; the larger part of each is exact however far the rotation turns.

    """
    m = np.asarray(rotations, dtype=float)
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    # Four times the products of the quaternion's parts with each other: each row is the
    # quaternion, times four of one part. That of the largest part loses no digits.
    rows = np.empty((len(m), 4, 4))
    rows[:, 0, 0] = 1.0 + xx - yy - zz
    rows[:, 1, 1] = 1.0 - xx + yy - zz
    rows[:, 2, 2] = 1.0 - xx - yy + zz
    rows[:, 3, 3] = 1.0 + xx + yy + zz
    for i, j, value in (
        (0, 1, m[:, 0, 1] + m[:, 1, 0]),
        (0, 2, m[:, 0, 2] + m[:, 2, 0]),
        (1, 2, m[:, 1, 2] + m[:, 2, 1]),
        (0, 3, m[:, 2, 1] - m[:, 1, 2]),
        (1, 3, m[:, 0, 2] - m[:, 2, 0]),
        (2, 3, m[:, 1, 0] - m[:, 0, 1]),
    ):
        rows[:, i, j] = rows[:, j, i] = value
    largest = np.argmax(np.diagonal(rows, axis1=1, axis2=2), axis=1)
    found = rows[np.arange(len(m)), largest]
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def frame_around(axis):
    """
    Return a frame whose z axis is a given one.

    Its x axis is as near as can be to the coordinate axis that is the most across, so that it
    does not depend on rounding for the axes that robots have.

    Parameters
    ----------
    axis : numpy.ndarray, shape (3,)
        Unit vector.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        Rotation: columns x, y, z.

    """
    x = np.zeros(3)
    x[np.argmin(np.round(np.abs(axis), 6))] = 1.0
    x -= (x @ axis) * axis
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])
