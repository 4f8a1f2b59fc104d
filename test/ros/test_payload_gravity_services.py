"""~/set_payload and ~/set_gravity over DDS: what they change, refuse and answer."""

import re

from diagnostic_msgs.msg import DiagnosticArray
from dynamics_interfaces.srv import GetGravityTorque, InverseDynamics, SetGravity, SetPayload
from dynamics_node import RobotModel
from geometry_msgs.msg import Inertia, Vector3, Vector3Stamped
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from std_msgs.msg import Header
from support.pinocchio_oracle import PinocchioOracle
from support.random_payload import with_payload_link
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
Q = np.clip(np.linspace(0.8, -0.9, N), *ARM.position_limits.T)
TENSOR = np.array([[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.025]])
BOX = Inertia(
    m=1.5,
    com=Vector3(x=0.01, y=-0.02, z=0.08),
    ixx=0.02,
    ixy=0.001,
    ixz=-0.002,
    iyy=0.03,
    iyz=0.003,
    izz=0.025,
)


def set_payload(client, link='', inertia=None, action=None):
    """Call ~/set_payload."""
    return client.call(
        SetPayload,
        '/dynamics_node/set_payload',
        SetPayload.Request(link=link, inertia=inertia or Inertia()),
        action,
    )


def set_gravity(client, vector, frame='', action=None):
    """Call ~/set_gravity."""
    x, y, z = map(float, vector)
    stamped = Vector3Stamped(header=Header(frame_id=frame), vector=Vector3(x=x, y=y, z=z))
    return client.call(
        SetGravity, '/dynamics_node/set_gravity', SetGravity.Request(gravity=stamped), action
    )


def gravity_torque(client):
    """Return G at Q."""
    answer = client.call(
        GetGravityTorque,
        '/dynamics_node/get_gravity_torque',
        GetGravityTorque.Request(position=Q.tolist()),
    )
    assert answer.success, answer.message
    return np.array(answer.gravity_torque)


def parameter(client, name):
    """Return a parameter of the node."""
    answer = client.call(
        GetParameters, '/dynamics_node/get_parameters', GetParameters.Request(names=[name])
    )
    value = answer.values[0]
    return {3: value.double_value, 4: value.string_value, 8: list(value.double_array_value)}[
        value.type
    ]


@pytest.fixture(autouse=True)
def as_it_was(shared):
    yield
    assert set_payload(shared).success
    assert set_gravity(shared, (0.0, 0.0, -9.81)).success


def test_a_payload_weighs_moves_and_is_gone_without_a_trace(shared):
    before, health = gravity_torque(shared), shared.listen(DiagnosticArray, '/diagnostics')
    for link in ('tool_center', 'forearm'):
        answer = set_payload(shared, link, BOX)
        assert answer.success, answer.message
        assert answer.message == f'1.5 kg on {link}'
        assert (answer.link, answer.inertia) == (link, BOX)
        text = with_payload_link(ARM7.read_text(), link, 1.5, (0.01, -0.02, 0.08), TENSOR)
        expected = PinocchioOracle(text).dynamics(ARM.joint_names, Q, 0 * Q)[2]
        np.testing.assert_allclose(
            gravity_torque(shared), expected, rtol=0, atol=1e-11 * np.abs(expected).max()
        )
        shared.until(
            lambda: any(
                status.values
                and {value.key: value.value for value in status.values}.get('payload')
                == f'1.5 kg on {link}'  # noqa: B023
                for message in health
                for status in message.status
            )
        )
        # Readable by everybody.
        assert parameter(shared, 'payload.link') == link
        assert parameter(shared, 'payload.mass') == 1.5
        assert parameter(shared, 'payload.com') == [0.01, -0.02, 0.08]
        assert parameter(shared, 'payload.inertia') == [0.02, 0.001, -0.002, 0.03, 0.003, 0.025]
    answer = set_payload(shared, 'hand')
    assert (answer.success, answer.message) == (True, 'nothing is carried')
    assert (answer.link, answer.inertia) == ('', Inertia())
    assert parameter(shared, 'payload.mass') == 0.0
    assert gravity_torque(shared).tolist() == before.tolist()


def test_on_a_link_that_no_joint_moves_it_has_no_effect_and_it_says_so(shared):
    before = gravity_torque(shared)
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
        (
            'hand',
            Inertia(m=np.nan),
            r'^inertia\.m: expected a number >= 0 and <= 100000, got nan$',
        ),
        (
            'hand',
            Inertia(m=1.0, com=Vector3(x=np.inf)),
            r'^inertia\.com: expected a number >= -1000 ',
        ),
        ('hand', Inertia(m=1.0, com=Vector3(y=1e200)), r'^inertia\.com: expected .*got 1e\+200'),
        (
            'hand',
            Inertia(m=1.0, ixy=np.nan),
            r'^inertia\.ixx to izz: expected a finite number, got ',
        ),
        ('hand', Inertia(m=1.0, ixx=0.1, iyy=0.1, izz=0.5), 'inertia is not physical: .*triangle'),
    ],
)
def test_what_no_robot_can_carry_is_refused_and_the_last_one_stays(shared, link, inertia, message):
    assert set_payload(shared, 'hand', BOX).success
    loaded = gravity_torque(shared)
    answer = set_payload(shared, link, inertia)
    assert not answer.success
    assert re.search(message, answer.message), answer.message
    assert (answer.link, answer.inertia) == ('hand', BOX)
    assert gravity_torque(shared).tolist() == loaded.tolist()


