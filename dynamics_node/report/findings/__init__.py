"""
What is wrong with a robot or worth knowing, each with what it does to this robot.

What may change here: what is looked for and where the lines are drawn. `kinds.py` lists every
kind; docs/report.md explains them.

"""

from .find_all import find_all
from .kinds import KINDS

__all__ = ['KINDS', 'find_all']
