"""
The library's face: checked arrays and words in, kernels underneath.

What may change here: argument checks, shapes, and quantities composed from D, C and G.

"""

from .friction import Friction
from .held_joints import forward_dynamics_held
from .joint_selection import JointSelection
from .payload import Payload
from .robot_model import RobotModel
from .terms import DynamicsTerms

__all__ = ['DynamicsTerms', 'Friction', 'JointSelection', 'Payload', 'RobotModel',
           'forward_dynamics_held']
