"""The plot of how gravity torques are spread."""

from dynamics_node.report.html.plot_distribution import distribution_figure
import pytest
from support.report_pages import arm7_report, loaded_joints, unlimited_report


def test_the_boxes_are_quantiles_of_the_report():
    report = arm7_report()
    shares, torques, _, _ = distribution_figure(loaded_joints(report))['data']
    for place, joint in enumerate(loaded_joints(report)):
        known = dict(zip(joint.gravity.levels, joint.gravity.quantiles, strict=True))
        for key, level in (
            ('lowerfence', 0.05),
            ('q1', 0.25),
            ('median', 0.5),
            ('q3', 0.75),
            ('upperfence', 0.95),
        ):
            assert torques[key][place] == known[level]
            assert shares[key][place] == pytest.approx(100.0 * known[level] / joint.effort)


def test_without_limits_only_torques_are_shown():
    figure = distribution_figure(loaded_joints(unlimited_report()))
    assert [mode['label'] for mode in figure['modes']] == ['torque']
    assert [trace['visible'] for trace in figure['data']] == figure['modes'][0]['visible']
