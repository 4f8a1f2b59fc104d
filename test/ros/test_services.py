"""The services about one state, over DDS: given and measured states, joint order, refusals."""

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
NAMES = list(ARM.joint_names)
N = len(NAMES)
KINDS = [
    GetMassMatrix,
    GetCoriolisMatrix,
    GetGravityTorque,
    GetDynamics,
    InverseDynamics,
    ForwardDynamics,
    GetJacobian,
]
WITH_VELOCITY = [kind for kind in KINDS if hasattr(kind.Request(), 'velocity')]
Q = np.clip(np.linspace(0.8, -0.9, N), *ARM.position_limits.T)
QD = np.linspace(-1.0, 1.5, N)
AT_Q = {'position': Q.tolist()}
MOVING = {**AT_Q, 'velocity': QD.tolist()}


def assert_equal_but_rounding(actual, expected):
    # The node may already run machine code for its robot, this process may not: both round.
    np.testing.assert_allclose(
        np.reshape(actual, np.shape(expected)),
        expected,
        rtol=0,
        atol=1e-14 * np.abs(expected).max(),
    )


def assert_refused(answer, reason):
    assert not answer.success
    assert reason in answer.message
    assert len(answer.message) < 1000
    kinds = answer.get_fields_and_field_types()
    arrays = [name for name, kind in kinds.items() if kind.startswith('sequence')]
    assert arrays
    assert not any(len(getattr(answer, name)) for name in arrays)


@pytest.mark.parametrize('is_measured', [False, True], ids=['given', 'measured'])
def test_dynamics_at_a_state(shared, is_measured):
    D, C, G = ARM.dynamics(Q, QD)
    state, publish = AT_Q, None
    if is_measured:
        state = {}

        def publish():
            shared.publish(reversed(NAMES), reversed(Q))

        shared.until(shared.states.get_subscription_count)
        shared.during(0.2, publish)
    velocity = QD.tolist()
    answer = shared.ask(GetMassMatrix, publish, **state)
    assert answer.success, answer.message
    assert answer.joint_names == NAMES
    np.testing.assert_array_equal(answer.position, Q)
    assert_equal_but_rounding(answer.mass_matrix, D)

    answer = shared.ask(GetCoriolisMatrix, publish, **state, velocity=velocity)
    assert_equal_but_rounding(answer.coriolis_matrix, C)
    np.testing.assert_allclose(answer.coriolis_torque, C @ QD, rtol=1e-13, atol=1e-15)
    np.testing.assert_array_equal(answer.velocity, QD)

    assert_equal_but_rounding(shared.ask(GetGravityTorque, publish, **state).gravity_torque, G)

    answer = shared.ask(GetDynamics, publish, **state, velocity=velocity)
    assert_equal_but_rounding(answer.mass_matrix, D)
    assert_equal_but_rounding(answer.coriolis_matrix, C)
    assert_equal_but_rounding(answer.gravity_torque, G)
    assert answer.kinetic_energy == pytest.approx(0.5 * QD @ D @ QD, rel=1e-13)
    assert answer.potential_energy == pytest.approx(ARM.potential_energy(Q), rel=1e-13)


def test_a_permutation_of_the_joints_permutes_the_answer(shared):
    order = np.random.default_rng(4).permutation(N)
    names = [NAMES[i] for i in order]
    answer = shared.ask(
        GetDynamics, joint_names=names, position=Q[order].tolist(), velocity=QD[order].tolist()
    )
    D, C, G = ARM.dynamics(Q, QD)
    assert answer.joint_names == names
    np.testing.assert_array_equal(answer.position, Q[order])
    assert_equal_but_rounding(answer.mass_matrix, D[np.ix_(order, order)])
    assert_equal_but_rounding(answer.coriolis_matrix, C[np.ix_(order, order)])
    assert_equal_but_rounding(answer.gravity_torque, G[order])


