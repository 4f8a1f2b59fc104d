"""~/set_payload and ~/set_gravity over DDS: effects, refusals and answers."""

import re

from dynamics_interfaces.srv import GetGravityTorque, InverseDynamics, SetGravity, SetPayload
from dynamics_node import RobotModel
from geometry_msgs.msg import Inertia, Vector3, Vector3Stamped
import numpy as np
import pytest
from std_msgs.msg import Header
from support.pinocchio_oracle import PinocchioOracle
from support.processes import Diagnostics
from support.random_payload import with_payload_link
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
Q = np.clip(np.linspace(0.8, -0.9, N), *ARM.position_limits.T)
FRICTION = ('viscous', 'coulomb', 'smoothing_velocity')
DOWN = (0.0, 0.0, -9.81)
ON_HAND = {'payload.link': 'hand', 'payload.mass': 1.5}
COM = (0.01, -0.02, 0.08)
SIX = {'ixx': 0.02, 'ixy': 0.001, 'ixz': -0.002, 'iyy': 0.03, 'iyz': 0.003, 'izz': 0.025}
TENSOR = np.array([[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.025]])
BOX = Inertia(m=1.5, com=Vector3(x=COM[0], y=COM[1], z=COM[2]), **SIX)


def set_payload(client, link='', inertia=None):
    """Call ~/set_payload; without a payload by default."""
    return client.ask(SetPayload, link=link, inertia=inertia or Inertia())


def set_gravity(client, vector, frame='', action=None):
    """Call ~/set_gravity."""
    x, y, z = map(float, vector)
    stamped = Vector3Stamped(header=Header(frame_id=frame), vector=Vector3(x=x, y=y, z=z))
    return client.ask(SetGravity, action, gravity=stamped)


def numbers(stamped):
    """Return the numbers of a stamped vector."""
    return [stamped.vector.x, stamped.vector.y, stamped.vector.z]


def gravity_torque(client):
    """Return G at Q from the node."""
    answer = client.ask(GetGravityTorque, position=Q.tolist())
    assert answer.success, answer.message
    return np.array(answer.gravity_torque)


def assert_gravity_torque_of(model, client):
    np.testing.assert_allclose(gravity_torque(client), model.gravity_torque(Q), rtol=0, atol=1e-12)


def assert_gravity_torque_with_box(client, link, gravity=DOWN):
    # By Pinocchio, from a URDF with the box as another link.
    text = with_payload_link(ARM7.read_text(), link, BOX.m, COM, TENSOR)
    expected = PinocchioOracle(text, gravity).dynamics(ARM.joint_names, Q, 0 * Q)[2]
    np.testing.assert_allclose(
        gravity_torque(client), expected, rtol=0, atol=1e-11 * np.abs(expected).max()
    )


def assert_refused(answer, message):
    assert not answer.success
    assert re.search(message, answer.message), answer.message


@pytest.fixture(autouse=True)
def reset(shared):
    yield
    assert set_payload(shared).success
    assert set_gravity(shared, DOWN).success


def test_a_payload_changes_gravity_torque_and_leaves_no_trace_when_removed(shared):
    before, diagnostics = gravity_torque(shared), Diagnostics(shared)
    for link in ('tool_center', 'forearm'):
        answer = set_payload(shared, link, BOX)
        assert answer.success, answer.message
        text = f'1.5 kg on {link}'
        assert (answer.message, answer.link, answer.inertia) == (text, link, BOX)
        assert_gravity_torque_with_box(shared, link)
        shared.until(lambda: diagnostics.values('model').get('payload') == text)  # noqa: B023
        parameters = {'link': link, 'mass': 1.5, 'com': [*COM], 'inertia': [*SIX.values()]}
        for name, value in parameters.items():
            assert shared.node_parameter(f'payload.{name}') == value
    answer = set_payload(shared, 'hand')
    assert (answer.success, answer.message) == (True, 'nothing is carried')
    assert (answer.link, answer.inertia) == ('', Inertia())
    assert shared.node_parameter('payload.mass') == 0.0
    assert gravity_torque(shared).tolist() == before.tolist()
    # On a link that no joint moves it has no effect.
    answer = set_payload(shared, 'base', BOX)
    assert answer.success
    assert answer.message == '1.5 kg on base, which no joint moves: without any effect'
    assert gravity_torque(shared).tolist() == before.tolist()


