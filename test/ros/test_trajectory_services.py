"""~/compute_trajectory_effort and ~/get_max_payload over DDS, against Pinocchio and MuJoCo."""

import types

from dynamics_interfaces.srv import ComputeTrajectoryEffort, GetMaxPayload
from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.services.trajectory_services import MOST_WHILE_DRIVING, TrajectoryServices
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from geometry_msgs.msg import Point
import numpy as np
import pytest
from support.mujoco_oracle import MujocoOracle
from support.pinocchio_oracle import PinocchioOracle
from support.random_payload import with_payload_link
from support.robots import ARM7
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

ARM = RobotModel.from_urdf(ARM7)
N = len(ARM.joint_names)
PHASE = np.arange(N) * 0.7


def motion(time):
    """Return positions, velocities and accelerations of a swing, shape (len(time), N) each."""
    angle = 2.0 * time[:, None] + PHASE
    return 0.3 * np.sin(angle), 0.6 * np.cos(angle), -1.2 * np.sin(angle)


def message(time, positions, velocities=None, accelerations=None, names=ARM.joint_names):
    """Return a JointTrajectory."""
    trajectory = JointTrajectory(joint_names=names)
    for i, t in enumerate(time):
        point = JointTrajectoryPoint(positions=positions[i].tolist())
        if velocities is not None:
            point.velocities = velocities[i].tolist()
        if accelerations is not None:
            point.accelerations = accelerations[i].tolist()
        point.time_from_start.sec, rest = divmod(round(t * 1e9), 1_000_000_000)
        point.time_from_start.nanosec = rest
        trajectory.points.append(point)
    return trajectory


def ask(client, trajectory, **flags):
    """Call ~/compute_trajectory_effort."""
    return client.ask(ComputeTrajectoryEffort, trajectory=trajectory, **flags)


def efforts(answer):
    """Return the efforts of an answer, shape (points, joints)."""
    assert answer.success, answer.message
    return np.array([point.effort for point in answer.trajectory.points])


def test_every_point_gets_its_effort_and_is_otherwise_unchanged(shared):
    time = np.linspace(0.0, 2.0, 21)
    states = motion(time)
    order = np.random.default_rng(1).permutation(N)
    names = [ARM.joint_names[i] for i in order]
    sent = message(time, *(values[:, order] for values in states), names)
    answer = ask(shared, sent)
    oracle = MujocoOracle(ARM7.read_text())
    expected = np.array(
        [oracle.inverse_dynamics(ARM.joint_names, *state) for state in zip(*states, strict=True)]
    )[:, order]
    largest = np.abs(expected).max()
    np.testing.assert_allclose(efforts(answer), expected, rtol=0, atol=1e-11 * largest)
    assert answer.message.split(';')[0] == 'all velocities and accelerations were given'
    assert answer.trajectory.joint_names == names
    for before, after in zip(sent.points, answer.trajectory.points, strict=True):
        after.effort = before.effort
        assert after == before
    assert answer.within_limits
    np.testing.assert_allclose(answer.peak_effort, np.abs(expected).max(axis=0), rtol=1e-10)
    np.testing.assert_array_equal(answer.effort_limits, ARM.effort_limits[order])


def test_missing_derivatives_are_those_of_a_spline_and_the_answer_says_so(shared):
    time = np.linspace(0.0, 2.0, 201)
    q, qd, qdd = motion(time)
    exact = efforts(ask(shared, message(time, q, qd, qdd)))
    largest = np.abs(exact).max()
    without = ask(shared, message(time, q))
    for text in ('velocities were not given', 'accelerations were not given', 'spline'):
        assert text in without.message
    assert efforts(without) == pytest.approx(exact, abs=0.02 * largest)
    half = ask(shared, message(time, q, qd))
    assert 'velocities were' not in half.message
    assert efforts(half) == pytest.approx(exact, abs=1e-4 * largest)


