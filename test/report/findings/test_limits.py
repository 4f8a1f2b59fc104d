"""Limits that are missing, zero or exchanged, and gravity beyond them."""

from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed, pendulum


def findings(text, kind):
    """Return the findings of a kind."""
    return [
        finding for finding in make_report(text, samples=2000).findings if finding.kind == kind
    ]


def test_gravity_above_the_limit_is_told_with_how_often():
    # G = 7.848 cos q, above 5 N m for |cos q| > 0.6371: 1 - 2 acos(0.6371) / pi... of a turn.
    [found] = findings(pendulum(2.0, 0.4, effort=5.0), 'over_effort_limit')
    assert (found.severity, found.subjects) == ('warning', ('swing',))
    assert '7.85 N m, 157.0 % of its effort limit of 5 N m' in found.what
    said = float(found.effect.split('at ')[1].split(' %')[0])
    assert said == pytest.approx(200.0 / np.pi * np.arccos(5.0 / 7.848), abs=3.0)
    assert not findings(pendulum(2.0, 0.4, effort=7.9), 'over_effort_limit')


@pytest.mark.parametrize(
    'limit, kind',
    [
        ({'effort': None}, 'no_effort_limit'),
        ({'effort': 'inf'}, 'no_effort_limit'),
        ({'effort': 0}, 'zero_effort_limit'),
        ({'effort': -3}, 'zero_effort_limit'),
    ],
)
def test_an_effort_limit_that_is_none(limit, kind):
    [found] = findings(changed(arm(), 'joint2', limit=limit), kind)
    assert (found.severity, found.subjects) == ('warning', ('joint2',))
    assert "of 'joint2'" in found.effect and 'N m' in found.effect


def test_a_joint_that_gravity_does_not_load_needs_no_limit_that_much():
    [found] = findings(changed(arm(), 'joint1', limit={'effort': None}), 'no_effort_limit')
    assert found.severity == 'note' and 'gravity does not load them' in found.effect


@pytest.mark.parametrize('velocity', [None, 0])
def test_no_velocity_limit_is_a_note(velocity):
    [found] = findings(changed(arm(), 'joint4', limit={'velocity': velocity}), 'no_velocity_limit')
    assert (found.severity, found.subjects) == ('note', ('joint4',))
    assert ('a velocity limit of 0' if velocity == 0 else 'no velocity limit') in found.what


@pytest.mark.parametrize('lower, upper', [(0, 0), (1, -1), (0.5, 0.5)])
def test_an_empty_range_is_a_warning(lower, upper):
    [found] = findings(
        changed(arm(), 'joint3', limit={'lower': lower, 'upper': upper}), 'empty_range'
    )
    assert (found.severity, found.subjects) == ('warning', ('joint3',))
    assert 'counts as a joint without limits' in found.effect


def test_a_slide_without_limits_stands_still_and_that_is_told():
    text = changed(arm(), 'joint5', kind='prismatic', limit={'lower': None, 'upper': None})
    [found] = findings(text, 'not_looked_at')
    assert (found.severity, found.subjects) == ('note', ('joint5',))
    [joint] = [joint for joint in make_report(text, samples=50).joints if joint.name == 'joint5']
    assert joint.range_note and set(joint.gravity.curve_positions) == {0.0}


def test_an_effort_limit_below_zero_is_called_so():
    [found] = findings(changed(arm(), 'joint2', limit={'effort': -50}), 'zero_effort_limit')
    assert 'below zero' in found.what


def test_nobody_knows_what_gravity_asks_of_a_robot_without_masses():
    text = arm(effort=0)
    for link in ('link1', 'link2', 'link3', 'link4', 'link5', 'gripper'):
        text = changed(text, link, inertial=False)
    [found] = findings(text, 'zero_effort_limit')
    assert found.severity == 'warning' and 'gravity' not in found.effect
