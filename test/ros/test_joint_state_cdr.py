"""Serialized joint states: read like rclpy, and refused before rclpy if they are none."""

import struct

from dynamics_node.ros.torque_path import joint_state_cdr
from dynamics_node.ros.torque_path.joint_state_cdr import end_of_names, JointStateReader
from dynamics_node.safety import RejectedStateError
from dynamics_node.safety.joint_state_buffer import MAX_NAMES
from hypothesis import given
from hypothesis import strategies as st
import pytest
from rclpy.serialization import deserialize_message, serialize_message
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
AT_EFFORTS = len(FULL) - 16 - 8


def with_count(at, count, data=FULL):
    """Return a message with another number as one of its counts."""
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
def test_truncated_bytes_are_refused_without_aftereffect(length):
    expected = 'expected plain CDR' if length < 2 else f'got {length} bytes that end too early'
    with pytest.raises(RejectedStateError, match=expected) as caught:
        end_of_names(FULL[:length])
    assert caught.value.kind == 'unreadable'
    reader = JointStateReader()
    assert list(reader.read(FULL).velocity) == [3.0, 4.0]
    if length < AT_EFFORTS:
        with pytest.raises(RejectedStateError):
            reader.read(FULL[:length])
    assert list(reader.read(FULL).position) == [1.0, 2.0]


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
def test_an_impossible_count_is_refused(at, kind, count, capfd):
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


def test_the_maximum_number_of_numbers_is_read():
    many = state(name=['a'], position=[1.0] * MAX_NAMES)
    assert len(JointStateReader().read(many).position) == MAX_NAMES
    with pytest.raises(RejectedStateError, match='at most 4096 efforts, got 4097'):
        end_of_names(state(effort=[1.0] * (MAX_NAMES + 1)))


numbers = st.lists(st.floats(width=64), max_size=5)
names = st.lists(
    st.text(st.characters(codec='utf-8', exclude_characters='\x00'), max_size=9), max_size=5
)


@st.composite
def states(draw, name=names):
    message = JointState(
        name=draw(name), position=draw(numbers), velocity=draw(numbers), effort=draw(numbers)
    )
    message.header.frame_id = draw(st.sampled_from(['', 'base', 'world']))
    message.header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1))
    message.header.stamp.nanosec = draw(st.integers(0, 2**32 - 1))
    return message


@given(
    st.one_of(
        st.lists(states(), max_size=6),
        st.lists(states(name=st.just(['shoulder', 'elbow', 'wrist'])), min_size=2, max_size=6),
    )
)
def test_any_sequence_is_read_as_rclpy_reads_it(sequence):
    reader = JointStateReader()
    for message in sequence:
        data = serialize_message(message)
        read, expected = reader.read(data), deserialize_message(data, JointState)
        assert list(read.name) == list(expected.name)
        assert read.header == expected.header
        # As bytes: NaN is not equal to itself.
        for field in ('position', 'velocity', 'effort'):
            assert getattr(read, field).tobytes() == getattr(expected, field).tobytes()


def test_truncated_efforts_do_not_invalidate_a_state():
    data = serialize_message(JointState(name=['a'], position=[1.0], effort=[2.0]))
    reader = JointStateReader()
    assert list(reader.read(data).effort) == [2.0]
    # The last number is missing, with what rclpy adds behind it.
    read = reader.read(data[:-12])
    assert list(read.position) == [1.0] and len(read.effort) == 0


def test_names_are_deserialized_once(monkeypatch):
    reader = JointStateReader()
    message = JointState(name=['a', 'b'], position=[1.0, 2.0])
    reader.read(serialize_message(message))
    monkeypatch.setattr(joint_state_cdr, 'deserialize_message', None)
    message.position = [3.0, 4.0]
    message.header.stamp.sec = 7
    read = reader.read(serialize_message(message))
    assert list(read.position) == [3.0, 4.0]
    assert read.header.stamp.sec == 7
    message.name = ['a', 'c']
    with pytest.raises(TypeError):  # the names are new: rclpy would be asked
        reader.read(serialize_message(message))


@pytest.mark.parametrize('frame', ['', 'base_link'])
def test_too_many_names_are_refused_before_deserialization(monkeypatch, frame):
    def message(count):
        state = JointState(name=['a'] * count)
        state.header.frame_id = frame
        return serialize_message(state)

    reader = JointStateReader()
    assert len(reader.read(message(MAX_NAMES)).name) == MAX_NAMES
    monkeypatch.setattr(joint_state_cdr, 'deserialize_message', None)
    with pytest.raises(RejectedStateError, match='at most 4096 names, got 4097'):
        reader.read(message(MAX_NAMES + 1))
