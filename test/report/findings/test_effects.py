"""What another inertia would do, against models of the other URDF."""

from dynamics_node.report.build import make_report
from dynamics_node.report.findings.context import FindingContext
from dynamics_node.report.findings.effects import (
    added_torque,
    changed,
    inertia_effect,
    payload_effect,
    torque_effect,
)
from dynamics_node.report.workspace_analysis import WorkspaceAnalysis
from dynamics_node.urdf import examine_urdf
import numpy as np
import pytest
from support import arms


@pytest.fixture(scope='module')
def case():
    found = examine_urdf(arms.arm())
    study = WorkspaceAnalysis.from_description(found.description, (0.0, 0.0, -9.81), 500, 1)
    return FindingContext(make_report(arms.arm(), samples=500), found, study)


def worst(text, joint):
    """Return the largest gravity torque of a joint of another robot."""
    entries = {entry.name: entry for entry in make_report(text, samples=500).joints}
    return entries[joint].gravity.magnitude


def test_torques_of_another_mass(case):
    inertial = changed(case.links['link3'].inertial, mass=6.0)
    effect = torque_effect(case, {'link3': inertial}, 'if it weighed 6 kg')
    before = worst(arms.arm(), 'joint2')
    after = worst(arms.changed(arms.arm(), 'link3', mass=6.0), 'joint2')
    assert effect.text == (
        f"the largest gravity torque of joint 'joint2' would be {after:.3g} N m instead of "
        f'{before:.3g} N m (+{100.0 * (after / before - 1.0):.3g} %) if it weighed 6 kg'
    )
    assert effect.share == pytest.approx(after / before - 1.0, rel=1e-6)


def test_torques_that_do_not_change(case):
    text = torque_effect(case, {'link3': case.links['link3'].inertial}, 'as it is').text
    assert text.startswith('next to nothing')
    assert torque_effect(case, {'base': None}, 'without').text == 'none: no joint moves it'


def test_a_payload(case):
    effect = payload_effect(case, 'gripper', 1.0, 'with 1 kg')
    before = worst(arms.arm(), 'joint2')
    assert f'would be {before + arms.G * 0.9:.3g} N m instead of {before:.3g}' in effect.text
    joint, torque = added_torque(case, 'gripper', 1.0)
    assert (joint, torque) == ('joint2', pytest.approx(arms.G * 0.9))


def test_inertia_of_another_tensor(case):
    inertial = case.links['link5'].inertial
    effect = inertia_effect(
        case, 'link5', changed(inertial, tensor=0.5 * inertial.tensor), 'with half of it'
    )
    model = case.analysis.model
    half = arms.scaled_tensor(arms.arm(), 'link5', 0.5)
    other = WorkspaceAnalysis.from_description(
        examine_urdf(half).description, (0.0, 0.0, -9.81), 1, 1
    ).model
    q = case.analysis.positions[:256]
    share = (
        np.diagonal(model.mass_matrix(q), axis1=1, axis2=2)
        / np.diagonal(other.mass_matrix(q), axis1=1, axis2=2)
        - 1.0
    ).max()
    assert effect.share == pytest.approx(share)
    assert f'up to {100.0 * share:.3g} % more inertia (D_jj) than with half of it' in effect.text


def test_without_a_tree_nothing_is_said(case):
    nobody = FindingContext(case.report, case.examination, None)
    assert torque_effect(nobody, {'link3': None}, '').text == ''
    assert payload_effect(nobody, 'link3', 1.0, '').text == ''
