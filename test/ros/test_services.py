"""The services over DDS: given and measured states, orders, and what they refuse."""

from dynamics_interfaces.srv import (
    GetCoriolisMatrix,
    GetDynamics,
    GetGravityTorque,
    GetMassMatrix,
)
from dynamics_node import RobotModel
import numpy as np
import pytest
from support.domains import claim
from support.processes import Client, NodeProcess
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
KINDS = {'get_mass_matrix': GetMassMatrix, 'get_coriolis_matrix': GetCoriolisMatrix,
         'get_gravity_torque': GetGravityTorque, 'get_dynamics': GetDynamics}
Q = np.clip(np.linspace(0.8, -0.9, N), *ARM.position_limits.T)
QD = np.linspace(-1.0, 1.5, N)


@pytest.fixture(scope='module')
def shared():
    """Return a client of a node with arm7, for all tests that only ask."""
    # In a domain of its own: other tests here start nodes of the same name.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv('ROS_DOMAIN_ID', str(claim()))
        node, client = NodeProcess(robot_description_file=ARM7), Client()
    yield client
    client.close()
    node.close()


def assert_rounded(actual, expected):
    # The node may already use its robot's machine code, this process may not: both round.
    np.testing.assert_allclose(actual, expected, rtol=0, atol=1e-14 * np.abs(expected).max())


def arrays(answer):
    """Return every array of an answer by its name."""
    return {name: getattr(answer, name) for name, kind in
            answer.get_fields_and_field_types().items() if kind.startswith('sequence')}


def test_services_answer_at_a_given_and_at_the_measured_state(shared):
    D, C, G = ARM.dynamics(Q, QD)

    def publish():
        shared.publish(reversed(ARM.joint_names), reversed(Q))

    for position, action in ((Q.tolist(), None), ([], publish)):
        if action:
            shared.until(shared.states.get_subscription_count)
            shared.during(0.2, publish)
        answer = shared.call(GetMassMatrix, '/dynamics_node/get_mass_matrix',
                             GetMassMatrix.Request(position=position), action)
        assert answer.success, answer.message
        assert tuple(answer.joint_names) == ARM.joint_names
        np.testing.assert_array_equal(answer.position, Q)
        assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D)

        answer = shared.call(GetCoriolisMatrix, '/dynamics_node/get_coriolis_matrix',
                             GetCoriolisMatrix.Request(position=position, velocity=QD.tolist()),
                             action)
        assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C)
        np.testing.assert_allclose(answer.coriolis_torque, C @ QD, rtol=1e-13, atol=1e-15)
        np.testing.assert_array_equal(answer.velocity, QD)

        answer = shared.call(GetGravityTorque, '/dynamics_node/get_gravity_torque',
                             GetGravityTorque.Request(position=position), action)
        assert_rounded(answer.gravity_torque, G)

        answer = shared.call(GetDynamics, '/dynamics_node/get_dynamics',
                             GetDynamics.Request(position=position, velocity=QD.tolist()), action)
        assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D)
        assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C)
        assert_rounded(answer.gravity_torque, G)
        assert answer.kinetic_energy == pytest.approx(0.5 * QD @ D @ QD, rel=1e-13)
        assert answer.potential_energy == pytest.approx(ARM.potential_energy(Q), rel=1e-13)


def test_a_permutation_of_the_joints_permutes_the_answer(shared):
    order = np.random.default_rng(4).permutation(N)
    names = [ARM.joint_names[i] for i in order]
    answer = shared.call(GetDynamics, '/dynamics_node/get_dynamics', GetDynamics.Request(
        joint_names=names, position=Q[order].tolist(), velocity=QD[order].tolist()))
    D, C, G = ARM.dynamics(Q, QD)
    assert answer.joint_names == names
    np.testing.assert_array_equal(answer.position, Q[order])
    assert_rounded(np.reshape(answer.mass_matrix, (N, N)), D[np.ix_(order, order)])
    assert_rounded(np.reshape(answer.coriolis_matrix, (N, N)), C[np.ix_(order, order)])
    assert_rounded(answer.gravity_torque, G[order])


def test_velocity_left_out_is_zero(shared):
    answer = shared.call(GetCoriolisMatrix, '/dynamics_node/get_coriolis_matrix',
                         GetCoriolisMatrix.Request(position=Q.tolist()))
    assert answer.success
    assert not np.any(answer.coriolis_matrix)
    np.testing.assert_array_equal(answer.velocity, np.zeros(N))


def test_refused_requests_say_why_and_answer_empty_arrays(shared):
    shared.during(0.2)  # what another test has published becomes too old
    names = list(ARM.joint_names)
    cases = [({}, f'no joint state within 0.1 s for {names[0]}'),
             ({'position': [0.0]}, f'position: expected {N} values'),
             ({'position': [np.nan] * N}, 'position: expected finite values'),
             ({'joint_names': names[:2], 'position': [0.0] * N}, 'expected a permutation of'),
             ({'joint_names': [*names[:-1], 'elbow'], 'position': [0.0] * N}, "'elbow'"),
             ({'joint_names': [names[0]] * N, 'position': [0.0] * N}, 'permutation')]
    for fields, reason in cases:
        for name, kind in KINDS.items():
            answer = shared.call(kind, f'/dynamics_node/{name}', kind.Request(**fields))
            assert not answer.success
            assert reason in answer.message
            assert all(len(array) == 0 for array in arrays(answer).values())
    for name, kind in KINDS.items():
        if hasattr(kind.Request(), 'velocity'):
            answer = shared.call(kind, f'/dynamics_node/{name}', kind.Request(
                position=Q.tolist(), velocity=[1e300] * N))
            assert not answer.success
            assert 'the result is not finite' in answer.message
            assert all(len(array) == 0 for array in arrays(answer).values())
    answer = shared.call(GetDynamics, '/dynamics_node/get_dynamics')
    assert np.isnan(answer.kinetic_energy)
    assert np.isnan(answer.potential_energy)
    answer = shared.call(GetCoriolisMatrix, '/dynamics_node/get_coriolis_matrix',
                         GetCoriolisMatrix.Request(position=Q.tolist(), velocity=[np.inf] * N))
    assert 'velocity: expected finite values' in answer.message


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
        answer = client.call(GetMassMatrix, '/dynamics_node/get_mass_matrix',
                             GetMassMatrix.Request(position=[0.4, -0.6]), action)
        return np.reshape(answer.mass_matrix, (2, 2))

    def expected(q):
        q = q.copy()
        q[[1, 3]] = 0.4, -0.6
        return ARM.mass_matrix(q)[np.ix_([1, 3], [1, 3])]

    assert_rounded(ask(), expected(ARM.neutral_position))
    client.until(client.states.get_subscription_count)
    client.during(0.2, lambda: client.publish(others, Q[place]))
    assert_rounded(ask(), expected(Q))
