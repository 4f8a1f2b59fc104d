"""Workspace analysis: positions, torques, gravity loads, payload and conditioning."""

import math

from dynamics_node import RobotModel
from dynamics_node.report import make_report
from dynamics_node.report.gravity_load import per_kilogram
from dynamics_node.report.workspace_analysis import (
    sample_positions,
    sampling_ranges,
    WorkspaceAnalysis,
)
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.arms import arm, changed, G, pendulum
from support.robots import ARM7, public_robot, random_urdf


@pytest.fixture(scope='module')
def analysis():
    return WorkspaceAnalysis.from_description(read_urdf(arm()), (0.0, 0.0, -9.81), 300, 1)


def test_torques_are_those_of_the_library(analysis):
    expected = RobotModel.from_urdf(arm()).gravity_torque(analysis.positions)
    np.testing.assert_allclose(analysis.torques, expected, atol=1e-12)


def test_starts_are_the_samples_where_a_torque_is_largest_and_smallest(analysis):
    starts, sign = analysis.starts(1)
    torques = analysis.model.gravity_torque(starts)[:, 1]
    order = np.sort(analysis.torques[:, 1])
    np.testing.assert_allclose(np.sort(torques[sign < 0])[:8], order[:8])
    np.testing.assert_allclose(np.sort(torques[sign > 0])[-8:], order[-8:])
    # And others from all over, so that not all are below the same top.
    assert (sign < 0).sum() > 60 and (sign > 0).sum() > 60


def test_irrelevant_joints_are_at_their_neutral_position(analysis):
    # Joint 1 turns about the vertical and joint 5 about the arm itself.
    position, torque = analysis.worst[1]
    assert position[0] == position[4] == 0.0
    assert analysis.model.gravity_torque(position)[1] == pytest.approx(torque, rel=1e-11)
    assert analysis.worst[0][1] == 0.0 and not analysis.worst[0][0].any()


def test_another_inertial_is_that_of_another_urdf(analysis):
    inertial = read_urdf(changed(arm(), 'link3', mass=5.0)).links[3].inertial
    model = analysis.with_inertials({'link3': inertial})
    expected = RobotModel.from_urdf(changed(arm(), 'link3', mass=5.0))
    np.testing.assert_allclose(
        model.gravity_torque(analysis.positions),
        expected.gravity_torque(analysis.positions),
        atol=1e-12,
    )
    assert analysis.worst_with(model, 1)[1] != pytest.approx(analysis.worst[1][1], rel=1e-3)
    np.testing.assert_allclose(
        analysis.with_inertials({}).gravity_torque(analysis.positions),
        analysis.torques,
        atol=1e-12,
    )


def test_the_joints_that_carry_a_link(analysis):
    assert analysis.supporting_joints('gripper') == [4, 3, 2, 1, 0]
    assert analysis.supporting_joints('base') == []


def test_batches_cover_the_samples_once(analysis):
    for numbers in (1, 7_000, 10**9):
        rows = np.concatenate([np.arange(300)[part] for part in analysis.batches(numbers)])
        np.testing.assert_array_equal(rows, np.arange(300))
    assert [part.stop for part in analysis.batches(1, 40)] == [40]


def test_no_compiler_is_started(monkeypatch):
    from dynamics_node.codegen import worker

    def refuse(*_):
        raise AssertionError('a compiler was started')

    monkeypatch.setattr(worker, 'start', refuse)
    analysis = WorkspaceAnalysis.from_description(
        read_urdf(random_urdf(77, joints=5)), (0.0, 0.0, -9.81), 50_000, 1
    )
    for _ in range(5):
        analysis.model.gravity_torque(analysis.positions)
        analysis.model.with_payload(analysis.model.tip_link, 1.0).mass_matrix(analysis.positions)


def ranges(text):
    """Return ranges and notes of a robot."""
    return sampling_ranges(
        WorkspaceAnalysis.from_description(read_urdf(text), (0, 0, -9.81), 1, 1).model
    )


def test_limits_are_the_range():
    found, notes = ranges(arm(limits=(-1.5, 2.0)))
    np.testing.assert_array_equal(found, [[-1.5, 2.0]] * 5)
    assert notes == ('',) * 5


