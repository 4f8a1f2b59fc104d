"""Joint states from the bytes on the wire: the names once, the numbers every time."""

from array import array
import struct
import sys

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from ..output.joint_state_buffer import MAX_NAMES, too_many_names

# The representation that every ROS 2 middleware sends: plain CDR, little endian, no options.
# Only that is read here, and only where the machine stores numbers in the same way.
_REPRESENTATION = b'\x00\x01\x00\x00' if sys.byteorder == 'little' else b''
_STAMP = struct.Struct('<iI')
_COUNT = struct.Struct('<I')
# Behind the representation, which is no part of the alignment, and the stamp.
_ORIGIN, _FRAME = 4, 12


class JointStateReader:
    """
    Reads a stream of serialised joint states of the same joints.

    rclpy makes a new message of new strings from every state. A robot's states differ in stamp
    and numbers alone, so frame and names are compared as bytes, and read by rclpy only when
    they are new. Whatever is not as expected is left to rclpy.

    """

    def __init__(self):
        """Know no names yet."""
        self._message = JointState()
        self._names = None
        self._end = 0

    def read(self, data):
        """
        Return a serialised joint state as a message.

        Parameters
        ----------
        data : bytes
            As a subscription with `raw=True` delivers it.

        Returns
        -------
        sensor_msgs.msg.JointState
            Without effort; the same object every time, so it holds until the next call.

        Raises
        ------
        RejectedStateError
            If it says that it has more names than any robot: before anything is made of them.
        Exception
            What rclpy raises if it is no joint state.

        """
        if data[_FRAME:self._end] == self._names and data[:_ORIGIN] == _REPRESENTATION:
            position, at = _doubles(data, self._end)
            velocity, at = _doubles(data, at)
            if at <= len(data):
                message, stamp = self._message, self._message.header.stamp
                stamp.sec, stamp.nanosec = _STAMP.unpack_from(data, _ORIGIN)
                message.position, message.velocity = position, velocity
                return message
        return self._learn(data)

    def _learn(self, data):
        if data[:_ORIGIN] == _REPRESENTATION:
            _refuse_too_many(data)
        message = deserialize_message(data, JointState)
        message.effort = []
        self._names = None
        if data[:_ORIGIN] == _REPRESENTATION and message.name:
            self._message, self._end = message, _end_of_names(data)
            self._names = data[_FRAME:self._end]
        return message


def _refuse_too_many(data):
    # A million names would keep rclpy, and so the arm, waiting for a second.
    at = _end_of_text(data, _FRAME) if len(data) >= _FRAME + _COUNT.size else len(data)
    if at + _COUNT.size <= len(data):
        count, = _COUNT.unpack_from(data, at)
        if count > MAX_NAMES:
            raise too_many_names(count)


def _end_of_names(data):
    at = _end_of_text(data, _FRAME)
    count, = _COUNT.unpack_from(data, at)
    at += _COUNT.size
    for _ in range(count):
        at = _end_of_text(data, at)
    return at


def _end_of_text(data, at):
    length, = _COUNT.unpack_from(data, at)
    # What follows a text begins at a multiple of four.
    return at + _COUNT.size + (length + 3) // 4 * 4


def _doubles(data, at):
    # Numbers and where they end: beyond the end of the data if that was cut.
    if at + _COUNT.size > len(data):
        return None, len(data) + 1
    count, = _COUNT.unpack_from(data, at)
    at += _COUNT.size
    values = array('d')
    if count:
        at += (_ORIGIN - at) % values.itemsize  # numbers of eight bytes begin at a multiple of it
        end = at + count * values.itemsize
        if end <= len(data):
            values.frombytes(data[at:end])
        at = end
    return values, at
