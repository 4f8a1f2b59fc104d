"""The bytes of a picture are those that rclpy would write."""

from builtin_interfaces.msg import Time
from dynamics_node import RobotModel
from dynamics_node.drawing import LINE, Picture, Shape, TEXT
from dynamics_node.ros import marker_writer
from dynamics_node.ros.marker_writer import as_message, LIFETIME, MarkerWriter
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from support.robots import ARM7, PENDULUM, public_robot, random_urdf
from visualization_msgs.msg import Marker, MarkerArray

STAMP = Time(sec=1_700_000_000, nanosec=999_999_999)


def shapes_of(source):
    robot = RobotModel.from_urdf(source)
    robot = robot.with_payload(robot.tip_link, 1.5, (0.0, 0.0, 0.1))
    q = robot.neutral_position
    return Picture(robot.tree, robot.joint_names).shapes(
        robot, q, robot.gravity_torque(q), np.ones(len(q)), robot.effort_limits)


def assert_same(shapes, frame_id, begins_anew, stamp=STAMP):
    ours = MarkerWriter(frame_id).write(shapes, stamp, begins_anew)
    theirs = serialize_message(as_message(shapes, stamp, frame_id, begins_anew))
    assert deserialize_message(ours, MarkerArray) == deserialize_message(theirs, MarkerArray)
    assert len(ours) == len(theirs)


@pytest.mark.parametrize('source', [
    ARM7, PENDULUM, public_robot('panda_description/urdf/panda.urdf'), random_urdf(2)],
    ids=['arm7', 'pendulum', 'panda', 'random'])
@pytest.mark.parametrize('begins_anew', [False, True])
def test_pictures_of_robots(source, begins_anew):
    shapes = shapes_of(source)
    assert shapes
    for length in range(1, 9):  # each puts the numbers behind it at another place
        assert_same(shapes, 'base_link'[:length], begins_anew)


words = st.text(st.characters(exclude_categories=['Cs'], exclude_characters='\x00'), max_size=12)
numbers = st.floats(allow_nan=False, allow_infinity=False, width=32)


def numbers_of(count):
    return st.tuples(*[numbers] * count)


@given(frame_id=words, shapes=st.lists(st.builds(
    Shape, words, st.integers(-2**31, 2**31 - 1), st.sampled_from([LINE, TEXT]), numbers_of(3),
    numbers_of(4), numbers_of(3), numbers_of(4),
    st.lists(numbers_of(3), max_size=5).map(tuple), words), max_size=4),
    begins_anew=st.booleans(), sec=st.integers(-2**31, 2**31 - 1),
    nanosec=st.integers(0, 2**32 - 1))
def test_any_words_and_numbers(frame_id, shapes, begins_anew, sec, nanosec):
    assert_same(shapes, frame_id, begins_anew, Time(sec=sec, nanosec=nanosec))


def test_every_marker_can_be_replaced_and_vanishes_in_time():
    shapes = shapes_of(ARM7)
    message = as_message(shapes, STAMP, 'base', True)
    first, *markers = message.markers
    assert first.action == Marker.DELETEALL and not first.ns
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers) == len(shapes)
    for marker in markers:
        assert marker.action == Marker.ADD and marker.ns
        assert marker.header.frame_id == 'base' and marker.header.stamp == STAMP
        assert marker.lifetime.sec == LIFETIME > 0 and marker.frame_locked


def test_a_writer_knows_whether_it_is_right(monkeypatch):
    assert MarkerWriter('base').is_right()
    for name, value in (('_BEFORE_TEXT', marker_writer._BEFORE_TEXT[:-4]), ('_fill', None),
                        ('LIFETIME', 2), ('_POSE', marker_writer._REST)):
        with monkeypatch.context() as patch:
            wrong = value if value is not None else (
                lambda out, data, alignment=4: out.extend(data))
            if name == 'LIFETIME':  # both would say so: a wrong one of the bytes only
                patch.setattr(marker_writer, 'as_message', lambda *_: MarkerArray())
            else:
                patch.setattr(marker_writer, name, wrong)
            assert not MarkerWriter('base').is_right()
