"""Joint states from serialized bytes (CDR): names are parsed once, numbers every time."""

from array import array
import struct
import sys

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from ...safety import RejectedStateError
from ...safety.joint_state_buffer import MAX_NAMES, too_many_names

# The representation that every ROS 2 middleware sends: plain CDR, little endian, no options.
# Only that is read here, and only where the machine stores numbers in the same way.
_REPRESENTATION = b'\x00\x01\x00\x00' if sys.byteorder == 'little' else b''
_STAMP = struct.Struct('<iI')


class JointStateReader:
    """
    Reads a stream of serialized joint states of the same joints.

    rclpy makes a new message of new strings from every state. A robot's states differ in stamp
    and numbers alone, so frame and names are compared as bytes, and read by rclpy only when
    they are new. Unexpected bytes are left to rclpy, if they are a joint state at all.

    """

    def __init__(self):
        self._message = JointState()
        self._names = None
        self._end = 0
        # Of positions, velocities and efforts in the last state: where their number is, as bytes,
        # and where they are; and how long that state was.
        self._spans: list[tuple[slice, bytes, slice]] = []
        self._length = sys.maxsize

    def read(self, data):
        """
        Return a serialized joint state as a message.

        Parameters
        ----------
        data : bytes
            As a subscription with `raw=True` delivers it.

        Returns
        -------
        sensor_msgs.msg.JointState
            The same object every time, so it holds until the next call.

        Raises
        ------
        RejectedStateError
            If it is no joint state, or says that it has more names or numbers than any robot:
            before anything is made of them.
        Exception
            What rclpy raises if it finds fault with it all the same.

        """
        if data[FRAME : self._end] == self._names and data[:ORIGIN] == _REPRESENTATION:
            numbers = self._as_before(data) or self._measure(data)
            if numbers is not None:
                message, stamp = self._message, self._message.header.stamp
                stamp.sec, stamp.nanosec = _STAMP.unpack_from(data, ORIGIN)
                message.position, message.velocity, message.effort = numbers
                return message
        return self._learn(data)

    def _as_before(self, data):
        # The numbers if they have the offsets of the last state; None if not.
        if len(data) < self._length:
            return None
        numbers = []
        for place, count, span in self._spans:
            if data[place] != count:
                return None
            numbers.append(array('d', data[span]))
        return numbers

    def _measure(self, data):
        # The numbers at newly found offsets; None if the data ends before the efforts.
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

    def _learn(self, data):
        end = end_of_names(data)
        message = deserialize_message(data, JointState)
        self._names = None
        self._length = sys.maxsize
        if data[:ORIGIN] == _REPRESENTATION and message.name:
            self._message, self._end, self._names = message, end, data[FRAME:end]
        return message


def _span(data, at):
    # Where a count and the numbers behind it are: beyond the end of the data if that was cut.
    place = slice(at, at + _COUNT)
    if place.stop > len(data):
        return place, slice(place.stop, place.stop)
    (count,) = _LITTLE_ENDIAN.unpack_from(data, at)
    begin = place.stop
    if count:
        begin += (ORIGIN - begin) % _DOUBLE  # numbers begin at a multiple of their size
    return place, slice(begin, begin + count * _DOUBLE)


# Plain CDR: what ROS 2 middlewares send. The others are for types that can grow.
_COUNTS = {b'\x00\x00': struct.Struct('>I'), b'\x00\x01': struct.Struct('<I')}
# The representation, which is no part of the alignment, and behind it the stamp.
ORIGIN, FRAME = 4, 12
_COUNT = 4
_LITTLE_ENDIAN = struct.Struct('<I')
_DOUBLE = 8


def end_of_names(data):
    """
    Check that bytes are a joint state of a possible size, and return the end of its names.

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
