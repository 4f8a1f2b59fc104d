"""
The public library: checked arguments, errors in words, kernels underneath.

`robot_model` is the API page, `batch` chooses between kernel and machine code; the other modules
compose quantities from D, C and G.

What may change here: argument checks, shapes, and quantities composed from D, C and G.

"""

from .batch import DynamicsTerms
from .compensation import Compensation
from .effort_limits import MaxPayload, over_limit, OverLimit
from .friction import Friction
from .joint_selection import JointSelection
from .locked_joints import forward_dynamics_locked
from .momentum_observer import MomentumObserver
from .payload import Payload
from .robot_model import RobotModel
from .trajectory import complete_trajectory, Trajectory

__all__ = [
    'Compensation',
    'DynamicsTerms',
    'Friction',
    'JointSelection',
    'MaxPayload',
    'MomentumObserver',
    'OverLimit',
    'Payload',
    'RobotModel',
    'Trajectory',
    'complete_trajectory',
    'forward_dynamics_locked',
    'over_limit',
]
