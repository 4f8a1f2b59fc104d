"""
Robot descriptions: URDF text in, checked plain data out. No mathematics of motion in here.

What may change here: what is accepted, what is refused, and the words that say why. Nothing
outside this room sees XML or yourdfpy.

"""

from .description import Inertial, Joint, Link, Mimic, RobotDescription, Stated
from .partial_read import Examination
from .read import examine_urdf, read_urdf

__all__ = [
    'Examination',
    'Inertial',
    'Joint',
    'Link',
    'Mimic',
    'RobotDescription',
    'Stated',
    'examine_urdf',
    'read_urdf',
]
