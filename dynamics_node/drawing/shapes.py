"""`Shape`: one thing to be drawn, in the base frame."""

from typing import NamedTuple

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
    colour : tuple of float, length 4
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
    colour: tuple
    position: tuple
    orientation: tuple = (0.0, 0.0, 0.0, 1.0)
    points: tuple = ()
    text: str = ''
