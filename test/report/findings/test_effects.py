"""The shared parts of the checks: context, effects and grouping."""

from dynamics_node.report import make_report
from dynamics_node.report.findings.context import FindingContext
from dynamics_node.report.findings.effects import (
    added_torque,
    changed,
    Effect,
    inertia_effect,
    payload_effect,
    torque_effect,
)
from dynamics_node.report.findings.grouping import group_findings, Occurrence
from dynamics_node.report.workspace_analysis import WorkspaceAnalysis
from dynamics_node.urdf import examine_urdf
import numpy as np
import pytest
from support import arms
from support.arms import arm


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


def test_masses_and_lengths_of_an_arm():
    case = FindingContext(make_report(arm(), samples=10), examine_urdf(arm()), None)
    assert case.moving_mass == pytest.approx(3.0 + 2.5 + 2.0 + 1.2 + 0.8 + 0.7)
    assert case.body_mass['joint5'] == pytest.approx(1.5)
    assert case.mass_behind['joint3'] == pytest.approx(1.2 + 0.8 + 0.7)
    assert case.body_parent['joint1'] is None and case.body_children['joint2'] == ['joint3']
    assert case.reach == pytest.approx(0.1 + 0.3 + 0.3 + 0.25 + 0.2 + 0.15)
    assert case.size('link3') == pytest.approx(0.3) and case.has_shapes
    assert [entry.name for entry in case.moved][:2] == ['link1', 'link2']


def test_a_cycle_ends():
    text = (
        '<robot name="r"><link name="a"/><link name="b"/>'
        + ''.join(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<limit lower="0" upper="1"/></joint>'
            for name, kind, parent, child in (
                ('j', 'revolute', 'a', 'b'),
                ('k', 'fixed', 'b', 'a'),
            )
        )
        + '</robot>'
    )
    report = make_report(text, samples=10)
    assert report.verdict == 'refused'
    case = FindingContext(report, examine_urdf(text), None)
    assert case.reach == 0.0 and set(case.mass_behind) == {'j'}


def hit(subject, weight=0.0, advice='mend it', severity='warning'):
    """Return a hit."""
    return Occurrence(
        severity,
        'grams',
        subject,
        f'{subject} is light',
        '7 g',
        lambda: Effect(f'{subject} sinks', 1.0),
        advice,
        weight,
    )


def test_one_is_told_as_it_is():
    [found] = group_findings([hit('a')], str)
    assert (found.what, found.effect, found.subjects) == ('a is light', 'a sinks', ('a',))


def test_many_are_told_with_the_weightiest_first():
    hits = [hit(name, weight) for weight, name in enumerate('abcdef')]
    [found] = group_findings(hits, lambda count: f'{count} are light')
    assert found.what == ("6 are light: 'f' (7 g), 'e' (7 g), 'd' (7 g), 'c' (7 g) and 2 more")
    assert found.effect == "'f': f sinks" and found.subjects == tuple('fedcba')
    assert found.advice == 'mend it'


def test_advice_that_differs_says_for_whom():
    [found] = group_findings([hit('a', 1.0, 'glue it'), hit('b')], str)
    assert found.advice == "'a': glue it"


def test_severities_are_apart():
    assert len(group_findings([hit('a'), hit('b', severity='note')], str)) == 2
