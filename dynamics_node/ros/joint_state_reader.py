"""Joint states from the bytes on the wire: the names once, the numbers every time."""

from array import array
import struct
import sys

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from .joint_state_layout import end_of_names, FRAME, ORIGIN

# The representation that every ROS 2 middleware sends: plain CDR, little endian, no options.
# Only that is read here, and only where the machine stores numbers in the same way.
_REPRESENTATION = b'\x00\x01\x00\x00' if sys.byteorder == 'little' else b''
_STAMP = struct.Struct('<iI')
_COUNT = struct.Struct('<I')


class JointStateReader:
    """
    Reads a stream of serialised joint states of the same joints.

    rclpy makes a new message of new strings from every state. A robot's states differ in stamp
    and numbers alone, so frame and names are compared as bytes, and read by rclpy only when
    they are new. Whatever is not as expected is left to rclpy, if it is a joint state at all.

    """

    def __init__(self):
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
            The same object every time, so it holds until the next call.

        Raises
        ------
        RejectedStateError
            If it is no joint state, or says that it has more names or numbers than any robot:
            before anything is made of them.
        Exception
            What rclpy raises if it finds fault with it all the same.

        """
        if data[FRAME:self._end] == self._names and data[:ORIGIN] == _REPRESENTATION:
            position, at = _doubles(data, self._end)
            velocity, at = _doubles(data, at)
            if at <= len(data):
                message, stamp = self._message, self._message.header.stamp
                stamp.sec, stamp.nanosec = _STAMP.unpack_from(data, ORIGIN)
                message.position, message.velocity = position, velocity
                effort, end = _doubles(data, at)
                message.effort = effort if end <= len(data) else array('d')
                return message
        return self._learn(data)

    def _learn(self, data):
        end = end_of_names(data)
        message = deserialize_message(data, JointState)
        self._names = None
        if data[:ORIGIN] == _REPRESENTATION and message.name:
            self._message, self._end, self._names = message, end, data[FRAME:end]
        return message


def _doubles(data, at):
    # Numbers and where they end: beyond the end of the data if that was cut.
    if at + _COUNT.size > len(data):
        return None, len(data) + 1
    count, = _COUNT.unpack_from(data, at)
    at += _COUNT.size
    values = array('d')
    if count:
        at += (ORIGIN - at) % values.itemsize  # numbers of eight bytes begin at a multiple of it
        end = at + count * values.itemsize
        if end <= len(data):
            values.frombytes(data[at:end])
        at = end
    return values, at