def test_the_request_switches_gravity_and_friction(shared):
    time = np.linspace(0.0, 1.0, 5)
    q, qd, qdd = motion(time)
    trajectory = message(time, q, qd, qdd)
    plain = efforts(ask(shared, trajectory))
    without = efforts(ask(shared, trajectory, without_gravity=True))
    assert plain - without == pytest.approx(ARM.gravity_torque(q), abs=1e-11)
    answer = ask(shared, trajectory, with_friction=True)
    assert answer.message.split(';')[0] == 'with friction'
    assert efforts(answer) - plain == pytest.approx(ARM.friction_torque(qd), abs=1e-11)


def test_points_and_joints_above_their_limit_are_named(shared):
    time = np.linspace(0.0, 1.0, 4)
    q, qd, qdd = np.zeros((3, 4, N))
    qdd[2, 1] = 500.0
    answer = ask(shared, message(time, q, qd, qdd))
    tau = ARM.inverse_dynamics(q, qd, qdd)
    over = np.abs(tau) > ARM.effort_limits
    assert over.any()
    assert not answer.within_limits
    assert list(answer.points_over_limit) == [2]
    assert answer.joints_over_limit == [ARM.joint_names[i] for i in np.flatnonzero(over[2])]
    assert '1 point above the effort limit of shoulder_pitch' in answer.message
    np.testing.assert_allclose(answer.peak_effort, np.abs(tau).max(axis=0), rtol=1e-12)


def test_limits_of_joints_outside_the_trajectory_count(shared):
    names = ('elbow_pitch', 'shoulder_yaw')
    moved = [ARM.joint_names.index(name) for name in names]
    q, qd, qdd = np.zeros((3, 2, 2))
    qdd[1, 0] = 100.0
    sent = message([0.0, 1.0], q, qd, qdd, names)
    answer = ask(shared, sent)
    whole = np.zeros((3, 2, N))
    whole[0] = ARM.neutral_position
    for values, given in zip(whole, (q, qd, qdd), strict=True):
        values[:, moved] = given
    tau, limits = np.abs(ARM.inverse_dynamics(*whole)), ARM.effort_limits
    pitch = ARM.joint_names.index('shoulder_pitch')
    # The moved joints are within their limits; the joint that carries them is not.
    assert (tau[:, moved] <= limits[moved]).all() and tau[1, pitch] > limits[pitch]
    assert efforts(answer).shape == (2, 2)
    assert not answer.within_limits
    assert list(answer.points_over_limit) == [1]
    assert answer.joints_over_limit == ['shoulder_pitch']
    assert len(answer.peak_effort) == len(answer.effort_limits) == 2
    assert (
        '1 point above the effort limit of shoulder_pitch (not in the trajectory: up to '
        f'{tau[1, pitch]:.6g} of {limits[pitch]:.6g})'
    ) in answer.message
    answer = shared.ask(GetMaxPayload, trajectory=sent, link='hand')
    assert (answer.mass, answer.limiting_joint) == (0.0, 'shoulder_pitch')
    assert (
        'shoulder_pitch is not in joint_names: it needs '
        f'{ARM.inverse_dynamics(*whole)[1, pitch]:.6g} of {limits[pitch]:.6g}'
    ) in answer.message


def test_positions_of_a_trajectory_beyond_their_limits_are_named(shared):
    q = np.zeros((3, N))
    q[:, -1] = 0.01, 5.0, 2.0
    lower, upper = ARM.position_limits[-1]
    answer = ask(shared, message([0.0, 1.0, 2.0], q, 0 * q, 0 * q))
    assert answer.success
    assert (
        f'; beyond the position limits: {ARM.joint_names[-1]} at 5 (limits {lower:g} to {upper:g})'
    ) in answer.message


def test_joints_outside_the_trajectory_stand_still(client, start):
    start(robot_description_file=ARM7, joints=f'[{", ".join(ARM.joint_names[:4])}]')
    time = np.linspace(0.0, 1.0, 3)
    q, qd, qdd = (values[:, [2, 1]] for values in motion(time))
    names = [ARM.joint_names[2], ARM.joint_names[1]]
    answer = ask(client, message(time, q, qd, qdd, names))
    whole = np.repeat(ARM.neutral_position[None], 3, axis=0)
    rates, changes = np.zeros((2, 3, N))
    whole[:, [2, 1]], rates[:, [2, 1]], changes[:, [2, 1]] = q, qd, qdd
    expected = ARM.inverse_dynamics(whole, rates, changes)[:, [2, 1]]
    np.testing.assert_allclose(efforts(answer), expected, rtol=0, atol=1e-12)
    assert (
        '; taken where last measured, or neutral if never: '
        + ', '.join(ARM.joint_names[i] for i in (0, 3, 4, 5, 6, 7))
    ) in answer.message
    # Without names: the chosen joints.
    q4, qd4, qdd4 = (values[:, :4] for values in motion(time))
    answer = ask(client, message(time, q4, qd4, qdd4, names=[]))
    assert answer.trajectory.joint_names == list(ARM.joint_names[:4])


