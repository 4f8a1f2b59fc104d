"""
The library's face: checked arrays and words in, kernels underneath.

What may change here: argument checks, shapes, and quantities composed from D, C and G.

"""

from .friction import Friction
from .joint_selection import JointSelection
from .momentum_observer import MomentumObserver
from .payload import Payload
from .robot_model import RobotModel
from .terms import DynamicsTerms

__all__ = ['DynamicsTerms', 'Friction', 'JointSelection', 'MomentumObserver', 'Payload',
           'RobotModel']
