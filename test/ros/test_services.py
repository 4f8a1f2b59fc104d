"""The services over DDS: given and measured states, orders, and what they refuse."""

from dynamics_interfaces.srv import (
    ForwardDynamics,
    GetCoriolisMatrix,
    GetDynamics,
    GetGravityTorque,
    GetJacobian,
    GetMassMatrix,
    InverseDynamics,
)
from dynamics_node import RobotModel
from geometry_msgs.msg import Point
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
KINDS = {
    'get_mass_matrix': GetMassMatrix,
    'get_coriolis_matrix': GetCoriolisMatrix,
    'get_gravity_torque': GetGravityTorque,
    'get_dynamics': GetDynamics,
    'inverse_dynamics': InverseDynamics,
    'forward_dynamics': ForwardDynamics,
    'get_jacobian': GetJacobian,
}
Q = np.clip(np.linspace(0.8, -0.9, N), *ARM.position_limits.T)
QD = np.linspace(-1.0, 1.5, N)


def assert_rounded(actual, expected):
    # The node may already use its robot's machine code, this process may not: both round.
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-14 * np.abs(expected).max())


def arrays(answer):
    """Return every array of an answer by its name."""
    return {
        name: getattr(answer, name)
        for name, kind in answer.get_fields_and_field_types().items()
        if kind.startswith('sequence')
    }


def test_services_answer_at_a_given_and_at_the_measured_state(shared):
    D, C, G = ARM.dynamics(Q, QD)

    def publish():
        shared.publish(reversed(ARM.joint_names), reversed(Q))

    for position, action in ((Q.tolist(), None), ([], publish)):
        if action:
            shared.until(shared.states.get_subscription_count)
            shared.during(0.2, publish)
        answer = shared.call(
            GetMassMatrix,
            '/dynamics_node/get_mass_matrix',
            GetMassMatrix.Request(position=position),
            action,
        )
        assert answer.success, answer.message
        assert tuple(answer.joint_names) == ARM.joint_names
        np.testing.assert_array_equal(answer.position, Q)
        assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D)

        answer = shared.call(
            GetCoriolisMatrix,
            '/dynamics_node/get_coriolis_matrix',
            GetCoriolisMatrix.Request(position=position, velocity=QD.tolist()),
            action,
        )
        assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C)
        np.testing.assert_allclose(answer.coriolis_torque, C @ QD, rtol=1e-13, atol=1e-15)
        np.testing.assert_array_equal(answer.velocity, QD)

        answer = shared.call(
            GetGravityTorque,
            '/dynamics_node/get_gravity_torque',
            GetGravityTorque.Request(position=position),
            action,
        )
        assert_rounded(answer.gravity_torque, G)

        answer = shared.call(
            GetDynamics,
            '/dynamics_node/get_dynamics',
            GetDynamics.Request(position=position, velocity=QD.tolist()),
            action,
        )
        assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D)
        assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C)
        assert_rounded(answer.gravity_torque, G)
        assert answer.kinetic_energy == pytest.approx(0.5 * QD @ D @ QD, rel=1e-13)
        assert answer.potential_energy == pytest.approx(ARM.potential_energy(Q), rel=1e-13)


def test_a_permutation_of_the_joints_permutes_the_answer(shared):
    order = np.random.default_rng(4).permutation(N)
    names = [ARM.joint_names[i] for i in order]
    answer = shared.call(
        GetDynamics,
        '/dynamics_node/get_dynamics',
        GetDynamics.Request(
            joint_names=names, position=Q[order].tolist(), velocity=QD[order].tolist()
        ),
    )
    D, C, G = ARM.dynamics(Q, QD)
    assert answer.joint_names == names
    np.testing.assert_array_equal(answer.position, Q[order])
    assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D[np.ix_(order, order)])
    assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C[np.ix_(order, order)])
    assert_rounded(answer.gravity_torque, G[order])


def test_velocity_left_out_is_zero(shared):
    answer = shared.call(
        GetCoriolisMatrix,
        '/dynamics_node/get_coriolis_matrix',
        GetCoriolisMatrix.Request(position=Q.tolist()),
    )
    assert answer.success
    assert not np.any(answer.coriolis_matrix)
    np.testing.assert_array_equal(answer.velocity, np.zeros(N))