TIME = np.array([0.0, 1.0, 2.0])
POSITIONS, VELOCITIES, ACCELERATIONS = motion(TIME)
FULL = (POSITIONS, VELOCITIES, ACCELERATIONS)


POINT = 'trajectory.points[{}].{}: expected '
FINITE = 'finite numbers, or none; got'
WITH_NAN = [0.0, 0.0, np.nan, *[0.0] * (N - 3)]


def changed(point, field, values, trajectory=None):
    """Return a trajectory with another field of one point."""
    trajectory = trajectory or message(TIME, *FULL)
    setattr(trajectory.points[point], field, values)
    return trajectory


@pytest.mark.parametrize(
    'trajectory, reason',
    [
        (JointTrajectory(), 'expected at least one point, got none'),
        (message([0.0, 1.0, 1.0], POSITIONS), 'time: point 2: expected more than 1.0 s'),
        (changed(1, 'velocities', [1.0]), POINT.format(1, 'velocities') + '8 numbers for'),
        (changed(2, 'positions', []), POINT.format(2, 'positions') + '8 numbers'),
        (
            changed(1, 'positions', WITH_NAN),
            POINT.format(1, 'positions') + f'{FINITE} nan for {ARM.joint_names[2]}',
        ),
        (
            # The first point has none: the place of the second is still named.
            changed(1, 'velocities', WITH_NAN, changed(0, 'velocities', [])),
            POINT.format(1, 'velocities') + FINITE,
        ),
        (changed(1, 'accelerations', WITH_NAN), POINT.format(1, 'accelerations') + FINITE),
        (
            message(TIME, POSITIONS, names=[*ARM.joint_names[:-1], 'elbow_pich']),
            "'elbow_pich' is not a joint that can be moved, is 'elbow_pitch' meant?",
        ),
        (message(TIME, POSITIONS[:, :1], names=['\x1b[2J']), r"'\x1b[2J' is not a joint"),
        (message(TIME, POSITIONS[:, :1], names=['nose']), "'nose' is not a joint"),
        (message(TIME, POSITIONS, 1e300 + VELOCITIES, ACCELERATIONS), 'the result is not finite'),
    ],
    ids=lambda item: item if isinstance(item, str) else '',
)
def test_a_wrong_trajectory_is_refused_with_the_reason(shared, trajectory, reason):
    answer = ask(shared, trajectory)
    assert not answer.success
    assert reason in answer.message
    assert answer.trajectory == JointTrajectory()
    assert not len(answer.peak_effort)


def test_a_long_trajectory_is_refused_while_the_output_is_on():
    node = types.SimpleNamespace(get_logger=lambda: None, create_service=lambda *_, **__: None)
    path = types.SimpleNamespace(is_on=True)
    context = NodeContext(node, check_all({}), ActiveRobot(ARM, ()))
    services = TrajectoryServices(context, path)
    time = np.arange(MOST_WHILE_DRIVING + 1.0)
    trajectory = message(time, *motion(time))

    def answer():
        return services.compute_trajectory_effort(
            ComputeTrajectoryEffort.Request(trajectory=trajectory),
            ComputeTrajectoryEffort.Response(),
        )

    refused = answer()
    assert not refused.success
    assert 'expected at most 1000 points while the output is on' in refused.message
    path.is_on = False
    assert answer().success
    path.is_on = True
    trajectory.points.pop()
    assert answer().success


# The largest payload -----------------------------------------------------------------------


