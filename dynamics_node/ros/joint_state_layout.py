"""Whether bytes are laid out as a joint state, found out without building anything."""

import struct

from ..safety import RejectedStateError
from ..safety.joint_state_buffer import MAX_NAMES, too_many_names

# Plain CDR: what ROS 2 middlewares send. The others are for types that can grow.
_COUNTS = {b'\x00\x00': struct.Struct('>I'), b'\x00\x01': struct.Struct('<I')}
# The representation, which is no part of the alignment, and behind it the stamp.
ORIGIN, FRAME = 4, 12
_COUNT = 4
_DOUBLE = 8


def end_of_names(data):
    """
    Prove that bytes are a joint state of a possible size, and return where its names end.

    A million names would keep rclpy, and so the arm, waiting for a second; and for many a wrong
    message it prints a line of its own, however many come.

    Parameters
    ----------
    data : bytes
        As a subscription with `raw=True` delivers it.

    Returns
    -------
    int
        Where the positions begin.

    Raises
    ------
    RejectedStateError
        Kind 'unreadable', 'too many names', or 'length' for more numbers than names can be.

    """
    number = _COUNTS.get(data[:2])
    if number is None:
        raise RejectedStateError(
            'unreadable',
            f'expected plain CDR, got representation {data[:2].hex() or "of no bytes"}',
        )
    try:
        at = _behind_text(data, FRAME, number)
        count, at = _count(data, at, number)
        if count > MAX_NAMES:
            raise too_many_names(count)
        for _ in range(count):
            at = _behind_text(data, at, number)
        end = at
        for what in ('positions', 'velocities', 'efforts'):
            count, at = _count(data, at, number)
            if count > MAX_NAMES:
                raise RejectedStateError(
                    'length', f'expected at most {MAX_NAMES} {what}, got {count}'
                )
            if count:
                at += (ORIGIN - at) % _DOUBLE + count * _DOUBLE
        if at <= len(data):
            return end
    except struct.error:
        # It ends within a count.
        pass
    raise RejectedStateError(
        'unreadable', f'expected a joint state, got {len(data)} bytes that end too early'
    )


def _behind_text(data, at, number):
    (length,) = number.unpack_from(data, at)
    # What follows a text begins at a multiple of four.
    return at + _COUNT + (length + 3) // 4 * 4


def _count(data, at, number):
    return number.unpack_from(data, at)[0], at + _COUNT
