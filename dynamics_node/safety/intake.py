"""What one joint state means for the output, decided in one place."""

from .motion_limits import VELOCITY_MARGIN
from .rejected import RejectedStateError


def take_state(buffer, channel, now, names, positions, velocities=(), stamp=0, clock=0,
               efforts=None):
    """
    Take a message into the buffer, and stop or restart the output if it says so.

    Parameters
    ----------
    buffer : JointStateBuffer
    channel : EffortOutput
    now : float
        Arrival on the steady clock, s.
    names, positions, velocities, stamp, clock, efforts
        See `JointStateBuffer.update`.

    Returns
    -------
    bool
        Whether a torque may be computed from what the buffer now holds.

    Raises
    ------
    RejectedStateError
        If the message was dropped.

    """
    try:
        back = buffer.follow_clock(clock)
        if back:
            channel.restart(now, f'the clock went back by {back:.3f} s, measured states dropped')
        buffer.update(now, names, positions, velocities, stamp, clock, efforts)
    except RejectedStateError as error:
        if error.is_fault:
            channel.fault(now, str(error))
        raise
    fast = buffer.runaway()
    if fast:
        channel.fault(now, f'runaway: {fast}, more than {VELOCITY_MARGIN:g} times the velocity '
                           'limit')
    return buffer.is_complete and buffer.age(now) <= channel.settings.state_timeout
