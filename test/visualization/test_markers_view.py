"""The parts of the markers program: view, messages and callbacks."""

from builtin_interfaces.msg import Time
from dynamics_node import DynamicsError, RobotModel
from dynamics_node.errors import RobotDescriptionError
from dynamics_node.visualization import LINE, Shape
from dynamics_node.visualization.markers.callbacks import ErrorReport, LimitedGroup, reported
from dynamics_node.visualization.markers.messages import LIFETIME, MarkerMessages
from dynamics_node.visualization.markers.view import RobotView, TORQUE_TIMEOUT
import numpy as np
import pytest
from std_msgs.msg import String
from support.robots import ARM7, PENDULUM
from visualization_msgs.msg import Marker

STAMP = Time(sec=1_700_000_000, nanosec=999_999_999)
ARM = RobotModel.from_urdf(ARM7)
MASSES = {'center_of_mass', 'inertia'}
SETTINGS = {
    'joints': [],
    'gravity': [0.0, 0.0, -9.81],
    'effort_limits': [],
    'payload.link': '',
    'payload.mass': 0.0,
    'payload.com': [0.0] * 3,
    'payload.inertia': [0.0] * 6,
}


def settings(**changes):
    return SETTINGS | {
        name.replace('_', '.', 1) if name.startswith('payload') else name: value
        for name, value in changes.items()
    }


def view(source=ARM7, **changes):
    """Return a view with settings and a torque at time 0."""
    view_of = RobotView(source)
    view_of.configure(settings(**changes))
    view_of.take_torque(view_of.joint_names, [1.0] * len(view_of.joint_names), 0.0)
    return view_of


def groups(shapes):
    return {shape.group for shape in shapes}


def texts(shapes):
    return [shape.text for shape in shapes if shape.group == 'torque_text']


def test_without_settings_only_masses_are_drawn():
    view_of = RobotView(ARM7)
    view_of.take_torque(ARM.joint_names, [1.0] * 8, 0.0)
    assert groups(view_of.shapes(0.0)) == MASSES
    view_of.configure(SETTINGS)
    assert groups(view_of.shapes(0.0)) > MASSES | {'gravity', 'gravity_torque', 'torque_text'}
    view_of.configure(None)
    assert groups(view_of.shapes(0.0)) == MASSES


def test_torques_are_read_by_name_and_disappear_when_old():
    view_of = view(joints=['elbow_pitch', 'wrist_roll'])
    view_of.take_torque(['wrist_roll', 'shoulder_yaw', 'elbow_pitch'], [3.0, 1.0, 2.0], 10.0)
    assert [text.split(' (')[0] for text in texts(view_of.shapes(10.0 + TORQUE_TIMEOUT))] == [
        'elbow_pitch: 2 N m',
        'wrist_roll: 3 N m',
    ]
    assert groups(view_of.shapes(10.1 + TORQUE_TIMEOUT)) == MASSES | {'gravity'}


@pytest.mark.parametrize(
    ('names', 'torque'),
    [
        (ARM.joint_names[1:], [1.0] * 7),
        (ARM.joint_names, [1.0] * 7),
        (ARM.joint_names, [np.nan] + [1.0] * 7),
    ],
    ids=['joint', 'length', 'nan'],
)
def test_an_incomplete_torque_is_not_drawn(names, torque):
    view_of = view()
    view_of.take_torque(names, torque, 0.0)
    assert not texts(view_of.shapes(0.0))


def test_gravity_that_changes_does_not_hide_the_torques():
    view_of = view()
    view_of.configure(settings(gravity=[9.81, 0.0, 0.0]))
    assert view_of.model.gravity.tolist() == [9.81, 0.0, 0.0]
    assert len(texts(view_of.shapes(0.0))) == 8


