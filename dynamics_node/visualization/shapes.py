"""`Shape`: one thing to be drawn, in the base frame."""

from typing import NamedTuple

import numpy as np

SPHERE, BOX, DISC, LINE, ARROW, TEXT = 'sphere', 'box', 'disc', 'line', 'arrow', 'text'


class Shape(NamedTuple):
    """
    One thing to be drawn; a tuple, because dozens of them are made at a time.

    Attributes
    ----------
    group : str
        What it belongs to, so that people can switch it on and off.
    number : int
        Together with the group its name: the next picture's replaces it.
    kind : str
        SPHERE, BOX, DISC (a flat cylinder about z), LINE, ARROW (from the first to the second
        point) or TEXT (that faces who looks).
    size : tuple of float, length 3
        m, > 0. Of a solid along its axes; of a line its width, three times; of an arrow the
        diameters of shaft and head, and the length of the head; of a text the width of a blank
        and its height, twice.
    color : tuple of float, length 4
        Red, green, blue, opacity, 0 to 1.
    position : tuple of float, length 3
        m, base frame.
    orientation : tuple of float, length 4
        Unit quaternion x, y, z, w: shape → base frame.
    points : tuple of (float, float, float)
        Of a line or an arrow, in the frame of the shape, m.
    text : str

    """

    group: str
    number: int
    kind: str
    size: tuple
    color: tuple
    position: tuple
    orientation: tuple = (0.0, 0.0, 0.0, 1.0)
    points: tuple = ()
    text: str = ''


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