@pytest.mark.parametrize(
    'fields, reason',
    [
        ({'position': [0.0]}, f'position: expected {N} values'),
        (
            {'position': [*[0.0] * (N - 1), np.nan]},
            f'position: expected finite values, got nan for {NAMES[-1]}',
        ),
        ({'joint_names': NAMES[:-1], 'position': [0.0] * N}, f"'{NAMES[-1]}' is missing"),
        (
            {'joint_names': [*NAMES[:-1], NAMES[-1][:-1]], 'position': [0.0] * N},
            f"not a joint that can be moved, is '{NAMES[-1]}' meant?",
        ),
        ({'joint_names': [NAMES[0]] * N, 'position': [0.0] * N}, 'is given twice'),
        ({'joint_names': ['a' * 900] * 2000}, "...' is given twice"),
    ],
    ids=['length', 'nan', 'missing joint', 'misspelled joint', 'joint twice', 'long names'],
)
def test_a_wrong_request_is_refused_with_the_reason_and_empty_arrays(shared, fields, reason):
    for kind in KINDS:
        assert_refused(shared.ask(kind, **fields), reason)


def test_without_a_fresh_joint_state_a_request_without_position_is_refused(shared):
    shared.during(1.1)  # until the states of other tests are too old
    for kind in KINDS:
        assert_refused(shared.ask(kind), f'no joint state within 1 s for {NAMES[0]}')
    answer = shared.ask(GetDynamics)
    assert np.isnan(answer.kinetic_energy)
    assert np.isnan(answer.potential_energy)


def test_a_result_beyond_double_precision_is_refused(shared):
    for kind in WITH_VELOCITY:
        answer = shared.ask(kind, **AT_Q, velocity=[1e300] * N)
        assert_refused(answer, 'the result is not finite')
    answer = shared.ask(GetCoriolisMatrix, **AT_Q, velocity=[np.inf] * N)
    assert 'velocity: expected finite values' in answer.message


def test_given_positions_beyond_their_limits_are_used_and_named(shared):
    position = Q.copy()
    position[-1] = 5.0
    lower, upper = ARM.position_limits[-1]
    answer = shared.ask(GetGravityTorque, position=position.tolist())
    assert answer.success
    assert answer.message.endswith(
        f'; beyond the position limits: {NAMES[-1]} at 5 (limits {lower:g} to {upper:g})'
    )
    assert_equal_but_rounding(answer.gravity_torque, ARM.gravity_torque(position))
    assert 'limits' not in shared.ask(GetGravityTorque, **AT_Q).message


def test_inverse_and_forward_dynamics_against_pinocchio(shared):
    oracle, order = PinocchioOracle(ARM7.read_text()), np.random.default_rng(7).permutation(N)
    names, qdd = [NAMES[i] for i in order], np.linspace(2.0, -3.0, N)
    tau = oracle.inverse_dynamics(ARM.joint_names, Q, QD, qdd)
    state = {'joint_names': names, 'position': Q[order].tolist(), 'velocity': QD[order].tolist()}
    answer = shared.ask(InverseDynamics, **state, acceleration=qdd[order].tolist())
    assert answer.success, answer.message
    assert answer.joint_names == names
    np.testing.assert_array_equal(answer.acceleration, qdd[order])
    np.testing.assert_allclose(answer.effort, tau[order], rtol=0, atol=1e-11 * np.abs(tau).max())
    answer = shared.ask(ForwardDynamics, **state, effort=tau[order].tolist())
    assert answer.success, answer.message
    np.testing.assert_array_equal(answer.effort, tau[order])
    np.testing.assert_allclose(answer.acceleration, qdd[order], rtol=0, atol=1e-9)
    answer = shared.ask(ForwardDynamics, **state, effort=[5.0])
    assert_refused(answer, f'effort: expected {N} values')