def test_states_are_merged_by_name():
    view_of = view()
    assert not view_of.has_new_state
    view_of.take_state(['gripper', 'elbow_pitch'], [9.0, 0.5], [])
    view_of.take_state(['wrist_roll', 'elbow_roll'], [-0.4, 0.0], [2.0, 0.0])
    assert view_of.has_new_state
    q = ARM.neutral_position.copy()
    q[ARM.joint_names.index('elbow_pitch')] = 0.5
    q[ARM.joint_names.index('wrist_roll')] = -0.4
    shapes = view_of.shapes(0.0)
    assert not view_of.has_new_state
    [sphere] = [shape for shape in shapes if (shape.group, shape.number) == ('center_of_mass', 6)]
    inertia = ARM.tree.inertia[6]
    assert sphere.position == pytest.approx(
        (ARM.body_poses(q)[6] @ inertia[:, 3] / inertia[3, 3])[:3]
    )
    assert [shape.number for shape in shapes if shape.group == 'effort'] == [
        ARM.joint_names.index('wrist_roll')
    ]


def test_a_missing_effort_is_not_drawn():
    view_of = view()
    for effort, count in (
        ([2.0], 1),
        ([np.inf], 0),
        ([2.0], 1),
        ([2.0, 3.0], 0),
        ([2.0], 1),
        ([], 0),
    ):
        view_of.take_state(['wrist_roll'], [0.1], effort)
        assert sum(shape.group == 'effort' for shape in view_of.shapes(0.0)) == count


@pytest.mark.parametrize('position', [[np.nan], [np.inf], [0.1, 0.2], []])
def test_an_invalid_position_is_ignored(position):
    view_of = view(PENDULUM)
    before = view_of.shapes(0.0)
    view_of.take_state(['hinge'], position, [])
    assert not view_of.has_new_state
    assert view_of.shapes(0.0) == before


def test_the_limits_are_those_in_force():
    share = {
        limits: texts(view(PENDULUM, effort_limits=list(limits)).shapes(0.0))
        for limits in ((), (4.0,))
    }
    assert share == {(): ['hinge: 1 N m (5 %)'], (4.0,): ['hinge: 1 N m (25 %)']}


@pytest.mark.parametrize(
    ('change', 'words'),
    [
        ({'joints': ['hinge', 'elbow']}, 'elbow'),
        ({'effort_limits': [1.0, 2.0]}, 'effort_limits: expected 1 numbers for hinge, got 2'),
        ({'payload_link': 'hand', 'payload_mass': 1.0}, 'hand'),
    ],
)
def test_with_settings_of_another_robot_masses_are_drawn(change, words):
    view_of = view(PENDULUM)
    with pytest.raises(DynamicsError, match=words):
        view_of.configure(settings(**change))
    assert groups(view_of.shapes(0.0)) == MASSES


def test_a_payload_is_that_of_the_parameters():
    view_of = view(
        payload_link='hand',
        payload_mass=2.0,
        payload_com=[0.0, 0.0, 0.1],
        payload_inertia=[0.1, 0.0, 0.0, 0.1, 0.0, 0.1],
    )
    expected = ARM.with_payload('hand', 2.0, (0.0, 0.0, 0.1), 0.1 * np.eye(3))
    assert view_of.model.payload.pseudo_inertia == pytest.approx(expected.payload.pseudo_inertia)
    assert 'payload' in groups(view_of.shapes(0.0))


@pytest.mark.parametrize('source', [b'<robot name="empty"/>', b'no xml', 'nowhere.urdf'])
def test_a_broken_description_is_refused(source):
    with pytest.raises(RobotDescriptionError):
        RobotView(source)


def test_a_robot_without_movable_joints_is_refused():
    with pytest.raises(DynamicsError, match='no joint that can be moved'):
        RobotView(b'<robot name="table"><link name="base"/></robot>')


# Messages -------------------------------------------------------------------------------------


def markers_of(messages, shapes):
    return messages.make(shapes, STAMP, 'base').markers


