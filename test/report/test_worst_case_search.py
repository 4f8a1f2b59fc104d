"""The largest gravity torque: closed forms, and Pinocchio with an optimizer of its own."""

import math

from dynamics_node.report import make_report
from dynamics_node.report.workspace_analysis import WorkspaceAnalysis
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from scipy import optimize
from support.arms import arm, G, pendulum
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, public_robot, random_urdf

DOWN = (0.0, 0.0, -9.81)
UR5 = 'ur_description/urdf/ur5_robot.urdf'
PANDA = 'panda_description/urdf/panda.urdf'
XARM7 = 'xarm_description/urdf/xarm7.urdf'
KINOVA = 'kinova_description/robots/kinova.urdf'


def analyze(text, samples=500, seed=1, gravity=DOWN):
    return WorkspaceAnalysis.from_description(read_urdf(text), gravity, samples, seed)


def test_a_pendulum_is_worst_where_it_is_horizontal():
    position, torque = analyze(pendulum(2.0, 0.4)).worst[0]
    assert abs(torque) == pytest.approx(2.0 * G * 0.4, rel=1e-12)
    assert abs(math.cos(position[0])) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize('lower, upper', [(0.3, 1.2), (1.0, 2.9), (-9.0, -7.0), (2.0, 2.4)])
def test_a_pendulum_with_limits_is_worst_within_them(lower, upper):
    position, torque = analyze(pendulum(2.0, 0.4, lower, upper)).worst[0]
    grid = np.cos(np.linspace(lower, upper, 200_001))
    assert abs(torque) == pytest.approx(2.0 * G * 0.4 * np.abs(grid).max(), rel=1e-9)
    assert lower <= position[0] <= upper


def test_a_horizontal_arm_is_the_sum_of_its_weights_times_their_levers():
    masses, lengths = (3.0, 2.0, 1.0), (0.5, 0.4, 0.3)
    text = arm(masses, lengths, tool=False, axes=('0 1 0',) * 3, limits=(-3, 3))
    found = analyze(text)
    for joint in range(3):
        lever, expected = 0.0, 0.0
        for mass, length in zip(masses[joint:], lengths[joint:], strict=True):
            expected += mass * G * (lever + length / 2.0)
            lever += length
        assert abs(found.worst[joint][1]) == pytest.approx(expected, rel=1e-9)


def test_a_vertical_axis_holds_nothing():
    assert analyze(arm()).worst[0][1] == 0.0
    upright = analyze(arm(), gravity=(0.0, 9.81, 0.0)).worst[0][1]
    assert abs(upright) > 10.0


def test_a_slide_lifts_what_it_carries():
    text = pendulum(2.0).replace('revolute', 'prismatic').replace('0 -1 0', '0 0 1')
    assert analyze(text).worst[0][1] == pytest.approx(2.0 * G, rel=1e-12)


def gravity(oracle, names, q):
    """Return G by Pinocchio: the efforts that hold still."""
    rest = np.zeros(len(names))
    return oracle.inverse_dynamics(names, q, rest, rest)


def brute_force(path, seed):
    """Return each joint's largest torque by Pinocchio: 4000 positions, the best 6 optimized."""
    oracle = PinocchioOracle(path.read_text())
    found = analyze(path)
    names, (lower, upper) = list(found.model.joint_names), found.ranges.T
    rng = np.random.default_rng(seed)
    q = lower + rng.random((4000, len(names))) * (upper - lower)
    G_at = np.array([gravity(oracle, names, row) for row in q])
    largest = []
    for joint in range(len(names)):
        best = 0.0
        for start in q[np.argsort(-np.abs(G_at[:, joint]))[:6]]:
            sign = math.copysign(1.0, gravity(oracle, names, start)[joint])

            def loss(x, sign=sign, joint=joint):
                return -sign * gravity(oracle, names, x)[joint]

            answer = optimize.minimize(
                loss,
                start,
                method='L-BFGS-B',
                bounds=list(zip(lower, upper, strict=True)),
                options={'ftol': 1e-14, 'gtol': 1e-9},
            )
            best = max(best, -answer.fun)
        largest.append(best)
    return names, np.array(largest)


