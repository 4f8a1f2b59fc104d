"""The plot of the worst gravity torques."""

from dataclasses import replace
import math

from dynamics_node.report.html.plot_worst import tone, worst_figure
from support.report_pages import arm7_report, loaded_joints, unlimited_report, weak_report


def test_the_bars_are_the_worst_torques_and_their_shares():
    report = arm7_report()
    share, torque, limits = worst_figure(loaded_joints(report))['data']
    joints = loaded_joints(report)
    assert torque['x'] == [abs(joint.gravity.worst) for joint in joints]
    assert share['x'] == [100.0 * joint.gravity.share for joint in joints]
    assert limits['x'] == [joint.effort for joint in joints]


def test_a_joint_over_its_limit_has_another_color():
    report = weak_report()
    share = worst_figure(loaded_joints(report))['data'][0]
    over = [joint.gravity.share > 1.0 for joint in loaded_joints(report)]
    assert any(over) and not all(over)
    assert [color == {'css': 'problem'} for color in share['marker']['color']] == over
    assert [tone(value) for value in (0.5, 0.9, 1.1, math.nan)] == [
        'accent',
        'warning',
        'problem',
        'faint',
    ]


def test_without_limits_only_torques_are_shown():
    figure = worst_figure(loaded_joints(unlimited_report()))
    assert [mode['label'] for mode in figure['modes']] == ['torque']
    assert [trace['visible'] for trace in figure['data']] == figure['modes'][0]['visible']


def test_a_limit_far_beyond_the_torques_does_not_make_them_invisible():
    joints = [replace(joint, effort=1e4) for joint in loaded_joints(arm7_report())]
    torque = worst_figure(joints)['modes'][1]['layout']['xaxis']
    assert torque['range'][1] < 2.0 * max(joint.gravity.magnitude for joint in joints)
