"""The markers program over DDS: beside the dynamics node, without it, and at its end."""

import math
import re
import signal
import time

from dynamics_interfaces.srv import GetGravityTorque, SetPayload
from dynamics_node import RobotModel
from geometry_msgs.msg import Inertia, Vector3
import numpy as np
import pinocchio
import pytest
from rcl_interfaces.msg import Log
from rclpy.node import NodeNameNonExistentError
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from std_msgs.msg import String
from support.processes import PATIENCE
from support.robots import ARM7, PENDULUM, public_robot
from visualization_msgs.msg import Marker, MarkerArray

TOPIC = '/dynamics_node/markers'
ROBOTS = {'arm7': ARM7, 'panda': public_robot('panda_description/urdf/panda.urdf')}


def by_name(message):
    """Return the markers of a message by name space and number, which are distinct."""
    added = [marker for marker in message.markers if marker.action == Marker.ADD]
    markers = {(marker.ns, marker.id): marker for marker in added}
    assert len(markers) == len(added)
    return markers


def groups(received):
    """Return the name spaces of the newest message."""
    return {marker.ns for marker in received[-1].markers if marker.ns} if received else set()


def place(marker):
    position = marker.pose.position
    return position.x, position.y, position.z


def assert_valid(message):
    """Assert RViz's conditions for markers."""
    for marker in by_name(message).values():
        o, s, c = marker.pose.orientation, marker.scale, marker.color
        numbers = [*place(marker), o.x, o.y, o.z, o.w, s.x, s.y, s.z, c.r, c.g, c.b, c.a]
        numbers += [x for point in marker.points for x in (point.x, point.y, point.z)]
        assert np.isfinite(numbers).all()
        assert math.hypot(o.x, o.y, o.z, o.w) == pytest.approx(1.0, abs=1e-9)
        assert min(s.x, s.y, s.z) > 0.0 and 0.0 < c.a <= 1.0


def swept(marker):
    """Return the signed angle of an arc, relative to three quarters of a turn."""
    angle = np.unwrap([math.atan2(point.y, point.x) for point in marker.points[:-3]])
    return (angle[-1] - angle[0]) / (1.5 * math.pi)


def axis(marker):
    """Return the z axis of a marker in the base frame."""
    o = marker.pose.orientation
    return pinocchio.Quaternion(o.w, o.x, o.y, o.z).toRotationMatrix()[:, 2]


def axes_of(model, q):
    """Return the axes of the revolute joints in the base frame, from the Jacobians."""
    links = {frame.body: link for link, frame in model.tree.links.items()}
    bodies = {name: k for k, name in enumerate(model.tree.moving_joint_names)}
    return {
        name: model.jacobian(q, links[bodies[name]])[3:, i]
        for i, name in enumerate(model.joint_names)
    }


def log_lines(client):
    """Return a list that receives all lines of the log."""
    lines = []
    client.node.create_subscription(
        Log,
        '/rosout',
        lambda message: lines.append(message.msg),
        QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL),
    )
    return lines


def until_complete(client, received, state):
    """Wait for torques and efforts of the same state."""
    client.until(
        lambda: (
            groups(received)
            >= {'center_of_mass', 'gravity', 'gravity_torque', 'effort', 'torque_text'}
        ),
        state,
    )
    received.clear()
    client.until(lambda: len(received) >= 2, state)


@pytest.mark.parametrize('name', ROBOTS)
def test_markers_agree_with_the_services(client, start, start_markers, name):
    model = RobotModel.from_urdf(ROBOTS[name])
    # The description is a parameter of the dynamics node, on no topic.
    start(robot_description_file=ROBOTS[name], state_timeout=1.0)
    start_markers()
    received = client.listen(MarkerArray, TOPIC)
    q = np.clip(np.linspace(0.6, -0.9, len(model.joint_names)), *model.position_limits.T)
    effort = model.gravity_torque(q) + 0.1 * np.nan_to_num(model.effort_limits, nan=1.0)

    def state():
        client.publish(reversed(model.joint_names), q[::-1], (), effort[::-1])

    until_complete(client, received, state)
    answer = client.call(GetGravityTorque, '/dynamics_node/get_gravity_torque', action=state)
    assert answer.success
    assert_valid(received[-1])
    markers = by_name(received[-1])
    kinds = dict(zip(model.tree.moving_joint_names, model.tree.joint_type.tolist(), strict=True))
    axes = axes_of(model, q)
    for i, joint in enumerate(answer.joint_names):
        torque, limit = answer.gravity_torque[i], model.effort_limits[i]
        text = markers['torque_text', i].text
        stated = re.fullmatch(re.escape(joint) + r': (\S+) (N m|N)(?: \((\d+) %\))?', text)
        assert stated, text
        assert float(stated[1]) == pytest.approx(torque, rel=6e-3, abs=6e-4)
        assert float(stated[3]) == pytest.approx(100.0 * abs(torque) / limit, abs=0.51)
        if kinds[joint] == 0:
            for group, value in (('gravity_torque', torque), ('effort', effort[i])):
                shortest = 0.01 / (1.5 * math.pi)
                arc = markers[group, i]
                assert swept(arc) == pytest.approx(value / limit, abs=shortest)
                assert axis(arc) == pytest.approx(axes[joint], abs=1e-12)
    poses = model.body_poses(q)
    for k, inertia in enumerate(model.tree.inertia):
        if inertia[3, 3] > 0.0:
            expected = (poses[k] @ inertia[:, 3] / inertia[3, 3])[:3]
            assert place(markers['center_of_mass', k]) == pytest.approx(expected, abs=1e-12)
    for marker in markers.values():
        assert marker.header.frame_id == model.tree.root
        assert abs(marker.header.stamp.sec - time.time()) < 60.0


