"""
Drawing: what the dynamics of a robot look like, as plain shapes. No ROS, no window.

What may change here: shapes, sizes and colors. Where things are comes from the model, and
`markers/`, which sends them to RViz, only translates.

"""

from .picture import Picture
from .shapes import ARROW, BOX, DISC, LINE, Shape, SPHERE, TEXT

__all__ = ['ARROW', 'BOX', 'DISC', 'LINE', 'SPHERE', 'TEXT', 'Picture', 'Shape']
