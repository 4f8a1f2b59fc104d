"""
The path to the arm: measured states in, commands out, and everything that may say no.

Plain classes with the time passed in: no ROS, no thread, no clock of their own.

What may change here: when output is allowed and how it starts, is limited and stops. Nothing may
publish an effort that did not pass `EffortLimiter`.

"""

from .effort_at_rest import EffortAtRest
from .effort_limiter import EffortLimiter, InvalidEffortError
from .effort_output import EffortOutput
from .intake import take_state
from .joint_state_buffer import JointStateBuffer
from .motion_limits import MotionLimits
from .rejected import RejectedStateError
from .stamps import StampTolerance
from .state_machine import OutputState, OutputStateMachine

__all__ = [
    'EffortAtRest',
    'EffortLimiter',
    'EffortOutput',
    'InvalidEffortError',
    'JointStateBuffer',
    'MotionLimits',
    'OutputState',
    'OutputStateMachine',
    'RejectedStateError',
    'StampTolerance',
    'take_state',
]
