"""The topic ~/markers over DDS: when it speaks, and whether it shows what the node computes."""

import math
import re
import time
import types

from builtin_interfaces.msg import Time
from dynamics_interfaces.srv import GetGravityTorque, SetPayload
from dynamics_node import RobotModel
from dynamics_node.ros import marker_writer
from dynamics_node.ros.markers import COMPLAIN_EVERY, LONGEST, Markers, PERIOD, SHARE
from dynamics_node.ros.robot import Robot
from geometry_msgs.msg import Inertia, Vector3
import numpy as np
import pinocchio
import pytest
from std_msgs.msg import String
from support.extreme_robots import chain
from support.robots import ARM7, PENDULUM, public_robot
from visualization_msgs.msg import Marker, MarkerArray

TOPIC = '/dynamics_node/markers'
ROBOTS = {'arm7': ARM7, 'ur5': public_robot('ur_description/urdf/ur5_robot.urdf'),
          'panda': public_robot('panda_description/urdf/panda.urdf')}


def by_name(message):
    """Return the markers of a message by name space and number; no two may have the same."""
    added = [marker for marker in message.markers if marker.action == Marker.ADD]
    found = {(marker.ns, marker.id): marker for marker in added}
    assert len(found) == len(added)
    return found


def assert_fit_to_be_shown(message):
    """Demand what RViz demands of every marker."""
    for marker in by_name(message).values():
        p, o, s, c = (marker.pose.position, marker.pose.orientation, marker.scale, marker.color)
        numbers = [p.x, p.y, p.z, o.x, o.y, o.z, o.w, s.x, s.y, s.z, c.r, c.g, c.b, c.a]
        numbers += [x for point in marker.points for x in (point.x, point.y, point.z)]
        assert np.isfinite(numbers).all()
        assert math.hypot(o.x, o.y, o.z, o.w) == pytest.approx(1.0, abs=1e-9)
        assert min(s.x, s.y, s.z) > 0.0 and 0.0 < c.a <= 1.0


def swept(marker):
    """Return how far an arc goes around its joint, in parts of three quarters of a turn."""
    angle = np.unwrap([math.atan2(point.y, point.x) for point in marker.points[:-3]])
    return (angle[-1] - angle[0]) / (1.5 * math.pi)


@pytest.mark.parametrize('name', ROBOTS)
def test_the_picture_is_that_of_the_services(client, start, name):
    model = RobotModel.from_urdf(ROBOTS[name])
    start(robot_description_file=ROBOTS[name], state_timeout=1.0)
    received = client.listen(MarkerArray, TOPIC)
    q = np.clip(np.linspace(0.6, -0.9, len(model.joint_names)), *model.position_limits.T)
    effort = model.gravity_torque(q) + 0.1 * np.nan_to_num(model.effort_limits, nan=1.0)

    def state():
        client.publish(reversed(model.joint_names), q[::-1], (), effort[::-1])
    client.until(lambda: len(received) >= 3, state)
    answer = client.call(GetGravityTorque, '/dynamics_node/get_gravity_torque', action=state)
    assert answer.success
    assert_fit_to_be_shown(received[-1])
    markers = by_name(received[-1])
    kinds = dict(zip(model.tree.body_names, model.tree.kind.tolist(), strict=True))
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
                assert swept(markers[group, i]) == pytest.approx(value / limit, abs=shortest)
    poses = model.body_poses(q)
    for k, inertia in enumerate(model.tree.inertia):
        if inertia[3, 3] > 0.0:
            place = markers['centre_of_mass', k].pose.position
            expected = (poses[k] @ inertia[:, 3] / inertia[3, 3])[:3]
            assert (place.x, place.y, place.z) == pytest.approx(expected, abs=1e-12)
    for marker in markers.values():
        assert marker.header.frame_id == model.tree.root
        assert abs(marker.header.stamp.sec - time.time()) < 60.0


def test_it_is_silent_until_somebody_listens_and_when_nobody_does_any_more(client, start):
    start(robot_description_file=PENDULUM, state_timeout=1.0)

    def state():
        client.publish(['hinge'], [0.3])
    client.until_heard(state)
    client.until(lambda: client.node.count_publishers(TOPIC))
    # Counted where it would be heard, by one who has never been there.
    client.during(0.5, state)
    received = []
    eye = client.node.create_subscription(MarkerArray, TOPIC, received.append, 10)
    client.until(lambda: len(received) >= 2, state)
    assert received[0].markers[0].action == Marker.DELETEALL  # the first that was ever made
    assert all(marker.action == Marker.ADD for marker in received[1].markers)
    client.node.destroy_subscription(eye)
    client.during(0.3, state)
    received.clear()
    client.during(0.3, state)
    assert received == []
    client.node.create_subscription(MarkerArray, TOPIC, received.append, 10)
    client.until(lambda: received, state)


