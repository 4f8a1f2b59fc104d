"""
Robot dynamics from a URDF: mass matrix, Coriolis matrix, gravity torque. Needs no ROS.

    from dynamics_node import RobotModel
    robot = RobotModel.from_urdf('arm.urdf')
    D, C, G = robot.dynamics(q, qd)

"""

from .dynamics import DynamicsTerms, RobotModel
from .errors import (
    ArgumentError,
    DynamicsError,
    InertiaError,
    RobotDescriptionError,
    SingularMassMatrixError,
)

__version__ = '0.1.0'

__all__ = [
    'ArgumentError', 'DynamicsError', 'DynamicsTerms', 'InertiaError', 'RobotDescriptionError',
    'RobotModel', 'SingularMassMatrixError', '__version__',
]