def test_without_a_subscriber_it_has_no_subscriptions(client, start_markers):
    start_markers()
    client.description.publish(String(data=PENDULUM.read_text()))

    def state():
        client.publish(['hinge'], [0.3])

    def listens():
        try:
            topics = client.node.get_subscriber_names_and_types_by_node('markers', '/')
        except NodeNameNonExistentError:
            return None
        return {'/joint_states', '/dynamics_node/gravity_torque'} & {topic for topic, _ in topics}

    client.until(lambda: client.node.count_publishers(TOPIC) and listens() == set(), state)
    received = []
    eye = client.node.create_subscription(MarkerArray, TOPIC, received.append, 10)
    client.until(lambda: len(received) >= 2, state)
    assert len(listens()) == 2
    assert received[0].markers[0].action == Marker.DELETEALL
    assert all(marker.action == Marker.ADD for marker in received[1].markers)
    client.node.destroy_subscription(eye)
    client.until(lambda: listens() == set(), state)
    received.clear()
    client.node.create_subscription(MarkerArray, TOPIC, received.append, 10)
    client.until(lambda: received, state)
    assert received[0].markers[0].action == Marker.DELETEALL  # another RViz, perhaps
    # joint_states has no effort, and without the node there is no torque.
    assert groups(received) == {'center_of_mass', 'inertia'}


def test_the_rate_of_markers_is_limited(client, start_markers):
    start_markers()
    client.description.publish(String(data=PENDULUM.read_text()))
    times = []
    client.node.create_subscription(
        MarkerArray, TOPIC, lambda _: times.append(time.monotonic()), 10
    )

    def state():
        client.publish(['hinge'], [0.3])

    client.until(lambda: times, state, period=0.003)
    times.clear()
    begun = time.monotonic()
    client.during(2.0, state, period=0.003)
    # Ten may have been in the queue of this process.
    assert 2 <= len(times) <= (time.monotonic() - begun) / 0.05 + 12


def test_without_the_dynamics_node_masses_are_drawn(client, start, start_markers):
    start_markers()
    received, lines = client.listen(MarkerArray, TOPIC), log_lines(client)
    node_is_missing = 'the dynamics node /dynamics_node, without which only masses are drawn'
    client.until(
        lambda: (
            f'waiting for a robot description on /robot_description; '
            f'{node_is_missing}; joint states on /joint_states' in lines
        )
    )
    client.description.publish(String(data=PENDULUM.read_text()))

    def hinge():
        client.publish(['hinge'], [0.3], (), [4.0])

    client.until(lambda: f'waiting for {node_is_missing}' in lines, hinge)
    client.until(lambda: received, hinge)
    assert groups(received) == {'center_of_mass', 'inertia'}
    pendulum = RobotModel.from_urdf(PENDULUM)
    expected = pendulum.link_pose([0.3], 'rod') @ [-0.35, 0.0, 0.0, 1.0]
    assert place(by_name(received[-1])['center_of_mass', 0]) == pytest.approx(expected[:3])
    assert received[-1].markers[0].header.frame_id == 'world'
    # The dynamics node has the same description; gravity and torques appear.
    node = start(state_timeout=1.0)
    client.until(lambda: groups(received) > {'gravity', 'gravity_torque', 'effort'}, hinge)
    client.until(lambda: f'drawing on {TOPIC} while it has a subscriber' in lines, hinge)
    # Another description removes the old markers at once.
    arm = RobotModel.from_urdf(ARM7)
    received.clear()
    client.description.publish(String(data=ARM7.read_text()))
    client.until(
        lambda: len(received) > 1 and len(by_name(received[-1])) > 40,
        lambda: client.publish(arm.joint_names, arm.neutral_position),
    )
    first = next(message for message in received if ('center_of_mass', 5) in by_name(message))
    assert first.markers[0].action == Marker.DELETEALL
    names = {
        marker.text.partition(':')[0]
        for marker in received[-1].markers
        if marker.ns == 'torque_text'
    }
    assert names == set(arm.joint_names)
    # Without the node only masses are left, without old torques.
    node.send(signal.SIGINT)
    node.wait(PATIENCE)
    client.until(
        lambda: groups(received) == {'center_of_mass', 'inertia'},
        lambda: client.publish(arm.joint_names, arm.neutral_position),
    )