def test_the_parameters_set_one_by_one_say_the_same(shared):
    def put(name, **value):
        answer = shared.call(
            SetParameters,
            '/dynamics_node/set_parameters',
            SetParameters.Request(
                parameters=[Parameter(name=name, value=ParameterValue(**value))]
            ),
        )
        return answer.results[0]

    refused = put('payload.mass', type=3, double_value=1.5)
    assert not refused.successful
    assert 'payload.link: expected the link' in refused.reason
    reason = put('payload.link', type=4, string_value='nose').reason
    assert "payload.link: 'nose' is not a link" in reason
    assert put('payload.link', type=4, string_value='hand').successful
    assert put('payload.mass', type=3, double_value=1.5).successful
    expected = ARM.with_payload('hand', 1.5).gravity_torque(Q)
    np.testing.assert_allclose(gravity_torque(shared), expected, rtol=0, atol=1e-12)


def test_gravity_along_any_vector_in_the_frame_of_any_link(shared):
    for frame in ('', 'base'):
        answer = set_gravity(shared, (0.0, 9.81, 0.0), frame)
        assert answer.success, answer.message
        assert answer.message == 'gravity is 9.81 m/s^2 along this vector'
        np.testing.assert_allclose(
            gravity_torque(shared),
            ARM.with_gravity((0.0, 9.81, 0.0)).gravity_torque(Q),
            rtol=0,
            atol=1e-12,
        )
        assert set_gravity(shared, (0.0, 0.0, -9.81)).success
    # An inclinometer on the hand says where the earth is, seen from there.
    in_hand = np.array([3.0, -4.0, 8.0])
    turn = ARM.link_pose(Q, 'hand')[:3, :3]

    def publish():
        shared.publish(reversed(ARM.joint_names), reversed(Q))

    shared.until_heard(publish)
    answer = set_gravity(shared, in_hand, 'hand', publish)
    assert answer.success, answer.message
    assert 'not that of the earth' in answer.message
    assert answer.gravity.header.frame_id == 'base'
    vector = answer.gravity.vector
    assert [vector.x, vector.y, vector.z] == pytest.approx(turn @ in_hand, abs=1e-14)
    assert parameter(shared, 'gravity') == [vector.x, vector.y, vector.z]
    np.testing.assert_allclose(
        gravity_torque(shared),
        ARM.with_gravity(turn @ in_hand).gravity_torque(Q),
        rtol=0,
        atol=1e-12,
    )


def test_only_the_joints_that_turn_a_frame_must_be_measured(client, start):
    start(robot_description_file=ARM7, joints='[shoulder_yaw, shoulder_pitch]', state_timeout=1.0)

    def publish():
        client.publish(['shoulder_yaw', 'shoulder_pitch'], [0.3, 0.5])

    client.until_heard(publish)
    # Nobody has said how the elbow is turned, and the hand with it.
    answer = set_gravity(client, (0.0, 0.0, -9.81), 'hand', publish)
    assert not answer.success
    assert 'no joint state within 1 s for upper_arm_roll, elbow_pitch, ' in answer.message
    assert answer.gravity.vector.z == -9.81
    q = ARM.neutral_position
    q[:2] = 0.3, 0.5
    answer = set_gravity(client, (0.0, 3.0, -9.0), 'upper_arm', publish)
    assert answer.success, answer.message
    expected = ARM.link_pose(q, 'upper_arm')[:3, :3] @ (0.0, 3.0, -9.0)
    vector = answer.gravity.vector
    assert [vector.x, vector.y, vector.z] == pytest.approx(expected, abs=1e-14)


def test_a_payload_follows_gravity_whatever_the_mounting(shared):
    assert set_payload(shared, 'hand', BOX).success
    for gravity in ((9.81, 0.0, 0.0), (0.0, 0.0, 9.81), (3.0, -5.0, 7.5)):
        assert set_gravity(shared, gravity).success
        text = with_payload_link(ARM7.read_text(), 'hand', 1.5, (0.01, -0.02, 0.08), TENSOR)
        expected = PinocchioOracle(text, gravity).dynamics(ARM.joint_names, Q, 0 * Q)[2]
        np.testing.assert_allclose(
            gravity_torque(shared), expected, rtol=0, atol=1e-11 * np.abs(expected).max()
        )


