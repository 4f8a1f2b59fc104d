"""The plots of one joint."""

from dataclasses import replace
import math

from dynamics_node.report.html.plot_curve import curve_figure, histogram_figure
import numpy as np
from support.report_pages import arm7_report, loaded_joints


def test_curve_and_histogram_belong_to_their_joint():
    report = arm7_report()
    for place, joint in enumerate(loaded_joints(report)):
        curve, worst = curve_figure(joint, joint.gravity.position[place])['data']
        assert curve['y'] == list(joint.gravity.curve_torques)
        scale = 1.0 if joint.kind == 'prismatic' else 180.0 / math.pi
        np.testing.assert_allclose(curve['x'], scale * np.array(joint.gravity.curve_positions))
        assert worst['y'] == [joint.gravity.worst]
        assert worst['x'] == [scale * joint.gravity.position[place]]
        bars = histogram_figure(joint)['data'][0]
        np.testing.assert_allclose(
            bars['y'], 100.0 * np.array(joint.gravity.counts) / sum(joint.gravity.counts)
        )


def test_a_limit_is_drawn_where_it_is_near_and_not_where_it_would_flatten_the_curve():
    joint = next(joint for joint in loaded_joints(arm7_report()) if joint.gravity.share > 0.3)
    assert len(curve_figure(joint, 0.0)['layout']['shapes']) == 2
    assert not curve_figure(replace(joint, effort=1e4), 0.0)['layout']['shapes']
    weak = replace(joint, effort=0.5 * joint.gravity.magnitude)
    line = histogram_figure(weak)['layout']['shapes'][0]
    assert line['x0'] == line['x1'] == weak.effort
