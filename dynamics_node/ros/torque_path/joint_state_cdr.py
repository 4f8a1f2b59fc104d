"""
Joint states from their serialized bytes (CDR): names once, numbers at every message.

`JointStateReader` makes messages; `end_of_names` checks the size of an unknown message before
rclpy allocates its names and numbers.

"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
import struct
import sys

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from ...safety import RejectedStateError
from ...safety.joint_state_buffer import MAX_NAMES, too_many_names

# Offset behind the representation, which is not part of the alignment: there the stamp begins.
ORIGIN = 4
# Offset behind the stamp: there the frame begins.
FRAME = 12
# Size of a count, bytes.
_COUNT = 4
# Size and alignment of a number, bytes.
_DOUBLE = 8
# The fast path reads plain CDR, little endian, no options, which every ROS 2 middleware sends,
# and only where the machine stores numbers in the same way.
_REPRESENTATION = b'\x00\x01\x00\x00' if sys.byteorder == 'little' else b''
_STAMP = struct.Struct('<iI')
_LITTLE_ENDIAN = struct.Struct('<I')
# Representation → count, of plain CDR; the other representations are for extensible types.
_COUNTS = {b'\x00\x00': struct.Struct('>I'), b'\x00\x01': _LITTLE_ENDIAN}


class JointStateReader:
    """
    Reads a stream of serialized joint states of the same joints.

    rclpy makes a new message with new strings from every state. The states of a robot differ
    only in stamp and numbers, so frame and names are compared as bytes, and deserialized only
    when they have changed. Unexpected bytes are passed to rclpy if they are a joint state.

    """

    def __init__(self) -> None:
        self._message = JointState()
        self._names: bytes | None = None
        self._end = 0
        # Of positions, velocities and efforts in the last state: place of their count, the count
        # as bytes, and place of the numbers.
        self._spans: list[tuple[slice, bytes, slice]] = []
        # Length of the last state, bytes.
        self._length = sys.maxsize

    def read(self, data: bytes) -> JointState:
        """
        Return a serialized joint state as a message.

        Parameters
        ----------
        data : bytes
            As a subscription with `raw=True` delivers it.

        Returns
        -------
        sensor_msgs.msg.JointState
            Valid until the next call, which reuses the object.

        Raises
        ------
        RejectedStateError
            If the bytes are not a joint state, or claim more names or numbers than a robot can
            have; raised before these are allocated.
        Exception
            From rclpy, if it cannot deserialize the message.

        """
        if data[FRAME : self._end] == self._names and data[:ORIGIN] == _REPRESENTATION:
            numbers = self._as_before(data) or self._measure(data)
            if numbers is not None:
                message, stamp = self._message, self._message.header.stamp
                stamp.sec, stamp.nanosec = _STAMP.unpack_from(data, ORIGIN)
                message.position, message.velocity, message.effort = numbers
                return message
        return self._learn(data)

    def _as_before(self, data: bytes) -> Sequence[array] | None:
        # The numbers if they have the places of the last state; None if not.
        if len(data) < self._length:
            return None
        numbers = []
        for place, count, span in self._spans:
            if data[place] != count:
                return None
            numbers.append(array('d', data[span]))
        return numbers

    def _measure(self, data: bytes) -> Sequence[array] | None:
        # The numbers, at any places; None if the data ends before the efforts.
        spans, at = [], self._end
        for _ in range(3):
            place, span = _span(data, at)
            spans.append((place, data[place], span))
            at = span.stop
        (_, _, positions), (_, _, velocities), (_, _, efforts) = spans
        if velocities.stop > len(data):
            return None
        if efforts.stop > len(data):
            return array('d', data[positions]), array('d', data[velocities]), array('d')
        self._spans, self._length = spans, efforts.stop
        return [array('d', data[span]) for _, _, span in spans]

    def _learn(self, data: bytes) -> JointState:
        end = end_of_names(data)
        message = deserialize_message(data, JointState)
        self._names = None
        self._length = sys.maxsize
        if data[:ORIGIN] == _REPRESENTATION and message.name:
            self._message, self._end, self._names = message, end, data[FRAME:end]
        return message


def end_of_names(data: bytes) -> int:
    """
    Check that bytes are a joint state of a possible size, and return where its names end.

    Deserializing a million names would block the process, and so the arm, for a second; and for
    many malformed messages rclpy prints an unthrottled line.

    Parameters
    ----------
    data : bytes
        As a subscription with `raw=True` delivers it.

    Returns
    -------
    int
        Offset of the positions, bytes.

    Raises
    ------
    RejectedStateError
        Kind 'unreadable', 'too many names', or 'length' for more numbers than MAX_NAMES.

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
        for quantity in ('positions', 'velocities', 'efforts'):
            count, at = _count(data, at, number)
            if count > MAX_NAMES:
                raise RejectedStateError(
                    'length', f'expected at most {MAX_NAMES} {quantity}, got {count}'
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


def _span(data: bytes, at: int) -> tuple[slice, slice]:
    # Places of a count and of the numbers behind it; beyond the end of data that was cut.
    place = slice(at, at + _COUNT)
    if place.stop > len(data):
        return place, slice(place.stop, place.stop)
    (count,) = _LITTLE_ENDIAN.unpack_from(data, at)
    begin = place.stop
    if count:
        begin += (ORIGIN - begin) % _DOUBLE  # numbers begin at a multiple of their size
    return place, slice(begin, begin + count * _DOUBLE)


def _behind_text(data: bytes, at: int, number: struct.Struct) -> int:
    (length,) = number.unpack_from(data, at)
    # The field behind a text begins at a multiple of four.
    return at + _COUNT + (length + 3) // 4 * 4


def _count(data: bytes, at: int, number: struct.Struct) -> tuple[int, int]:
    return number.unpack_from(data, at)[0], at + _COUNT