def test_refused_requests_say_why_and_answer_empty_arrays(shared):
    shared.during(1.1)  # what another test has published becomes too old
    names = list(ARM.joint_names)
    cases = [
        ({}, f'no joint state within 1 s for {names[0]}'),
        ({'position': [0.0]}, f'position: expected {N} values'),
        (
            {'position': [*[0.0] * (N - 1), np.nan]},
            f'position: expected finite values, got nan for {names[-1]}',
        ),
        ({'joint_names': names[:-1], 'position': [0.0] * N}, f"'{names[-1]}' is missing"),
        (
            {'joint_names': [*names[:-1], names[-1][:-1]], 'position': [0.0] * N},
            f"not a joint that can be moved, is '{names[-1]}' meant?",
        ),
        ({'joint_names': [names[0]] * N, 'position': [0.0] * N}, 'is given twice'),
        ({'joint_names': ['a' * 900] * 2000}, "...' is given twice"),
    ]
    for fields, reason in cases:
        for name, kind in KINDS.items():
            answer = shared.call(kind, f'/dynamics_node/{name}', kind.Request(**fields))
            assert not answer.success
            assert reason in answer.message
            assert len(answer.message) < 1000
            assert all(len(array) == 0 for array in arrays(answer).values())
    for name, kind in KINDS.items():
        if hasattr(kind.Request(), 'velocity'):
            answer = shared.call(
                kind,
                f'/dynamics_node/{name}',
                kind.Request(position=Q.tolist(), velocity=[1e300] * N),
            )
            assert not answer.success
            assert 'the result is not finite' in answer.message
            assert all(len(array) == 0 for array in arrays(answer).values())
    answer = shared.call(GetDynamics, '/dynamics_node/get_dynamics')
    assert np.isnan(answer.kinetic_energy)
    assert np.isnan(answer.potential_energy)
    answer = shared.call(
        GetCoriolisMatrix,
        '/dynamics_node/get_coriolis_matrix',
        GetCoriolisMatrix.Request(position=Q.tolist(), velocity=[np.inf] * N),
    )
    assert 'velocity: expected finite values' in answer.message


def test_given_positions_beyond_their_limits_are_computed_with_and_named(shared):
    position = Q.copy()
    position[-1] = 5.0
    lower, upper = ARM.position_limits[-1]
    answer = shared.call(
        GetGravityTorque,
        '/dynamics_node/get_gravity_torque',
        GetGravityTorque.Request(position=position.tolist()),
    )
    assert answer.success
    assert answer.message.endswith(
        f'; beyond the position limits: {ARM.joint_names[-1]} at 5 (limits {lower:g} to {upper:g})'
    )
    assert_rounded(answer.gravity_torque, ARM.gravity_torque(position))
    answer = shared.call(
        GetGravityTorque,
        '/dynamics_node/get_gravity_torque',
        GetGravityTorque.Request(position=Q.tolist()),
    )
    assert 'limits' not in answer.message


def test_inverse_and_forward_dynamics_against_pinocchio(shared):
    judge, order = PinocchioOracle(ARM7.read_text()), np.random.default_rng(7).permutation(N)
    names, qdd = [ARM.joint_names[i] for i in order], np.linspace(2.0, -3.0, N)
    tau = judge.inverse_dynamics(ARM.joint_names, Q, QD, qdd)
    fields = {'joint_names': names, 'position': Q[order].tolist(), 'velocity': QD[order].tolist()}
    answer = shared.call(
        InverseDynamics,
        '/dynamics_node/inverse_dynamics',
        InverseDynamics.Request(**fields, acceleration=qdd[order].tolist()),
    )
    assert answer.success, answer.message
    assert answer.joint_names == names
    np.testing.assert_array_equal(answer.acceleration, qdd[order])
    np.testing.assert_allclose(answer.effort, tau[order], rtol=0, atol=1e-11 * np.abs(tau).max())
    answer = shared.call(
        ForwardDynamics,
        '/dynamics_node/forward_dynamics',
        ForwardDynamics.Request(**fields, effort=tau[order].tolist()),
    )
    assert answer.success, answer.message
    np.testing.assert_array_equal(answer.effort, tau[order])
    np.testing.assert_allclose(answer.acceleration, qdd[order], rtol=0, atol=1e-9)


def test_what_is_left_out_is_zero_and_the_flags_do_what_they_say(shared):
    def effort(**fields):
        answer = shared.call(
            InverseDynamics,
            '/dynamics_node/inverse_dynamics',
            InverseDynamics.Request(position=Q.tolist(), **fields),
        )
        assert answer.success, answer.message
        return np.array(answer.effort), answer.message

    assert_rounded(effort()[0], ARM.gravity_torque(Q))
    assert effort()[1] == 'at the given position, velocity zero, acceleration zero'
    moving, message = effort(velocity=QD.tolist(), without_gravity=True, with_friction=True)
    expected = ARM.coriolis_matrix(Q, QD) @ QD + ARM.friction_torque(QD)
    assert ARM.friction_torque(QD).any()
    assert_rounded(moving, expected)
    assert message.endswith('without gravity, with friction')
    answer = shared.call(
        ForwardDynamics,
        '/dynamics_node/forward_dynamics',
        ForwardDynamics.Request(position=Q.tolist(), velocity=QD.tolist(), with_friction=True),
    )
    expected = ARM.forward_dynamics(Q, QD, -ARM.friction_torque(QD))
    np.testing.assert_allclose(answer.acceleration, expected, rtol=1e-12)


