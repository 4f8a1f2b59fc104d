"""Bytes that are no joint state are refused before rclpy sees them, and without a line of its."""

import struct

from dynamics_node.ros.joint_state_layout import end_of_names
from dynamics_node.ros.joint_state_reader import JointStateReader
from dynamics_node.safety import RejectedStateError
from dynamics_node.safety.joint_state_buffer import MAX_NAMES
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState


def state(frame='base', **fields):
    """Return the bytes of a joint state."""
    message = JointState(**fields)
    message.header.frame_id = frame
    return serialize_message(message)


# 4 of representation, 8 of stamp, 4 + 5 + 3 of the frame.
AT_NAMES = 24
FULL = state(name=['a', 'elbow'], position=[1.0, 2.0], velocity=[3.0, 4.0], effort=[5.0, 6.0])
# Behind 'a' and 'elbow': 4 + 4 + 2 + 2 and 4 + 6 + 2.
AT_POSITIONS = AT_NAMES + 4 + 8 + 12


def with_count(at, count, data=FULL):
    """Return a message in which one count says something else."""
    return data[:at] + struct.pack('<I', count) + data[at + 4 :]


def test_the_positions_begin_behind_the_names():
    assert end_of_names(FULL) == AT_POSITIONS
    assert end_of_names(state(frame='')) == AT_NAMES - 4 + 4
    # The same in the other order of bytes.
    swapped = (
        b'\x00\x00\x00\x00'
        + bytes(8)
        + struct.pack('>I4sII2s2sII', 4, b'abc', 1, 2, b'a', b'', 0, 0)
        + bytes(4)
    )
    assert end_of_names(swapped) == len(swapped) - 12


@pytest.mark.parametrize('length', range(len(FULL)))
def test_whatever_ends_too_early_is_refused(length):
    expected = 'expected plain CDR' if length < 2 else f'got {length} bytes that end too early'
    with pytest.raises(RejectedStateError, match=expected) as caught:
        end_of_names(FULL[:length])
    assert caught.value.kind == 'unreadable'


@pytest.mark.parametrize(
    'at, kind',
    [
        (12, 'unreadable'),
        (AT_NAMES, 'too many names'),
        (AT_NAMES + 4, 'unreadable'),
        (AT_POSITIONS, 'length'),
    ],
    ids=['frame', 'names', 'name', 'positions'],
)
@pytest.mark.parametrize('count', [2**32 - 1, 2**31, 2**28, MAX_NAMES + 1])
def test_a_count_is_not_believed(at, kind, count, capfd):
    reader = JointStateReader()
    with pytest.raises(RejectedStateError) as caught:
        reader.read(with_count(at, count))
    assert caught.value.kind == kind
    # rclpy would have printed that a sequence exceeds its buffer.
    assert capfd.readouterr() == ('', '')


@pytest.mark.parametrize('representation', ['0002', '0006', '000a', 'ffff'])
def test_another_representation_is_refused(representation):
    with pytest.raises(RejectedStateError, match=f'got representation {representation}') as caught:
        end_of_names(bytes.fromhex(representation) + FULL[2:])
    assert caught.value.kind == 'unreadable'


def test_as_many_numbers_as_names_can_be_are_read():
    many = state(name=['a'], position=[1.0] * MAX_NAMES)
    assert len(JointStateReader().read(many).position) == MAX_NAMES
    with pytest.raises(RejectedStateError, match='at most 4096 efforts, got 4097'):
        end_of_names(state(effort=[1.0] * (MAX_NAMES + 1)))