@pytest.mark.parametrize(
    ('vector', 'frame', 'message'),
    [
        ((0.0, 0.0, 0.0), '', 'expected a vector that points to the earth, got zero'),
        ((0.0, 0.0, np.nan), '', 'gravity: expected finite numbers'),
        ((0.0, 0.0, -30.0), '', 'gravity: expected a number >= -20'),
        (
            (0.0, 0.0, -9.81),
            'map',
            "^header.frame_id: 'map' is not a link of the robot; expected one of base, ",
        ),
        (
            (0.0, 0.0, -9.81),
            'elbow',
            'how elbow is turned is not known: no joint state within 1 s',
        ),
    ],
)
def test_a_gravity_that_cannot_be_is_refused(shared, vector, frame, message):
    shared.during(1.1)  # what another test has published becomes too old
    answer = set_gravity(shared, vector, frame)
    assert not answer.success
    assert re.search(message, answer.message), answer.message
    assert answer.gravity.vector.z == -9.81
    assert answer.gravity.header.frame_id == 'base'


def test_all_of_it_from_the_start_by_parameters(client, start):
    start(
        robot_description_file=ARM7,
        gravity='[0.0, 0.0, 9.81]',
        rotor_inertia='[0.3, 0.1]',
        joints='[elbow_pitch, wrist_roll]',
        **{
            'payload.link': 'hand',
            'payload.mass': 1.5,
            'payload.com': '[0.01, -0.02, 0.08]',
            'payload.inertia': '[0.02, 0.001, -0.002, 0.03, 0.003, 0.025]',
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
    text = with_payload_link(ARM7.read_text(), 'hand', 1.5, (0.01, -0.02, 0.08), TENSOR)
    effort = PinocchioOracle(text, (0.0, 0.0, 9.81)).inverse_dynamics(ARM.joint_names, q, qd, qdd)
    effort = (effort + rotors * qdd)[index]
    friction = [0.7 * 0.2 + 0.4 * np.tanh(2.0), 0.2 * -0.3 + 0.3 * np.tanh(-3.0)]
    for with_friction in (False, True):
        answer = client.call(
            InverseDynamics,
            '/dynamics_node/inverse_dynamics',
            InverseDynamics.Request(**state, with_friction=with_friction),
        )
        assert answer.success, answer.message
        expected = effort + np.multiply(friction, with_friction)
        np.testing.assert_allclose(answer.effort, expected, rtol=1e-11)


@pytest.mark.parametrize(
    ('parameters', 'message'),
    [
        ({'payload.mass': 1.0}, 'payload.link: expected the link that carries payload.mass'),
        (
            {'payload.mass': 1.0, 'payload.link': 'nose'},
            "payload.link: 'nose' is not a link of the robot; expected one of base",
        ),
        (
            {
                'payload.mass': 1.0,
                'payload.link': 'hand',
                'payload.inertia': '[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]',
            },
            'inertia is not physical',
        ),
        ({'rotor_inertia': '[0.1]'}, 'rotor_inertia: expected 8 numbers for shoulder_yaw'),
        ({'friction.coulomb': '[-1.0]'}, 'friction.coulomb: expected a number >= 0 and <= 1e.06'),
    ],
)
def test_a_start_with_wrong_ones_ends_at_once_and_says_why(start, parameters, message):
    code, output = start(robot_description_file=ARM7, **parameters).wait(60.0)
    assert code == 1
    assert re.search(message, output), output


def test_friction_and_rotors_at_run_time(shared):
    def put(name, *values):
        answer = shared.call(
            SetParameters,
            '/dynamics_node/set_parameters',
            SetParameters.Request(
                parameters=[
                    Parameter(
                        name=name, value=ParameterValue(type=8, double_array_value=list(values))
                    )
                ]
            ),
        )
        assert answer.results[0].successful, answer.results[0].reason

    def effort():
        answer = shared.call(
            InverseDynamics,
            '/dynamics_node/inverse_dynamics',
            InverseDynamics.Request(
                position=Q.tolist(), velocity=[0.1] * N, acceleration=[1.0] * N, with_friction=True
            ),
        )
        return np.array(answer.effort)

    model, qd, qdd = ARM, np.full(N, 0.1), np.ones(N)
    for name in (
        'rotor_inertia',
        'friction.viscous',
        'friction.coulomb',
        'friction.smoothing_velocity',
    ):
        values, before, field = np.linspace(0.1, 0.8, N), effort(), name.split('.')[-1]
        change = model.with_rotor_inertia if field == name else model.with_friction
        model = change(**{field: values})
        put(name, *values)
        after = effort()
        expected = model.inverse_dynamics(Q, qd, qdd) + model.friction_torque(qd)
        np.testing.assert_allclose(after, expected, rtol=0, atol=1e-12)
        assert np.abs(after - before).max() > 0.01, name
    for name in (
        'rotor_inertia',
        'friction.viscous',
        'friction.coulomb',
        'friction.smoothing_velocity',
    ):
        put(name)
    expected = ARM.inverse_dynamics(Q, qd, qdd) + ARM.friction_torque(qd)
    np.testing.assert_allclose(effort(), expected, rtol=0, atol=1e-12)
