"""
Robot dynamics from a URDF: mass matrix, Coriolis matrix, gravity torque and derived quantities.

Needs no ROS.

    from dynamics_node import RobotModel
    robot = RobotModel.from_urdf('arm.urdf')
    D, C, G = robot.dynamics(q, qd)

"""

from typing import Any, TYPE_CHECKING

from .errors import (
    ArgumentError,
    DynamicsError,
    InertiaError,
    RobotDescriptionError,
    SingularMassMatrixError,
)

# For editors and type checkers; at run time `__getattr__` does it.
if TYPE_CHECKING:
    from .dynamics import (
        complete_trajectory,
        DynamicsTerms,
        Friction,
        MaxPayload,
        MomentumObserver,
        over_limit,
        OverLimit,
        Payload,
        RobotModel,
        Trajectory,
    )

__version__ = '0.2.0'

__all__ = [
    'ArgumentError',
    'DynamicsError',
    'DynamicsTerms',
    'Friction',
    'InertiaError',
    'MaxPayload',
    'MomentumObserver',
    'OverLimit',
    'Payload',
    'RobotDescriptionError',
    'RobotModel',
    'SingularMassMatrixError',
    'Trajectory',
    '__version__',
    'complete_trajectory',
    'over_limit',
]


def __getattr__(name: str) -> Any:
    # Loaded on first use: importing numba takes a second, and some modules do without it.
    if name in __all__:
        from . import dynamics

        return getattr(dynamics, name)
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