def test_every_marker_can_be_replaced_and_vanishes_in_time():
    shapes = view().shapes(0.0)
    first, *markers = markers_of(MarkerMessages(), shapes)
    assert first.action == Marker.DELETEALL and not first.ns
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers) == len(shapes)
    for marker in (first, *markers):
        assert marker.header.frame_id == 'base' and marker.header.stamp == STAMP
    for marker in markers:
        assert marker.action == Marker.ADD and marker.ns
        assert marker.lifetime.sec == LIFETIME == 1 and marker.frame_locked


def test_all_markers_are_deleted_when_the_set_of_shapes_changes():
    messages, shapes = MarkerMessages(), view().shapes(0.0)
    actions = [
        [marker.action for marker in markers_of(messages, few)][:1]
        for few in (shapes, shapes, shapes[1:], shapes[1:], [], [])
    ]
    assert actions == [
        [Marker.DELETEALL],
        [Marker.ADD],
        [Marker.DELETEALL],
        [Marker.ADD],
        [Marker.DELETEALL],
        [],
    ]


def test_a_reused_marker_is_that_of_its_shape():
    view_of, messages = view(), MarkerMessages()
    for q in (0.0, 0.3, 0.3, -0.5):
        view_of.take_state(ARM.joint_names[:7], [q] * 7, [10.0 * q] * 7)
        view_of.take_torque(ARM.joint_names, [3.0 * q] * 8, 0.0)
        shapes = view_of.shapes(0.0)
        again = [marker for marker in markers_of(messages, shapes) if marker.action == Marker.ADD]
        assert again == markers_of(MarkerMessages(), shapes)[1:]


def test_a_shape_is_translated_completely():
    shape = Shape(
        'group',
        3,
        LINE,
        (0.1, 0.2, 0.3),
        (0.5, 0.25, 0.75, 1.0),
        (1.0, 2.0, 3.0),
        (0.0, 0.6, 0.0, 0.8),
        ((4.0, 5.0, 6.0), (7.0, 8.0, 9.0)),
        'words',
    )
    [_, marker] = markers_of(MarkerMessages(), [shape])
    p, o, s, c = marker.pose.position, marker.pose.orientation, marker.scale, marker.color
    assert (marker.ns, marker.id, marker.type, marker.text) == (
        'group',
        3,
        Marker.LINE_STRIP,
        'words',
    )
    assert (s.x, s.y, s.z) == shape.size and (c.r, c.g, c.b, c.a) == shape.color
    assert (p.x, p.y, p.z) == shape.position and (o.x, o.y, o.z, o.w) == shape.orientation
    assert tuple((point.x, point.y, point.z) for point in marker.points) == shape.points


# Callbacks ------------------------------------------------------------------------------------


def test_a_limited_group_runs_for_the_newest_messages_only(client):
    group, received = LimitedGroup(), []
    client.node.create_subscription(String, 'words', received.append, 2, callback_group=group)
    publisher = client.node.create_publisher(String, 'words', 10)
    other = client.listen(String, 'words')
    client.until(lambda: publisher.get_subscription_count() == 2)

    def publish(*words):
        other.clear()
        for word in words:
            publisher.publish(String(data=word))
        client.until(lambda: len(other) == len(words))

    publish('a', 'b', 'c')
    assert received == []
    group.allow(3)
    client.until(lambda: len(received) == 2)
    publish('d', 'e', 'f')
    client.until(lambda: len(received) == 3)
    client.during(0.1)
    assert [message.data for message in received][:2] == ['b', 'c'] and len(received) == 3


class Failing:
    def __init__(self, logger):
        self.errors = ErrorReport(logger)

    @reported
    def on_message(self, message):
        return 1.0 / message

    @reported
    def on_other(self):
        raise KeyError('other')


def test_errors_of_each_callback_are_logged_with_a_throttle(client, capfd):
    failing = Failing(client.node.get_logger())
    assert failing.on_message(2.0) == 0.5
    for _ in range(20):
        assert failing.on_message(0.0) is None
        failing.on_other()
    printed = capfd.readouterr().err
    assert printed.count('Traceback') == 2
    assert 'error in on_message: float division by zero' in printed and 'on_other' in printed
