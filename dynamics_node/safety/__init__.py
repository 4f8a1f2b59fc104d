"""
The path to the arm: measured states in, commands out, and every check in between.

Plain classes that receive the time as an argument: no ROS, no thread, no clock. The node uses
`TorquePath`, the effort guard `effort_guard.EffortGuard`.

What may change here: the conditions for output, and its start, limits and stop. Every published
effort passes `EffortLimiter`.

"""

from .driver_checks import EffortPlausibility, self_compensating
from .effort_limiter import EffortLimiter
from .effort_output import EffortOutput, OutputSettings
from .gravity_change import GravityChange
from .joint_state_buffer import JointStateBuffer, StampTolerance
from .motion_limits import MotionLimits
from .state_machine import OutputState, OutputStateMachine
from .torque_path import TorquePath
from ..errors import InvalidEffortError, RejectedStateError

__all__ = [
    'EffortLimiter',
    'EffortOutput',
    'EffortPlausibility',
    'GravityChange',
    'InvalidEffortError',
    'JointStateBuffer',
    'MotionLimits',
    'OutputSettings',
    'OutputState',
    'OutputStateMachine',
    'RejectedStateError',
    'StampTolerance',
    'TorquePath',
    'self_compensating',
]