def test_the_largest_payload_brings_a_joint_to_its_limit_by_pinocchio(shared):
    q, point = np.linspace(0.8, -0.6, N), (0.02, 0.01, 0.1)
    answer = shared.ask(
        GetMaxPayload, position=q.tolist(), link='hand', point=Point(x=0.02, y=0.01, z=0.1)
    )
    assert answer.success, answer.message
    assert answer.limiting_joint in answer.message
    joint = ARM.joint_names.index(answer.limiting_joint)
    text = with_payload_link(ARM7.read_text(), 'hand', answer.mass, point, np.zeros((3, 3)))
    tau = PinocchioOracle(text).dynamics(ARM.joint_names, q, 0 * q)[2]
    limits = ARM.effort_limits
    assert abs(tau[joint]) == pytest.approx(limits[joint], rel=1e-10)
    assert (np.abs(tau) <= limits * (1.0 + 1e-10)).all()
    np.testing.assert_allclose(answer.effort, tau, rtol=0, atol=1e-10 * np.abs(tau).max())
    np.testing.assert_array_equal(answer.effort_limits, limits)
    assert answer.limiting_point == -1


def test_the_largest_payload_over_a_trajectory_is_the_least_of_all_points(shared):
    time = np.linspace(0.0, 2.0, 21)
    states = motion(time)
    answer = shared.ask(GetMaxPayload, trajectory=message(time, *states), link='hand')
    assert answer.success, answer.message
    most = ARM.max_payload(states[0], 'hand', qd=states[1], qdd=states[2])
    mass, joint, (place,) = most.least()
    assert answer.mass == pytest.approx(mass, rel=1e-12)
    assert (answer.limiting_joint, answer.limiting_point) == (ARM.joint_names[joint], place)
    np.testing.assert_allclose(answer.position, states[0][place])
    assert 'over the trajectory' in answer.message


def test_the_largest_payload_depends_on_the_parameters_and_may_be_infinite(shared, change):
    low = ARM.effort_limits / 1.5
    change('effort_limits', low.tolist())
    q = np.linspace(0.8, -0.6, N)

    def ask(link='hand', **fields):
        return shared.ask(GetMaxPayload, position=q.tolist(), link=link, **fields)

    def largest(limits):
        return float(ARM.max_payload(q, 'hand', effort_limits=limits).mass)

    assert ask().mass == pytest.approx(largest(low), rel=1e-12)
    assert 0.0 < ask().mass < 0.8 * largest(ARM.effort_limits)
    # The limits apply after the gains.
    change('effort_scale', [1.25] * N)
    answer = ask()
    assert answer.mass == pytest.approx(largest(low / 1.25), rel=1e-12)
    np.testing.assert_allclose(answer.effort_limits, low / 1.25)
    assert answer.limiting_joint == ARM.joint_names[1]
    # And after the offsets, of which only the size counts.
    offsets = 0.1 * low * np.resize([1.0, -1.0], N)
    change('effort_offset', offsets.tolist())
    answer = ask()
    np.testing.assert_allclose(answer.effort_limits, 0.9 * low / 1.25, rtol=1e-14)
    assert answer.mass == pytest.approx(largest(0.9 * low / 1.25), rel=1e-12)
    change('effort_offset', (100.0 * low).tolist())
    assert ask().mass == 0.0
    change('effort_offset', [])
    # A joint without effort has no limit.
    change('effort_scale', [1.25, 0.0, *[1.25] * (N - 2)])
    answer = ask()
    assert answer.success and answer.limiting_joint != ARM.joint_names[1]
    assert np.isnan(answer.effort_limits[1])
    assert answer.mass > largest(low / 1.25)
    answer = ask('base')
    assert (answer.mass, answer.limiting_joint) == (np.inf, '')
    assert answer.message.startswith('no effort limit is in the way')
    answer = ask('nose')
    assert not answer.success
    assert np.isnan(answer.mass)
    assert len(answer.effort) == len(answer.joint_names) == 0
    # So far away that the torque of one kilogram exceeds double precision.
    answer = ask(point=Point(x=1e160))
    assert not answer.success
    assert 'the result is not finite' in answer.message
    assert np.isnan(answer.mass)
