"""Limits in degrees, and limits that no motor of the robot has."""

import math

from dynamics_node.report import make_report
import pytest
from support.arms import arm, changed
from support.robots import public_robot

SOLO = 'solo_description/robots/solo12.urdf'


def findings(text, kind):
    """Return the findings of a kind."""
    return [finding for finding in make_report(text, samples=300).findings if finding.kind == kind]


def test_limits_in_degrees_are_found_with_what_they_do():
    limits = (0.4, 1.2)
    text = arm(limits=tuple(map(math.degrees, limits)))
    [found] = findings(text, 'limits_in_degrees')
    assert (found.severity, len(found.subjects)) == ('warning', 5)
    assert '22.9 to 68.8 rad' in found.what and 'upper="1.2"' in found.advice
    right = make_report(arm(limits=limits), samples=300)
    joint = next(joint for joint in right.joints if f"of joint '{joint.name}'" in found.effect)
    assert f'{joint.gravity.magnitude:.3g} N m if they are degrees' in found.effect


def test_a_few_turns_and_one_joint_that_turns_for_ever_are_no_degrees():
    assert not findings(arm(limits=(-2.0 * math.tau, 2.0 * math.tau)), 'limits_in_degrees')
    assert not findings(
        changed(arm(), 'joint5', limit={'lower': -100, 'upper': 100}), 'limits_in_degrees'
    )


@pytest.mark.parametrize('effort, severity', [(2e4, 'note'), (1e6, 'warning')])
def test_an_effort_limit_that_no_motor_has_is_found(effort, severity):
    [found] = findings(arm(effort=effort), 'effort_limit_too_large')
    assert (found.severity, len(found.subjects)) == (severity, 5)
    # The one that has most to hold is told.
    assert "'joint2': gravity needs at most" in found.effect and 'mean nothing' in found.effect


def test_what_a_strong_motor_has_is_no_finding():
    assert not findings(arm(effort=1000), 'effort_limit_too_large')


def test_a_default_of_1000_on_a_robot_of_2_kg_is_found():
    [found] = findings(public_robot(SOLO), 'effort_limit_too_large')
    assert len(found.subjects) == 12 and '1000 N m' in found.what
