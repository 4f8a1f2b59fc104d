"""Joint definitions, limits and the mass matrix."""

import math

from dynamics_node import RobotModel, SingularMassMatrixError
from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed, pendulum, rod
from support.findings import findings
from support.robots import public_robot


def test_a_missing_axis_has_the_torque_about_z_as_effect():
    # Joint 1 turns about z, and about x without its axis: lying on its side it holds the arm.
    text = changed(arm(), 'joint1', axis=False)
    [found] = findings(text, 'missing_axis')
    assert (found.severity, found.subjects) == ('warning', ('joint1',))
    right = make_report(text.replace('type="revolute"', 'type="revolute"'), samples=300)
    magnitude = right.joints[0].gravity.magnitude
    assert f'is {magnitude:.3g} N m; with the z axis it would be 0 N m' in found.effect


def test_an_axis_that_is_no_unit_vector_is_a_note():
    [found] = findings(arm().replace('xyz="1 0 0"', 'xyz="2 0 0"'), 'axis_length')
    assert (found.severity, found.subjects) == ('note', ('joint5',))


def test_negative_friction_is_a_warning():
    text = arm().replace('</joint>', '<dynamics damping="-1" friction="-2"/></joint>', 1)
    [found] = findings(text, 'negative_friction')
    assert (found.severity, found.subjects) == ('warning', ('joint1',))
    assert 'damping is -1' in found.what and 'friction is -2' in found.what


def test_nothing_moves_is_a_note():
    report = make_report('<robot name="stone"><link name="a"/></robot>')
    assert [finding.kind for finding in report.findings] == ['no_movable_joint']
    assert report.payload is None and report.conditioning is None


def test_every_warning_of_the_model_is_in_the_report():
    text = changed(changed(arm(), 'joint1', axis=False), 'link5', tensor={'ixx': 0.5})
    text = changed(text.replace('xyz="1 0 0"', 'xyz="2 0 0"'), 'link2', inertial=False)
    text = text.replace('</joint>', '<dynamics damping="-1"/></joint>', 1)
    report = make_report(text, samples=100)
    assert len(report.model.warnings) == 5
    kinds = {finding.kind for finding in report.findings}
    assert kinds >= {
        'missing_axis',
        'axis_length',
        'negative_friction',
        'triangle_inequality',
        'shape_without_mass',
    }
    assert 'reader_warning' not in kinds


def test_an_unknown_warning_of_the_reader_is_reported_literally(monkeypatch):
    from dynamics_node.report.findings import joints

    monkeypatch.setattr(joints, '_EXPLAINED', ())
    [found] = findings(changed(arm(), 'joint1', axis=False), 'reader_warning')
    assert found.what == "joint 'joint1': axis is missing, (1, 0, 0) is used"


def test_gravity_above_the_limit_has_its_share_of_the_samples_as_effect():
    # G = 7.848 cos q, above 5 N m for |cos q| > 0.6371: 1 - 2 acos(0.6371) / pi... of a turn.
    [found] = findings(pendulum(2.0, 0.4, effort=5.0), 'over_effort_limit', 2000)
    assert (found.severity, found.subjects) == ('warning', ('swing',))
    assert '7.85 N m, 157.0 % of its effort limit of 5 N m' in found.what
    percent = float(found.effect.split('at ')[1].split(' %')[0])
    assert percent == pytest.approx(200.0 / np.pi * np.arccos(5.0 / 7.848), abs=3.0)
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


def test_a_prismatic_joint_without_limits_is_fixed_and_reported():
    text = changed(arm(), 'joint5', kind='prismatic', limit={'lower': None, 'upper': None})
    [found] = findings(text, 'not_looked_at')
    assert (found.severity, found.subjects) == ('note', ('joint5',))
    [joint] = [joint for joint in make_report(text, samples=50).joints if joint.name == 'joint5']
    assert joint.range_note and set(joint.gravity.curve_positions) == {0.0}


def test_a_negative_effort_limit_is_reported_as_negative():
    [found] = findings(changed(arm(), 'joint2', limit={'effort': -50}), 'zero_effort_limit')
    assert 'below zero' in found.what


def test_without_masses_the_finding_states_no_gravity_torque():
    text = arm(effort=0)
    for link in ('link1', 'link2', 'link3', 'link4', 'link5', 'gripper'):
        text = changed(text, link, inertial=False)
    [found] = findings(text, 'zero_effort_limit')
    assert found.severity == 'warning' and 'gravity' not in found.effect


SOLO = 'solo_description/robots/solo12.urdf'


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
    # The joint with the largest gravity torque comes first.
    assert "'joint2': gravity needs at most" in found.effect and 'mean nothing' in found.effect


def test_what_a_strong_motor_has_is_no_finding():
    assert not findings(arm(effort=1000), 'effort_limit_too_large')


def test_a_default_of_1000_on_a_robot_of_2_kg_is_found():
    [found] = findings(public_robot(SOLO), 'effort_limit_too_large')
    assert len(found.subjects) == 12 and '1000 N m' in found.what


def test_a_point_mass_on_the_axis_of_its_joint_has_no_inertia():
    # Joint 5 turns about x, and all mass behind it lies on x.
    text = arm(tool=False)
    text = text.replace(
        rod(0.8, 0.15),
        '<inertial><origin xyz="0.1 0 0"/><mass value="0.8"/>'
        '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>',
    )
    report = make_report(text, samples=200)
    [found] = [finding for finding in report.findings if finding.kind == 'singular_mass_matrix']
    assert (found.severity, found.subjects) == ('problem', ('joint5',))
    with pytest.raises(SingularMassMatrixError):
        RobotModel.from_urdf(text).forward_dynamics(np.zeros(5), np.zeros(5), np.zeros(5))


def test_a_matrix_that_loses_digits_is_a_note():
    text = changed(
        arm(tool=False), 'link5', mass=1e-5, tensor={'ixx': 1e-10, 'iyy': 1e-10, 'izz': 1e-10}
    )
    [found] = [
        finding
        for finding in make_report(text, samples=200).findings
        if finding.kind == 'ill_conditioned'
    ]
    assert (found.severity, found.subjects) == ('note', ('joint5',))