def test_joints_without_limits_turn_once_or_are_fixed():
    text = changed(arm(), 'joint1', kind='continuous')
    text = changed(text, 'joint5', kind='prismatic', limit={'lower': None, 'upper': None})
    text = changed(text, 'joint2', limit={'upper': '1e31'})
    found, notes = ranges(text)
    np.testing.assert_allclose(found[0], [-math.pi, math.pi])
    np.testing.assert_allclose(found[1], [-2.5, -2.5 + math.tau])
    np.testing.assert_array_equal(found[4], [0.0, 0.0])
    assert notes[0] and notes[1] and notes[4] and not notes[2]


def test_positions_are_uniform_within_the_range_and_reproducible():
    given = np.array([[-1.0, 3.0], [0.0, 0.0]])
    q = sample_positions(given, 20_000, 3)
    assert (q[:, 0] >= -1.0).all() and (q[:, 0] < 3.0).all() and not q[:, 1].any()
    counts = np.histogram(q[:, 0], 10)[0]
    assert abs(counts - 2000).max() < 250
    np.testing.assert_array_equal(q, sample_positions(given, 20_000, 3))
    assert (q[:, 0] != sample_positions(given, 20_000, 4)[:, 0]).all()


PANDA = 'panda_description/urdf/panda.urdf'
UR5 = 'ur_description/urdf/ur5_robot.urdf'
XARM7 = 'xarm_description/urdf/xarm7.urdf'


def load(text, joint=0, **options):
    """Return the gravity load of a joint."""
    return make_report(text, samples=3000, **options).joints[joint].gravity


def test_a_histogram_and_quantiles_of_a_pendulum():
    found = load(pendulum(2.0, 0.4))
    top = 2.0 * G * 0.4
    assert sum(found.counts) == 3000 and len(found.edges) == len(found.counts) + 1
    assert found.edges[0] == 0.0 and found.edges[-1] == pytest.approx(top)
    # |cos| of a uniform angle has its median at cos 45°.
    assert found.levels[3] == 0.5
    assert found.quantiles[3] == pytest.approx(top / math.sqrt(2.0), rel=0.03)
    assert found.quantiles[-1] == found.sampled <= found.magnitude


def test_the_curve_goes_through_the_worst_place():
    found = load(arm(), 1)
    assert found.curve_positions[0] == -2.5 and found.curve_positions[-1] == 2.5
    assert np.interp(found.position[1], found.curve_positions, found.curve_torques) == (
        pytest.approx(found.worst, rel=1e-3)
    )
    assert np.abs(found.curve_torques).max() <= found.magnitude * (1.0 + 1e-12)


def test_a_kilogram_is_what_a_payload_of_a_kilogram_adds():
    study = WorkspaceAnalysis.from_description(
        read_urdf(public_robot(PANDA)), (0.0, 0.0, -9.81), 200, 1
    )
    model, point = study.model, (0.02, -0.03, 0.1)
    loaded = model.with_payload('panda_hand', 1.0, point).gravity_torque(study.positions)
    np.testing.assert_allclose(
        per_kilogram(model, study.positions, 'panda_hand', point),
        loaded - study.torques,
        atol=1e-11,
    )


def test_what_is_left_brings_the_joint_to_its_limit():
    report = make_report(arm(effort=60), samples=500)
    [joint] = [joint for joint in report.joints if joint.name == 'joint2']
    model = report.model.with_payload(report.payload.link, joint.gravity.payload_left)
    torque = model.gravity_torque(np.array(joint.gravity.position))[1]
    assert abs(torque) == pytest.approx(60.0)
    assert joint.gravity.share == pytest.approx(joint.gravity.magnitude / 60.0)


def test_payload_left_is_zero_above_the_limit_and_nan_without_limit():
    assert load(arm(effort=20), 1).payload_left == 0.0
    found = load(arm(effort='inf'), 1)
    assert math.isnan(found.payload_left) and math.isnan(found.share)


def test_what_is_only_rounding_is_zero():
    # The last joint of this arm turns about the axis on which everything behind it lies.
    for text, joint in ((arm(), 4), (arm(), 0)):
        found = load(text, joint)
        assert (found.worst, found.share, found.sampled) == (0.0, 0.0, 0.0)
        assert set(found.curve_torques) == {0.0} and found.counts[0] == 3000
        assert found.payload_left == math.inf


def test_rounding_errors_do_not_lead_to_huge_payloads():
    for name in (
        'anymal_b_simple_description/robots/anymal-kinova.urdf',
        'tiago_description/robots/tiago.urdf',
    ):
        for joint in make_report(public_robot(name), samples=200).joints:
            if joint.gravity is not None:
                left = joint.gravity.payload_left
                assert not 1e6 < left < math.inf, joint.name


