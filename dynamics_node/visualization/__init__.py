"""
Shapes that show a robot's masses, inertia, gravity and torques. No ROS, no window.

Shapes, sizes and colors are decided here. Positions come from the model; `markers/` only
translates shapes for RViz.

"""

from .picture import Picture
from .shapes import ARROW, BOX, DISC, LINE, Shape, SPHERE, TEXT

__all__ = ['ARROW', 'BOX', 'DISC', 'LINE', 'SPHERE', 'TEXT', 'Picture', 'Shape']
