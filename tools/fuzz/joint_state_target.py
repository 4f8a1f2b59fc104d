"""The second target: serialized joint states, as the node reads them from its topic."""

from itertools import count
import math

from dynamics_node.ros.torque_path.joint_state_cdr import JointStateReader
from dynamics_node.safety import (
    JointStateBuffer,
    MotionLimits,
    OutputSettings,
    RejectedStateError,
    TorquePath,
)
from dynamics_node.safety.joint_state_buffer import MAX_NAMES
import numpy as np
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from .audit import nothing_opened
from .capture import nothing_printed, NOWHERE, stderr_to
from .error_digest import error_digest
from .joint_states import CLOCK, JOINTS, PERIOD, streams

NAME = 'joint states'
SUFFIX = '.hex'
# The last joint is measured, but not needed.
_NEEDED = JOINTS[:3]
_LIMITS = MotionLimits(
    JOINTS,
    [3.0, 3.0, math.nan, 1.0],
    [(-3.0, 3.0), (-math.inf, math.inf), (0.0, 1.0), (0.0, 1.0)],
    [False, True, False, False],
)
_TIMEOUT = 0.1
# Characters of a log line.
_LONGEST_MESSAGE = 1_000


def inputs():
    """Return the strategy of lists of inputs."""
    return streams()


def warm_up():
    """Load lazy modules."""
    _answer([bytes.fromhex('00010000') + bytes(28), b''])


def to_bytes(stream):
    """Convert an input to the content of a file: a line of hexadecimal digits per message."""
    return ''.join(data.hex() + '\n' for data in stream).encode()


def from_bytes(data):
    """Convert the content of a file to an input."""
    return [bytes.fromhex(line) for line in data.decode().splitlines()]


def check(stream):
    """
    Process a stream of messages.

    Returns
    -------
    list of str
        The answer to each: 'taken', or the digest of the error.

    Raises
    ------
    Exception
        The finding.

    """
    with nothing_opened():
        return _answer(stream)


def _answer(stream):
    reader = JointStateReader()
    buffer = JointStateBuffer(JOINTS, _NEEDED, np.zeros(len(JOINTS)), _LIMITS)
    answers = []
    for clock, data in zip(count(CLOCK, PERIOD), stream):
        before = _state(buffer)
        try:
            answers.append(_receive(reader, buffer, data, clock))
        except RejectedStateError as error:
            _judge_refusal(error, before, _state(buffer))
            answers.append(f'refused: {error.kind}: {error_digest(str(error))}')
        _judge(buffer)
    return answers


def _judge_refusal(error, before, after):
    _judge_text(str(error))
    # After a fault no joint counts as measured, but all positions stay.
    changed = after[:3] != before[:3] if error.is_fault else after != before
    assert not changed, f'a refused message changed {before} to {after}'


def _receive(reader, buffer, data, clock):
    message = _read(reader, data)
    stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
    now = clock * 1e-9
    # Enabled, so that faults are reported.
    path = TorquePath(OutputSettings(_TIMEOUT, 0.0, 0.0, 'ramp_to_zero'))
    path.use(buffer)
    path.enable(now)
    try:
        path.process_joint_state(
            now, message.name, message.position, message.velocity, stamp, clock, message.effort
        )
    finally:
        _judge_text(path.output.machine.reason)
    _judge_text(buffer.outside() or '-')
    if path.output.machine.fault:
        return 'taken: fault'
    is_usable = buffer.is_complete and buffer.age(now) <= _TIMEOUT
    return 'taken: usable' if is_usable else 'taken: not complete'


def _read(reader, data):
    # rclpy is the reference.
    try:
        with stderr_to(NOWHERE):
            expected = deserialize_message(data, JointState)
            refusal = ''
    except Exception as error:
        expected, refusal = None, repr(error)
    try:
        with nothing_printed():
            message = reader.read(data)
    except RejectedStateError:
        # The reader refuses more than rclpy, but no message that robots send.
        assert (
            expected is None
            or data[:2] not in (b'\x00\x00', b'\x00\x01')
            or _is_too_large(expected)
        ), 'rclpy reads this message'
        raise
    except Exception as error:
        if repr(error) != refusal:
            raise
        # An error of rclpy, which the node converts.
        raise RejectedStateError('unreadable', str(error)) from error
    if expected is None:
        for values in (message.position, message.velocity, message.effort):
            assert values.tobytes() in data, 'rclpy does not read this message'
        return message
    assert list(message.name) == list(expected.name)
    assert message.header == expected.header
    for name in ('position', 'velocity', 'effort'):
        # As bytes: NaN is not equal to itself.
        assert getattr(message, name).tobytes() == getattr(expected, name).tobytes()
    return message


def _judge_text(text):
    assert text.isprintable(), f'not to be printed: {text!r}'
    assert 0 < len(text) < _LONGEST_MESSAGE, f'{len(text)} characters: {text:.99}'


def _is_too_large(message):
    return (
        max(len(message.name), len(message.position), len(message.velocity), len(message.effort))
        > MAX_NAMES
    )


def _state(buffer):
    # As bytes for the same reason. At a time after all messages, the age of a joint tells by
    # which message it was measured.
    end = (CLOCK + 8 * PERIOD) * 1e-9
    return (
        buffer.position.tobytes(),
        buffer.velocity.tobytes(),
        buffer.age(end),
        buffer.accepted,
        buffer.effort.tobytes(),
        *(buffer.stale_joints(end, (age - 0.5) * PERIOD * 1e-9) for age in range(1, 9)),
    )


def _judge(buffer):
    position, velocity, effort = buffer.position, buffer.velocity, buffer.effort
    assert np.isfinite(position).all(), f'position {position}'
    assert not np.isinf(velocity).any(), f'velocity {velocity}'
    assert not np.isinf(effort).any(), f'effort {effort}'
    assert not math.isnan(buffer.age(0.0))