def test_it_comes_at_a_rate_for_people_however_fast_the_states(client, start):
    start(robot_description_file=PENDULUM, state_timeout=1.0)
    times = []
    client.node.create_subscription(MarkerArray, TOPIC, lambda _: times.append(time.monotonic()),
                                    10)

    def state():
        client.publish(['hinge'], [0.3])
    client.until(lambda: times, state, period=0.003)
    times.clear()
    client.during(2.0, state, period=0.003)
    assert 2 <= len(times) <= 2.0 / PERIOD + 1


def test_another_description_takes_the_old_picture_away(client, start):
    start(state_timeout=1.0)
    received = client.listen(MarkerArray, TOPIC)
    client.until(lambda: client.description.get_subscription_count())
    client.description.publish(String(data=PENDULUM.read_text()))
    client.until(lambda: received, lambda: client.publish(['hinge'], [0.3]))
    assert by_name(received[-1])['torque_text', 0].text.startswith('hinge')
    arm = RobotModel.from_urdf(ARM7)
    client.description.publish(String(data=ARM7.read_text()))
    received.clear()
    client.until(lambda: received and len(received[-1].markers) > 40,
                 lambda: client.publish(arm.joint_names, arm.neutral_position))
    changed = next(message for message in received if len(message.markers) > 40)
    assert changed.markers[0].action == Marker.DELETEALL
    names = {marker.text.partition(':')[0] for marker in received[-1].markers
             if marker.ns == 'torque_text'}
    assert names == set(arm.joint_names)


def test_a_payload_comes_and_goes(client, start):
    arm = RobotModel.from_urdf(ARM7)
    start(robot_description_file=ARM7, state_timeout=1.0)
    received = client.listen(MarkerArray, TOPIC)

    def state():
        client.publish(arm.joint_names, arm.neutral_position)
    client.until(lambda: received, state)
    assert not any(group == 'payload' for group, _ in by_name(received[-1]))
    for mass in (2.0, 0.0):
        assert client.call(SetPayload, '/dynamics_node/set_payload', SetPayload.Request(
            link='hand', inertia=Inertia(m=mass, com=Vector3(z=0.1))), state).success
        client.until(lambda mass=mass: bool(mass) == any(
            group == 'payload' for group, _ in by_name(received[-1])), state)
        assert_fit_to_be_shown(received[-1])
    loaded = [message for message in received if ('payload', 0) in by_name(message)]
    place = by_name(loaded[-1])['payload', 0].pose.position
    expected = arm.link_pose(arm.neutral_position, 'hand') @ [0.0, 0.0, 0.1, 1.0]
    assert (place.x, place.y, place.z) == pytest.approx(expected[:3], abs=1e-12)


def test_the_effort_is_the_command_where_the_arm_does_not_say_it(client, start):
    start(robot_description_file=PENDULUM, state_timeout=1.0, effort_limits='[40.0]',
          start_ramp='0.0', effort_rate_limits='[1e6]')
    received = client.listen(MarkerArray, TOPIC)
    client.record_commands()

    def state():
        client.publish(['hinge'], [0.3])

    def arc():
        return by_name(received[-1]).get(('effort', 0)) if received else None
    client.until(lambda: received, state)
    assert arc() is None
    client.until_heard(state)
    assert client.enable(True, state).success
    client.until(arc, state)
    torque = RobotModel.from_urdf(PENDULUM).gravity_torque([0.3])[0]
    client.until(lambda: arc() and swept(arc()) == pytest.approx(torque / 40.0), state)
    assert swept(by_name(received[-1])['gravity_torque', 0]) == pytest.approx(torque / 40.0)
    # As soon as the arm says it, that counts.
    client.until(lambda: arc() and swept(arc()) == pytest.approx(-0.25),
                 lambda: client.publish(['hinge'], [0.3], (), [-10.0]))


# In this process ------------------------------------------------------------------------------

class Direct:
    """The publisher with a robot, whose listeners and messages are those of the test."""

    def __init__(self, client, listeners=1):
        self.listeners, self.published, self.changes, self.time = listeners, [], 0, 0.0
        self.cost = 0.0  # of every look at the clock, so of every step, s
        self.robot = Robot(RobotModel.from_urdf(ARM7), ())
        publisher = types.SimpleNamespace(publish=self.published.append,
                                          get_subscription_count=lambda: self.listeners)
        channel = types.SimpleNamespace(machine=types.SimpleNamespace(is_on=False))
        self.unit = Markers(types.SimpleNamespace(
            get_logger=client.node.get_logger, create_publisher=lambda *_, **__: publisher),
            {'effort_limits': ()}, channel, self._changed, self._clock)

    def _changed(self):
        self.changes += 1

    def _clock(self):
        self.time += self.cost
        return self.time

    def state(self, stamp=None, after=1.0):
        """Take a state some time, s, after the last; return how many messages there are."""
        self.time += after
        self.unit.on_state(self.robot, stamp or Time(), self.robot.gravity_torque())
        return len(self.published)