@pytest.mark.parametrize(
    ('link', 'inertia', 'message'),
    [
        ('nose', BOX, "^link: 'nose' is not a link of the robot; expected one of base, shoulder"),
        ('', BOX, 'link: expected the one that carries the payload, got none: one of base, '),
        ('hand', Inertia(m=-1.0), r'^inertia\.m: expected a number >= 0 and <= 100000, got -1.0$'),
        ('hand', Inertia(m=np.nan), r'^inertia\.m: expected a number .* <= 100000, got nan$'),
        ('hand', Inertia(m=1.0, com=Vector3(x=np.inf)), r'^inertia\.com: expected .* >= -1000 '),
        ('hand', Inertia(m=1.0, com=Vector3(y=1e200)), r'^inertia\.com: expected .*got 1e\+200'),
        ('hand', Inertia(m=1.0, ixy=np.nan), r'^inertia\.ixx to izz: expected a finite number, '),
        ('hand', Inertia(m=1.0, ixx=0.1, iyy=0.1, izz=0.5), 'inertia is not physical: .*triangle'),
    ],
)
def test_a_wrong_payload_is_refused_and_the_last_one_stays(shared, link, inertia, message):
    assert set_payload(shared, 'hand', BOX).success
    loaded = gravity_torque(shared)
    answer = set_payload(shared, link, inertia)
    assert_refused(answer, message)
    assert (answer.link, answer.inertia) == ('hand', BOX)
    assert gravity_torque(shared).tolist() == loaded.tolist()


def test_the_payload_can_be_set_by_single_parameters(shared):
    for name, value, reason in (
        ('mass', 1.5, 'payload.link: expected the link'),
        ('link', 'nose', "payload.link: 'nose' is not a link"),
    ):
        refused = shared.set_node_parameter(f'payload.{name}', value)
        assert not refused.successful
        assert reason in refused.reason
    assert shared.set_node_parameter('payload.link', 'hand').successful
    assert shared.set_node_parameter('payload.mass', 1.5).successful
    assert_gravity_torque_of(ARM.with_payload('hand', 1.5), shared)


@pytest.mark.parametrize('frame', ['', 'base'])
def test_gravity_in_the_frame_of_the_root_link(shared, frame):
    answer = set_gravity(shared, (0.0, 9.81, 0.0), frame)
    assert answer.success, answer.message
    assert answer.message == 'gravity is 9.81 m/s^2 along this vector'
    assert_gravity_torque_of(ARM.with_gravity((0.0, 9.81, 0.0)), shared)


def test_gravity_in_the_frame_of_a_moving_link(shared):
    # As from an inclinometer on the hand.
    in_hand = np.array([3.0, -4.0, 8.0])
    in_base = ARM.link_pose(Q, 'hand')[:3, :3] @ in_hand

    def publish():
        shared.publish(reversed(ARM.joint_names), reversed(Q))

    shared.until_heard(publish)
    answer = set_gravity(shared, in_hand, 'hand', publish)
    assert answer.success, answer.message
    assert 'not that of the earth' in answer.message
    assert answer.gravity.header.frame_id == 'base'
    assert numbers(answer.gravity) == pytest.approx(in_base, abs=1e-14)
    assert shared.node_parameter('gravity') == numbers(answer.gravity)
    assert_gravity_torque_of(ARM.with_gravity(in_base), shared)


def test_only_the_joints_between_base_and_frame_must_be_measured(client, start):
    start(robot_description_file=ARM7, joints='[shoulder_yaw, shoulder_pitch]', state_timeout=1.0)

    def publish():
        client.publish(['shoulder_yaw', 'shoulder_pitch'], [0.3, 0.5])

    client.until_heard(publish)
    # The elbow, which turns the hand, is not measured.
    answer = set_gravity(client, DOWN, 'hand', publish)
    assert not answer.success
    assert 'no joint state within 1 s for upper_arm_roll, elbow_pitch, ' in answer.message
    assert answer.gravity.vector.z == -9.81
    q = ARM.neutral_position
    q[:2] = 0.3, 0.5
    answer = set_gravity(client, (0.0, 3.0, -9.0), 'upper_arm', publish)
    assert answer.success, answer.message
    expected = ARM.link_pose(q, 'upper_arm')[:3, :3] @ (0.0, 3.0, -9.0)
    assert numbers(answer.gravity) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize('gravity', [(9.81, 0.0, 0.0), (0.0, 0.0, 9.81), (3.0, -5.0, 7.5)])