def payload(text, **options):
    """Return the payload of a robot."""
    return make_report(text, **options).payload


def test_a_pendulum_carries_what_its_limit_leaves():
    found = payload(pendulum(2.0, 0.4, effort=20.0), point=(0.5, 0.0, 0.0))
    assert found.everywhere == pytest.approx((20.0 - 2.0 * G * 0.4) / (G * 0.5), rel=1e-9)
    assert found.limiting_joint == 'swing'
    assert abs(math.cos(found.limiting_position[0])) == pytest.approx(1.0, abs=1e-6)
    # Hanging down it carries more than anything has.
    assert found.best > 100.0 * found.everywhere


@pytest.mark.parametrize(
    'robot, gravity',
    [(UR5, (0.0, 0.0, -9.81)), (XARM7, (0.0, 0.0, -9.81)), (XARM7, (9.81, 0.0, 0.0))],
)
def test_it_holds_at_a_hundred_thousand_positions_and_a_little_more_does_not(robot, gravity):
    report = make_report(public_robot(robot), gravity=gravity)
    found, model = report.payload, report.model
    rng = np.random.default_rng(99)
    lower, upper = model.position_limits.T
    q = lower + rng.random((100_000, len(lower))) * (upper - lower)
    loaded = model.with_payload(found.link, found.everywhere).gravity_torque(q)
    assert (np.abs(loaded) <= model.effort_limits * (1.0 + 1e-6)).all()
    # No sample allows less.
    assert found.everywhere <= model.max_payload(q, found.link).least()[0] * (1.0 + 1e-9)
    more = model.with_payload(found.link, 1.001 * found.everywhere)
    at = np.abs(more.gravity_torque(np.array(found.limiting_position)))
    joint = model.joint_names.index(found.limiting_joint)
    assert at[joint] > model.effort_limits[joint]


def test_the_payload_does_not_depend_on_the_seed():
    masses = [
        payload(public_robot(XARM7), seed=seed, samples=1000).everywhere for seed in range(5)
    ]
    assert max(masses) - min(masses) < 1e-5 * max(masses)


def test_an_arm_that_cannot_hold_itself_carries_nothing():
    found = payload(arm(effort=20))
    assert (found.everywhere, found.limiting_joint) == (0.0, 'joint2')


def test_without_limits_the_payload_is_infinite():
    found = payload(arm(effort='inf'))
    assert (found.everywhere, found.limiting_joint) == (math.inf, None)
    assert found.unlimited_joints == tuple(f'joint{i}' for i in range(1, 6))


def test_a_link_on_the_base_carries_any_payload():
    found = payload(arm(), link='base')
    assert (found.is_moved, found.everywhere) == (False, math.inf)


@pytest.mark.parametrize('seed', [1, 3, 5])
def test_what_is_held_everywhere_does_not_depend_on_the_seed(seed):
    report = make_report(public_robot(PANDA), seed=seed)
    # Of seeds 0 to 5 the least, which Pinocchio confirms at the limiting position.
    assert report.payload.everywhere == pytest.approx(3.26011, rel=1e-5)


def test_the_condition_numbers_are_those_of_numpy():
    report = make_report(public_robot(UR5), samples=400)
    found, model = report.conditioning, report.model
    assert np.linalg.cond(model.mass_matrix(np.array(found.position))) == (
        pytest.approx(found.worst, rel=1e-6)
    )
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (3000, 6))
    numbers = np.linalg.cond(model.mass_matrix(q))
    assert np.median(numbers) == pytest.approx(found.median, rel=0.1)
    assert numbers.max() == pytest.approx(found.worst, rel=0.1)
    assert found.is_positive_definite and not found.has_mixed_units
    assert (found.samples, found.weakest_joint) == (400, 'wrist_3_joint')


def test_joints_that_slide_and_turn_have_mixed_units():
    assert make_report(ARM7, samples=50).conditioning.has_mixed_units


def test_a_joint_that_moves_nothing_makes_the_condition_number_infinite():
    text = changed(changed(arm(), 'gripper', inertial=False), 'link5', inertial=False)
    found = make_report(text, samples=50).conditioning
    assert not found.is_positive_definite and found.worst == np.inf
    assert found.weakest_joint == 'joint5'