def test_the_jacobian_of_a_point_of_a_link(shared):
    order = np.random.default_rng(8).permutation(N)
    answer = shared.call(
        GetJacobian,
        '/dynamics_node/get_jacobian',
        GetJacobian.Request(
            joint_names=[ARM.joint_names[i] for i in order],
            position=Q[order].tolist(),
            link='tool_center',
            point=Point(x=0.1, y=0.2, z=0.3),
        ),
    )
    assert answer.success, answer.message
    assert (answer.link, answer.frame_id) == ('tool_center', 'base')
    expected = ARM.jacobian(Q, 'tool_center', (0.1, 0.2, 0.3))
    assert_rounded(np.reshape(answer.jacobian, (6, N)), expected[:, order])
    pose = ARM.link_pose(Q, 'tool_center')
    place, turn = answer.pose.position, answer.pose.orientation
    assert [place.x, place.y, place.z] == pytest.approx(
        (pose @ [0.1, 0.2, 0.3, 1.0])[:3], abs=1e-14
    )
    rotation = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix()
    assert rotation == pytest.approx(pose[:3, :3], abs=1e-14)

    answer = shared.call(
        GetJacobian, '/dynamics_node/get_jacobian', GetJacobian.Request(position=Q.tolist())
    )
    assert answer.link == ARM.tip_link == 'tool_center'
    assert 'link tool_center' in answer.message
    answer = shared.call(
        GetJacobian,
        '/dynamics_node/get_jacobian',
        GetJacobian.Request(position=Q.tolist(), link='nose'),
    )
    assert not answer.success
    assert "link: 'nose' is not a link of the robot; expected one of base, " in answer.message
    answer = shared.call(
        GetJacobian,
        '/dynamics_node/get_jacobian',
        GetJacobian.Request(position=Q.tolist(), point=Point(y=np.nan)),
    )
    assert not answer.success
    assert answer.message == 'point: expected finite numbers, m, got [0.0, nan, 0.0]'
    assert len(answer.jacobian) == 0


def test_joints_that_were_not_chosen_are_held(client, start):
    chosen = [ARM.joint_names[i] for i in (3, 1, 5)]
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]')
    index, q = np.array([3, 1, 5]), ARM.neutral_position.copy()
    q[index] = Q[index]
    answer = client.call(
        ForwardDynamics,
        '/dynamics_node/forward_dynamics',
        ForwardDynamics.Request(position=Q[index].tolist()),
    )
    assert answer.joint_names == chosen
    D, G = ARM.mass_matrix(q)[np.ix_(index, index)], ARM.gravity_torque(q)[index]
    np.testing.assert_allclose(answer.acceleration, np.linalg.solve(D, -G), rtol=1e-12)
    answer = client.call(
        InverseDynamics,
        '/dynamics_node/inverse_dynamics',
        InverseDynamics.Request(
            position=Q[index].tolist(), acceleration=list(answer.acceleration)
        ),
    )
    assert np.asarray(answer.effort) == pytest.approx(0.0, abs=1e-12)
    answer = client.call(
        GetJacobian,
        '/dynamics_node/get_jacobian',
        GetJacobian.Request(position=Q[index].tolist(), link='hand'),
    )
    assert_rounded(np.reshape(answer.jacobian, (6, 3)), ARM.jacobian(q, 'hand')[:, index])


def test_without_a_robot_the_answer_says_what_to_do(client, start):
    start()
    answer = client.call(GetMassMatrix, '/dynamics_node/get_mass_matrix')
    assert not answer.success
    assert 'publish robot_description' in answer.message


def test_joints_outside_the_choice_stand_where_they_were_measured(client, start):
    chosen = [ARM.joint_names[1], ARM.joint_names[3]]
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]')
    others = [name for name in ARM.joint_names if name not in chosen]
    place = np.array([ARM.joint_names.index(name) for name in others])

    def ask(action=None):
        answer = client.call(
            GetMassMatrix,
            '/dynamics_node/get_mass_matrix',
            GetMassMatrix.Request(position=[0.4, -0.6]),
            action,
        )
        return np.reshape(answer.mass_matrix, (2, 2))

    def expected(q):
        q = q.copy()
        q[[1, 3]] = 0.4, -0.6
        return ARM.mass_matrix(q)[np.ix_([1, 3], [1, 3])]

    assert_rounded(ask(), expected(ARM.neutral_position))
    client.until(client.states.get_subscription_count)
    client.during(0.2, lambda: client.publish(others, Q[place]))
    assert_rounded(ask(), expected(Q))
