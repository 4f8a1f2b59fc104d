"""
Robot descriptions: URDF text in, checked plain data out. No mathematics of motion in here.

What may change here: what is accepted, what is refused, and the words that say why. Nothing
outside this room sees XML or yourdfpy.

"""

from .description import Inertial, Joint, Link, Mimic, RobotDescription
from .read import read_urdf

__all__ = ['Inertial', 'Joint', 'Link', 'Mimic', 'RobotDescription', 'read_urdf']
