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
def context():
    found = examine_urdf(arms.arm())
    study = WorkspaceAnalysis.from_description(found.description, (0.0, 0.0, -9.81), 500, 1)
    return FindingContext(make_report(arms.arm(), samples=500), found, study)


def worst(text, joint):
    """Return the largest gravity torque of a joint of another robot."""
    entries = {entry.name: entry for entry in make_report(text, samples=500).joints}
    return entries[joint].gravity.magnitude


def test_torques_of_another_mass(context):
    inertial = changed(context.links['link3'].inertial, mass=6.0)
    effect = torque_effect(context, {'link3': inertial}, 'if it weighed 6 kg')
    before = worst(arms.arm(), 'joint2')
    after = worst(arms.changed(arms.arm(), 'link3', mass=6.0), 'joint2')
    assert effect.text == (
        f"the largest gravity torque of joint 'joint2' would be {after:.3g} N m instead of "
        f'{before:.3g} N m (+{100.0 * (after / before - 1.0):.3g} %) if it weighed 6 kg'
    )
    assert effect.share == pytest.approx(after / before - 1.0, rel=1e-6)


def test_torques_that_do_not_change(context):
    text = torque_effect(context, {'link3': context.links['link3'].inertial}, 'as it is').text
    assert text.startswith('next to nothing')
    assert torque_effect(context, {'base': None}, 'without').text == 'none: no joint moves it'


def test_a_payload(context):
    effect = payload_effect(context, 'gripper', 1.0, 'with 1 kg')
    before = worst(arms.arm(), 'joint2')
    assert f'would be {before + arms.G * 0.9:.3g} N m instead of {before:.3g}' in effect.text
    joint, torque = added_torque(context, 'gripper', 1.0)
    assert (joint, torque) == ('joint2', pytest.approx(arms.G * 0.9))


def test_inertia_of_another_tensor(context):
    inertial = context.links['link5'].inertial
    effect = inertia_effect(
        context, 'link5', changed(inertial, tensor=0.5 * inertial.tensor), 'with half of it'
    )
    model = context.analysis.model
    half = arms.scaled_tensor(arms.arm(), 'link5', 0.5)
    other = WorkspaceAnalysis.from_description(
        examine_urdf(half).description, (0.0, 0.0, -9.81), 1, 1
    ).model
    q = context.analysis.positions[:256]
    share = (
        np.diagonal(model.mass_matrix(q), axis1=1, axis2=2)
        / np.diagonal(other.mass_matrix(q), axis1=1, axis2=2)
        - 1.0
    ).max()
    assert effect.share == pytest.approx(share)
    assert f'up to {100.0 * share:.3g} % more inertia (D_jj) than with half of it' in effect.text


def test_without_a_tree_the_effect_is_unknown(context):
    without = FindingContext(context.report, context.examination, None)
    assert torque_effect(without, {'link3': None}, '').text == ''
    assert payload_effect(without, 'link3', 1.0, '').text == ''


def test_masses_and_lengths_of_an_arm():
    context = FindingContext(make_report(arm(), samples=10), examine_urdf(arm()), None)
    assert context.moving_mass == pytest.approx(3.0 + 2.5 + 2.0 + 1.2 + 0.8 + 0.7)
    assert context.body_mass['joint5'] == pytest.approx(1.5)
    assert context.mass_behind['joint3'] == pytest.approx(1.2 + 0.8 + 0.7)
    assert context.body_parent['joint1'] is None and context.body_children['joint2'] == ['joint3']
    assert context.reach == pytest.approx(0.1 + 0.3 + 0.3 + 0.25 + 0.2 + 0.15)
    assert context.size('link3') == pytest.approx(0.3) and context.has_shapes
    assert [entry.name for entry in context.moved][:2] == ['link1', 'link2']


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
    context = FindingContext(report, examine_urdf(text), None)
    assert context.reach == 0.0 and set(context.mass_behind) == {'j'}


def hit(subject, weight=0.0, advice='fix it', severity='warning'):
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


def test_a_single_occurrence_is_reported_literally():
    [found] = group_findings([hit('a')], str)
    assert (found.what, found.effect, found.subjects) == ('a is light', 'a sinks', ('a',))


def test_several_occurrences_are_ordered_by_weight():
    hits = [hit(name, weight) for weight, name in enumerate('abcdef')]
    [found] = group_findings(hits, lambda count: f'{count} are light')
    assert found.what == ("6 are light: 'f' (7 g), 'e' (7 g), 'd' (7 g), 'c' (7 g) and 2 more")
    assert found.effect == "'f': f sinks" and found.subjects == tuple('fedcba')
    assert found.advice == 'fix it'


def test_advice_that_differs_names_its_subject():
    [found] = group_findings([hit('a', 1.0, 'glue it'), hit('b')], str)
    assert found.advice == "'a': glue it"


def test_severities_are_not_grouped():
    assert len(group_findings([hit('a'), hit('b', severity='note')], str)) == 2
