"""
Robot dynamics from a URDF: mass matrix, Coriolis matrix, gravity torque. Needs no ROS.

    from dynamics_node import RobotModel
    robot = RobotModel.from_urdf('arm.urdf')
    D, C, G = robot.dynamics(q, qd)

"""

from typing import TYPE_CHECKING

from .errors import (
    ArgumentError,
    DynamicsError,
    InertiaError,
    RobotDescriptionError,
    SingularMassMatrixError,
)

if TYPE_CHECKING:
    from .dynamics import DynamicsTerms, MomentumObserver, RobotModel

__version__ = '0.1.0'

__all__ = [
    'ArgumentError', 'DynamicsError', 'DynamicsTerms', 'InertiaError', 'MomentumObserver',
    'RobotDescriptionError', 'RobotModel', 'SingularMassMatrixError', '__version__',
]


def __getattr__(name):
    # Loaded on first use: numba takes a second, and not everything in here needs it.
    if name in ('DynamicsTerms', 'MomentumObserver', 'RobotModel'):
        from . import dynamics
        return getattr(dynamics, name)
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