@pytest.mark.parametrize('robot', [UR5, PANDA, XARM7, 'arm7'])
def test_nothing_larger_is_found_by_pinocchio_and_an_optimizer(robot):
    path = ARM7 if robot == 'arm7' else public_robot(robot)
    _, largest = brute_force(path, seed=5)
    ours = np.array([abs(torque) for _, torque in analyze(path, samples=4096).worst])
    # The optimizer stops a little before the top; neither may be above the other by more.
    np.testing.assert_allclose(ours, largest, rtol=1e-5, atol=1e-6)
    assert (ours >= largest * (1.0 - 1e-9) - 1e-9).all()


@pytest.mark.parametrize('robot', [UR5, PANDA, XARM7, KINOVA])
def test_the_worst_torques_are_those_of_pinocchio(robot):
    path = public_robot(robot)
    oracle, found = PinocchioOracle(path.read_text()), analyze(path)
    for joint, (position, torque) in enumerate(found.worst):
        assert (position >= found.ranges[:, 0]).all() and (position <= found.ranges[:, 1]).all()
        expected = gravity(oracle, list(found.model.joint_names), position)[joint]
        assert torque == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize('robot', [UR5, PANDA, XARM7])
def test_it_hardly_depends_on_the_seed(robot):
    largest = np.array(
        [
            [abs(torque) for _, torque in analyze(public_robot(robot), 4096, seed).worst]
            for seed in range(6)
        ]
    )
    spread = np.ptp(largest, axis=0)
    sampled = np.array(
        [np.abs(analyze(public_robot(robot), 4096, seed).torques).max(axis=0) for seed in range(6)]
    )
    # The samples alone spread by up to some percent.
    assert (spread <= 1e-6 * largest.max(axis=0)).all()
    assert (sampled <= largest.min(axis=0) + 1e-9).all()
    assert np.ptp(sampled, axis=0).max() > 1e-3


@pytest.mark.parametrize('robot', [27, 36])
def test_the_highest_of_several_maxima_is_found_from_every_seed(robot):
    # From the best samples alone some seeds ended 0.6 % below the top here.
    text = random_urdf(robot, joints=8)
    largest = np.array(
        [[abs(torque) for _, torque in analyze(text, 2000, seed).worst] for seed in range(3)]
    )
    np.testing.assert_allclose(
        largest, np.broadcast_to(largest.max(axis=0), largest.shape), rtol=1e-6, atol=1e-9
    )


def test_joints_that_mimic_are_followed():
    # Two equal links in a plane; the second turns twice as far as the first.
    text = arm((2.0, 1.5), (0.4, 0.3), tool=False, axes=('0 -1 0',) * 2, limits=(-3, 3))
    text = text.replace(
        'name="joint2" type="revolute">',
        'name="joint2" type="revolute"><mimic joint="joint1" multiplier="2"/>',
    )
    q = np.linspace(-3.0, 3.0, 600_001)
    # V = g (m1 l1/2 sin q + m2 (l1 sin q + l2/2 sin 3 q)), G = dV/dq.
    torque = G * ((2.0 * 0.2 + 1.5 * 0.4) * np.cos(q) + 1.5 * 0.15 * 3.0 * np.cos(3.0 * q))
    found = analyze(text)
    assert abs(found.worst[0][1]) == pytest.approx(np.abs(torque).max(), rel=1e-6)


def test_the_report_contains_the_worst_torque():
    [swing] = make_report(pendulum(2.0, 0.4, effort=10.0)).joints
    assert swing.gravity.magnitude == pytest.approx(7.848)
    assert swing.gravity.share == pytest.approx(0.7848)
    # 10 N m - 7.848 N m, at a lever of 0 m: 'rod' has its frame on the joint.
    assert swing.gravity.payload_left == math.inf
    [swing] = make_report(pendulum(2.0, 0.4, effort=10.0), point=(0.5, 0.0, 0.0)).joints
    assert swing.gravity.payload_left == pytest.approx((10.0 - 7.848) / (G * 0.5))