def test_missing_fields_are_zero_and_the_flags_switch_gravity_and_friction(shared):
    answer = shared.ask(GetCoriolisMatrix, **AT_Q)
    assert answer.success, answer.message
    assert not np.any(answer.coriolis_matrix)
    np.testing.assert_array_equal(answer.velocity, np.zeros(N))
    answer = shared.ask(InverseDynamics, **AT_Q)
    assert answer.success, answer.message
    assert_equal_but_rounding(answer.effort, ARM.gravity_torque(Q))
    assert answer.message == 'at the given position, velocity zero, acceleration zero'
    answer = shared.ask(InverseDynamics, **MOVING, without_gravity=True, with_friction=True)
    assert answer.success, answer.message
    assert ARM.friction_torque(QD).any()
    assert_equal_but_rounding(
        answer.effort, ARM.coriolis_matrix(Q, QD) @ QD + ARM.friction_torque(QD)
    )
    assert answer.message.endswith('without gravity, with friction')
    answer = shared.ask(ForwardDynamics, **MOVING, with_friction=True)
    expected = ARM.forward_dynamics(Q, QD, -ARM.friction_torque(QD))
    np.testing.assert_allclose(answer.acceleration, expected, rtol=1e-12)


def test_the_jacobian_of_a_point_of_a_link(shared):
    order = np.random.default_rng(8).permutation(N)
    answer = shared.ask(
        GetJacobian,
        joint_names=[NAMES[i] for i in order],
        position=Q[order].tolist(),
        link='tool_center',
        point=Point(x=0.1, y=0.2, z=0.3),
    )
    assert answer.success, answer.message
    assert (answer.link, answer.frame_id) == ('tool_center', 'base')
    expected = ARM.jacobian(Q, 'tool_center', (0.1, 0.2, 0.3))
    assert_equal_but_rounding(answer.jacobian, expected[:, order])
    pose = ARM.link_pose(Q, 'tool_center')
    position, turn = answer.pose.position, answer.pose.orientation
    assert [position.x, position.y, position.z] == pytest.approx(
        (pose @ [0.1, 0.2, 0.3, 1.0])[:3], abs=1e-14
    )
    rotation = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix()
    assert rotation == pytest.approx(pose[:3, :3], abs=1e-14)


def test_the_jacobian_of_the_tip_by_default_and_of_no_unknown_link(shared):
    answer = shared.ask(GetJacobian, **AT_Q)
    assert answer.link == ARM.tip_link == 'tool_center'
    assert 'link tool_center' in answer.message
    for fields, reason in (
        ({'link': 'nose'}, "link: 'nose' is not a link of the robot; expected one of base, "),
        ({'point': Point(y=np.nan)}, 'point: expected finite numbers, m, got [0.0, nan, 0.0]'),
    ):
        assert_refused(shared.ask(GetJacobian, **AT_Q, **fields), reason)


def test_joints_outside_the_choice_are_held_where_they_were_measured(client, start):
    index, others = np.array([3, 1, 5]), [0, 2, 4, 6, 7]
    chosen, position = [NAMES[i] for i in index], Q[index].tolist()
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]')

    def check(q):
        q = q.copy()
        q[index] = position
        answer = client.ask(ForwardDynamics, position=position)
        assert answer.joint_names == chosen
        D, G = ARM.mass_matrix(q)[np.ix_(index, index)], ARM.gravity_torque(q)[index]
        np.testing.assert_allclose(answer.acceleration, np.linalg.solve(D, -G), rtol=1e-12)
        acceleration = list(answer.acceleration)
        answer = client.ask(InverseDynamics, position=position, acceleration=acceleration)
        assert np.asarray(answer.effort) == pytest.approx(0.0, abs=1e-12)
        answer = client.ask(GetJacobian, position=position, link='hand')
        assert_equal_but_rounding(answer.jacobian, ARM.jacobian(q, 'hand')[:, index])

    check(ARM.neutral_position)
    client.until(client.states.get_subscription_count)
    client.during(0.2, lambda: client.publish([NAMES[i] for i in others], Q[others]))
    check(Q)