def test_rare_states_make_a_picture_at_once_and_pressing_ones_in_steps(client):
    direct = Direct(client)
    assert direct.state() == 0 and direct.changes == 1  # from the next one on there are efforts
    assert [direct.state() for _ in range(3)] == [1, 2, 3]
    direct.cost = 0.0003
    stamp, counts, times = Time(sec=0), [], []
    for _ in range(100):
        stamp.sec += 1  # as the next state does it, in the same message
        before = direct.time + 0.002
        counts.append(direct.state(stamp, after=0.002))
        times.append(direct.time - before)
    # A step takes longer than a tenth of the time between states: one of them after each.
    assert max(times) < 5 * direct.cost
    steps = np.diff([3, *counts])
    assert set(steps) == {0, 1} and 3 <= steps.sum() <= 6
    sent = np.flatnonzero(steps)
    # The stamp is that of the state that the picture shows, some before it goes out.
    for place, data in zip(sent, direct.published[3:], strict=True):
        picture = marker_writer.deserialize_message(data, MarkerArray)
        [shown] = {marker.header.stamp.sec for marker in picture.markers}
        assert 3 <= place + 1 - shown <= 12
    direct.cost = 0.0
    before = direct.state()
    assert [direct.state() for _ in range(3)] == [before + 1, before + 2, before + 3]


def test_no_state_waits_for_the_whole_picture_of_a_large_robot(client):
    direct = Direct(client)
    direct.robot = Robot(RobotModel.from_urdf(chain([1.0] * 120)), ())
    direct.state()
    direct.cost = 0.001
    for after in (0.01, 0.1, 10.0):
        before = len(direct.published)
        while len(direct.published) == before:
            begun = direct.time + after
            direct.state(after=after)
            assert direct.time - begun <= min(SHARE * after, LONGEST) * 1.2 + 5 * direct.cost


def test_a_picture_that_was_begun_is_dropped_when_nobody_listens_any_more(client):
    direct = Direct(client)
    assert [direct.state(), direct.state()] == [0, 1]
    direct.cost = 1.0  # one step after each state
    begun = direct.state()
    assert begun == 1
    direct.state()
    for is_wanted in (False, True):
        direct.unit._is_wanted = is_wanted
        assert direct.state() == begun
        assert direct.unit.is_on == is_wanted
    assert direct.changes == 3
    assert direct.state() == begun
    direct.cost = 0.0
    direct.state()
    shown = {marker.header.stamp.sec for marker in marker_writer.deserialize_message(
        direct.published[-1], MarkerArray).markers}
    assert len(direct.published) == begun + 1 and shown == {0}


def test_what_cannot_be_drawn_is_said_once_in_a_while(client, capfd):
    direct = Direct(client)
    direct.state()
    direct.unit._view_of(direct.robot).picture.parts = lambda *_: iter((None,))  # as none is
    capfd.readouterr()
    for _ in range(40):
        assert direct.state(after=COMPLAIN_EVERY / 20) == 0
    assert capfd.readouterr().err.count('Traceback') in (2, 3)


def test_without_its_bytes_rclpy_writes_the_message(client, monkeypatch):
    direct = Direct(client)
    direct.state()
    direct.state()
    monkeypatch.setattr(marker_writer.MarkerWriter, 'is_right', lambda self: False)
    other = Direct(client)
    other.state()
    other.state()
    assert isinstance(direct.published[0], bytes)
    assert (marker_writer.deserialize_message(direct.published[0], MarkerArray)
            == marker_writer.deserialize_message(
                marker_writer.serialize_message(other.published[0]), MarkerArray))


def test_an_error_in_it_leaves_the_torque_alone(client, capfd):
    direct = Direct(client)
    direct.state()
    buffer, direct.robot.buffer = direct.robot.buffer, None  # as nothing in the node does it
    direct.unit.on_state(direct.robot, Time(), np.zeros(8))
    assert direct.published == []
    assert 'Traceback' in capfd.readouterr().err
    direct.robot.buffer = buffer
    assert direct.state() == 1  # and it goes on


def test_the_axis_of_an_arc_is_that_of_the_joint(client, start):
    arm = RobotModel.from_urdf(ARM7)
    start(robot_description_file=ARM7, state_timeout=1.0)
    received = client.listen(MarkerArray, TOPIC)
    q = np.clip(np.full(8, 0.4), *arm.position_limits.T)
    client.until(lambda: received, lambda: client.publish(arm.joint_names, q))
    o = by_name(received[-1])['gravity_torque', 3].pose.orientation
    axis = pinocchio.Quaternion(o.w, o.x, o.y, o.z).toRotationMatrix()[:, 2]
    link = next(link for link, frame in arm.tree.links.items() if frame.body == 3)
    assert axis == pytest.approx(arm.jacobian(q, link)[3:, 3], abs=1e-12)
