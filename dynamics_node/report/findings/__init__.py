"""
Findings: errors and oddities of a robot description, each with its effect on this robot.

What may change here: the checks and their thresholds. `kinds.py` lists every kind of finding;
docs/report.md explains them.

"""

from .find_all import find_all
from .kinds import KINDS

__all__ = ['KINDS', 'find_all']
