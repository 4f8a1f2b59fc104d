"""`Shape`: one primitive to draw, in the base frame."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .colors import Color

SPHERE, BOX, DISC, LINE, ARROW, TEXT = 'sphere', 'box', 'disc', 'line', 'arrow', 'text'


class Shape(NamedTuple):
    """
    One primitive to draw; a tuple, because dozens of them are created per picture.

    Attributes
    ----------
    group : str
        The set of shapes that a viewer shows or hides together.
    number : int
        Identifies the shape in its group; the shape of the next picture replaces it.
    kind : str
        SPHERE, BOX, DISC (a flat cylinder about z), LINE, ARROW (from the first to the second
        point) or TEXT (facing the viewer).
    size : tuple of float, length 3
        m, > 0. Solid: lengths along its axes. Line: its width, three times. Arrow: diameters of
        shaft and head, length of the head. Text: width of a blank, height, height.
    color : tuple of float, length 4
        Red, green, blue, opacity, 0 to 1.
    position : tuple of float, length 3
        m, base frame.
    orientation : tuple of float, length 4
        Unit quaternion x, y, z, w: shape → base frame.
    points : tuple of (float, float, float)
        Points of a line or an arrow in the frame of the shape, m.
    text : str

    """

    group: str
    number: int
    kind: str
    size: tuple[float, ...]
    color: Color
    position: tuple[float, ...]
    orientation: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0)
    points: tuple[tuple[float, ...], ...] = ()
    text: str = ''


def frame_around(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return a frame with a given z axis.

    Its x axis is nearest to the coordinate axis most nearly perpendicular to z. For the axes
    common on robots, the choice does not depend on rounding.

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