def test_a_refused_description_is_logged_and_the_next_one_awaited(client, start_markers):
    start_markers()
    received, lines = client.listen(MarkerArray, TOPIC), log_lines(client)
    for text in ('<robot name="broken"/>', '<robot name="broken"/>', PENDULUM.read_text()):
        client.description.publish(String(data=text))
        client.until(lambda: any('refused' in line for line in lines))
    client.until(lambda: received, lambda: client.publish(['hinge'], [0.3]))
    client.description.publish(String(data='<robot name="broken too"/>'))
    client.until(lambda: any('the one before is shown' in line for line in lines))
    received.clear()
    client.until(lambda: received, lambda: client.publish(['hinge'], [0.3]))
    refused = [line for line in lines if 'refused' in line]
    assert len(refused) == 2 and 'refused, waiting for another one: ' in refused[0]


def test_a_payload_appears_and_disappears(client, start, start_markers):
    arm = RobotModel.from_urdf(ARM7)
    start(robot_description_file=ARM7, state_timeout=1.0)
    start_markers()
    received = client.listen(MarkerArray, TOPIC)

    def state():
        client.publish(arm.joint_names, arm.neutral_position)

    client.until(lambda: 'torque_text' in groups(received), state)
    assert 'payload' not in groups(received)
    for mass in (2.0, 0.0):
        assert client.call(
            SetPayload,
            '/dynamics_node/set_payload',
            SetPayload.Request(link='hand', inertia=Inertia(m=mass, com=Vector3(z=0.1))),
            state,
        ).success
        client.until(lambda mass=mass: bool(mass) == ('payload' in groups(received)), state)
        assert_valid(received[-1])
    loaded = [message for message in received if ('payload', 0) in by_name(message)]
    expected = arm.link_pose(arm.neutral_position, 'hand') @ [0.0, 0.0, 0.1, 1.0]
    assert place(by_name(loaded[-1])['payload', 0]) == pytest.approx(expected[:3], abs=1e-12)


def test_parameters_of_a_restarted_node_are_read_again(client, start, start_markers):
    first = start(robot_description_file=ARM7, state_timeout=1.0)
    start_markers()
    received = client.listen(MarkerArray, TOPIC)
    arm = RobotModel.from_urdf(ARM7)

    def state():
        client.publish(arm.joint_names, arm.neutral_position)

    client.until(lambda: 'torque_text' in groups(received), state)
    first.send(signal.SIGKILL)  # the graph contains it for some time
    first.wait(PATIENCE)
    start(
        **{
            'robot_description_file': ARM7,
            'state_timeout': 1.0,
            'payload.link': 'hand',
            'payload.mass': 2.0,
            'joints': '[wrist_roll]',
            'effort_limits': '[50.0]',
        }
    )
    client.until(
        lambda: (
            'payload' in groups(received)
            and ('torque_text', 0) in by_name(received[-1])
            and ('torque_text', 1) not in by_name(received[-1])
        ),
        state,
    )
    assert by_name(received[-1])['torque_text', 0].text.startswith('wrist_roll: ')


def test_topics_are_in_its_namespace(client, start_markers):
    start_markers('__ns:=/left', dynamics_node='arm_dynamics')
    client.node.create_publisher(String, '/left/robot_description', 1)
    topics = {'/left/arm_dynamics/markers'}
    client.until(lambda: all(client.node.count_publishers(topic) for topic in topics))
    client.until(lambda: client.node.count_subscribers('/left/robot_description'))
    assert client.node.count_publishers(TOPIC) == 0
    assert client.node.count_subscribers('/robot_description') == 0
    client.listen(MarkerArray, '/left/arm_dynamics/markers')
    client.until(lambda: client.node.count_subscribers('/left/joint_states'))
    client.until(lambda: client.node.count_subscribers('/left/arm_dynamics/gravity_torque'))


# Two of them: from the terminal and from launch.
@pytest.mark.parametrize(
    'numbers', [[signal.SIGINT], [signal.SIGTERM], [signal.SIGINT, signal.SIGINT]]
)
def test_signals_end_it_with_exit_code_0(client, start_markers, numbers):
    markers = start_markers()
    client.until(lambda: client.node.count_publishers(TOPIC))
    for number in numbers:
        markers.send(number)
    code, output = markers.wait(PATIENCE)
    assert code == 0 and 'Traceback' not in output


@pytest.mark.parametrize('name', ['', 'two words', '/ends/'])
def test_a_wrong_name_of_a_node_is_refused(start_markers, name):
    markers = start_markers(dynamics_node=f"'{name}'")
    code, output = markers.wait(PATIENCE)
    assert code == 1 and 'Traceback' not in output
    assert f'dynamics_node: expected the name of a node, got {name!r}' in output
