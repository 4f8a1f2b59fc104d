"""The second door: a stream of serialised joint states, as the node takes them from its topic."""

from array import array
from itertools import count
import math

from dynamics_node.output import JointStateBuffer, RejectedStateError
from dynamics_node.ros.joint_state_reader import JointStateReader
import numpy as np
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from .audit import nothing_opened
from .first_words import first_words
from .joint_states import JOINTS, streams

NAME = 'joint states'
SUFFIX = '.hex'
# What rclpy raises where the bytes are no message.
_NO_MESSAGE = rclpy_implementation.RMWError
# The last joint is measured, but nothing depends on it.
_NEEDED = JOINTS[:3]
_PERIOD = 0.01


def inputs():
    """Return the strategy of inputs."""
    return streams()


def warm_up():
    """Load whatever is loaded lazily."""
    data = bytes.fromhex('00010000') + bytes(28)
    for _ in range(2):
        _answer([data, b''])


def to_bytes(stream):
    """Return an input as the content of a file: a line of hexadecimal digits per message."""
    return ''.join(data.hex() + '\n' for data in stream).encode()


def from_bytes(data):
    """Return the input that `to_bytes` has written."""
    return [bytes.fromhex(line) for line in data.decode().splitlines()]


def check(stream):
    """
    Put a stream of messages through the door.

    Returns
    -------
    str
        How the last of them was answered: 'taken', or the first words of what is wrong.

    Raises
    ------
    Exception
        Anything that is no answer: the finding.

    """
    with nothing_opened():
        return _answer(stream)


def _answer(stream):
    reader = JointStateReader()
    buffer = JointStateBuffer(JOINTS, _NEEDED, np.zeros(len(JOINTS)))
    answer = ''
    for data, tick in zip(stream, count()):
        before = _state(buffer)
        answer = _receive(reader, buffer, data, tick * _PERIOD)
        after = _state(buffer)
        if answer != 'taken':
            assert after == before, f'a refused message changed {before} to {after}'
        _judge(buffer)
    return answer


def _receive(reader, buffer, data, now):
    message = _read(reader, data)
    if message is None:
        return 'refused: no joint state'
    try:
        buffer.update(now, message.name, message.position, message.velocity)
    except RejectedStateError as error:
        return f'refused: {error.kind}: {first_words(str(error))}'
    return 'taken'


def _read(reader, data):
    # What rclpy reads is right; only efforts, which nobody needs, may be missing.
    try:
        expected = deserialize_message(data, JointState)
    except _NO_MESSAGE:
        expected = None
    try:
        message = reader.read(data)
    except _NO_MESSAGE:
        assert expected is None, 'rclpy reads this message'
        return None
    assert message.effort == array('d')
    if expected is None:
        for values in (message.position, message.velocity):
            assert values.tobytes() in data, 'rclpy does not read this message'
        return message
    assert list(message.name) == list(expected.name)
    assert message.header == expected.header
    for name in ('position', 'velocity'):
        # As bytes: NaN is not equal to itself.
        assert getattr(message, name).tobytes() == getattr(expected, name).tobytes()
    return message


def _state(buffer):
    # As bytes for the same reason. The time is far from all that come.
    return (buffer.position.tobytes(), buffer.velocity.tobytes(), buffer.age(1e3),
            buffer.stale_joints(1e3, 1e3 - 0.5 * _PERIOD), buffer.accepted)


def _judge(buffer):
    position, velocity = buffer.position, buffer.velocity
    assert np.isfinite(position).all(), f'position {position}'
    assert not np.isinf(velocity).any(), f'velocity {velocity}'
    assert not math.isnan(buffer.age(0.0))
