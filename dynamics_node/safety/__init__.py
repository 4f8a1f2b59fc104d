"""
The path to the arm: measured states in, commands out, and everything that may say no.

Plain classes with the time passed in: no ROS, no thread, no clock of their own. `TorquePath` is
the one that the node uses.

What may change here: when output is allowed and how it starts, is limited and stops. No effort
may be published that did not pass `EffortLimiter`.

"""

from .effort_limiter import EffortLimiter, InvalidEffortError
from .effort_output import EffortOutput, OutputSettings
from .effort_plausibility import EffortAtRest
from .gravity_change import GravityChange
from .joint_state_buffer import JointStateBuffer, RejectedStateError, StampTolerance
from .motion_limits import MotionLimits
from .self_compensation import self_compensating
from .state_machine import OutputState, OutputStateMachine
from .torque_path import TorquePath

__all__ = [
    'EffortAtRest',
    'EffortLimiter',
    'EffortOutput',
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
