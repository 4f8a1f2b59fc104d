"""
Robot descriptions: URDF text in, checked plain data out; no mathematics of motion.

What may change here: which descriptions are accepted or refused, and the error texts. XML and
yourdfpy stay inside this room.

"""

from .description import Inertial, Joint, Link, Mimic, RobotDescription, Stated
from .partial_read import PartialRead
from .read import examine_urdf, read_urdf

__all__ = [
    'Inertial',
    'Joint',
    'Link',
    'Mimic',
    'PartialRead',
    'RobotDescription',
    'Stated',
    'examine_urdf',
    'read_urdf',
]
