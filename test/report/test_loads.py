"""What gravity asks of each joint."""

import math

from dynamics_node.report import make_report
from dynamics_node.report.gravity_load import per_kilogram
from dynamics_node.report.workspace_analysis import WorkspaceAnalysis
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.arms import arm, G, pendulum
from support.robots import public_robot

PANDA = 'panda_description/urdf/panda.urdf'


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


def test_over_the_limit_nothing_is_left_and_without_limit_nobody_knows():
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


def test_a_mass_that_does_not_turn_a_joint_leaves_no_trillion_of_kilograms():
    for name in (
        'anymal_b_simple_description/robots/anymal-kinova.urdf',
        'tiago_description/robots/tiago.urdf',
    ):
        for joint in make_report(public_robot(name), samples=200).joints:
            if joint.gravity is not None:
                left = joint.gravity.payload_left
                assert not 1e6 < left < math.inf, joint.name