def test_gravity_torque_of_a_payload_in_any_mounting(shared, gravity):
    assert set_payload(shared, 'hand', BOX).success
    assert set_gravity(shared, gravity).success
    assert_gravity_torque_with_box(shared, 'hand', gravity)


@pytest.mark.parametrize(
    ('vector', 'frame', 'message'),
    [
        ((0.0, 0.0, 0.0), '', 'expected a vector that points to the earth, got zero'),
        ((0.0, 0.0, np.nan), '', 'gravity: expected finite numbers'),
        ((0.0, 0.0, -30.0), '', 'gravity: expected a number >= -20'),
        (
            DOWN,
            'map',
            "^header.frame_id: 'map' is not a link of the robot; expected one of base, ",
        ),
        (DOWN, 'elbow', 'how elbow is turned is not known: no joint state within 1 s'),
    ],
)
def test_a_wrong_gravity_is_refused_and_the_last_one_stays(shared, vector, frame, message):
    shared.during(1.1)  # until the states of other tests are too old
    answer = set_gravity(shared, vector, frame)
    assert_refused(answer, message)
    assert answer.gravity.vector.z == -9.81
    assert answer.gravity.header.frame_id == 'base'


def test_gravity_payload_rotors_and_friction_from_the_start(client, start):
    start(
        robot_description_file=ARM7,
        gravity='[0.0, 0.0, 9.81]',
        rotor_inertia='[0.3, 0.1]',
        joints='[elbow_pitch, wrist_roll]',
        **{
            **ON_HAND,
            'payload.com': str(list(COM)),
            'payload.inertia': str(list(SIX.values())),
            'friction.viscous': '[0.7, 0.2]',
            'friction.coulomb': '[0.4, 0.3]',
            'friction.smoothing_velocity': 0.1,
        },
    )
    index = [ARM.joint_names.index(name) for name in ('elbow_pitch', 'wrist_roll')]
    q, qd, qdd, rotors = np.zeros((4, N))
    q[:] = ARM.neutral_position
    state = {'position': [0.3, 0.4], 'velocity': [0.2, -0.3], 'acceleration': [2.0, 3.0]}
    q[index], qd[index], qdd[index] = state.values()
    rotors[index] = 0.3, 0.1
    text = with_payload_link(ARM7.read_text(), 'hand', BOX.m, COM, TENSOR)
    effort = PinocchioOracle(text, (0.0, 0.0, 9.81)).inverse_dynamics(ARM.joint_names, q, qd, qdd)
    effort = (effort + rotors * qdd)[index]
    friction = [0.7 * 0.2 + 0.4 * np.tanh(2.0), 0.2 * -0.3 + 0.3 * np.tanh(-3.0)]
    for with_friction in (False, True):
        answer = client.ask(InverseDynamics, **state, with_friction=with_friction)
        assert answer.success, answer.message
        expected = effort + np.multiply(friction, with_friction)
        np.testing.assert_allclose(answer.effort, expected, rtol=1e-11)


def test_friction_and_rotor_inertia_change_at_run_time(shared, change):
    qd, qdd = np.full(N, 0.1), np.ones(N)
    motion = {'position': Q.tolist(), 'velocity': qd.tolist(), 'acceleration': qdd.tolist()}

    def effort():
        return np.array(shared.ask(InverseDynamics, **motion, with_friction=True).effort)

    def assert_effort_of(model):
        expected = model.inverse_dynamics(Q, qd, qdd) + model.friction_torque(qd)
        np.testing.assert_allclose(effort(), expected, rtol=0, atol=1e-12)

    model = ARM
    names = ['rotor_inertia', *(f'friction.{part}' for part in FRICTION)]
    for name in names:
        values, before, field = np.linspace(0.1, 0.8, N), effort(), name.split('.')[-1]
        replaced = model.with_rotor_inertia if field == name else model.with_friction
        model = replaced(**{field: values})
        change(name, values.tolist())
        assert_effort_of(model)
        assert np.abs(effort() - before).max() > 0.01, name
    for name in names:
        change(name, [])
    assert_effort_of(ARM)
