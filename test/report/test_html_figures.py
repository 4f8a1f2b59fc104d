"""The figures of the page: legal for plotly, and with the numbers of the report."""

import math

from dynamics_node.report.html_figures import page_data
from dynamics_node.report.html_plot_parts import short
from dynamics_node.report.html_plot_worst import tone
import numpy as np
import plotly.graph_objects as go
import pytest
from support.report_pages import (
    arm7_report,
    block_report,
    pendulum_report,
    refused_report,
    unlimited_report,
    weak_report,
)

REPORTS = {'arm7': arm7_report, 'weak': weak_report, 'unlimited': unlimited_report,
           'pendulum': pendulum_report}


def colored(value):
    """Return a figure with a colour in the place of every name of one."""
    if isinstance(value, dict):
        return '#123456' if set(value) == {'css'} else {
            key: colored(part) for key, part in value.items()}
    return [colored(part) for part in value] if isinstance(value, list) else value


def all_figures(figures):
    yield from (figures[name] for name in ('worst', 'distribution', 'mass'))
    yield from figures['joint']['curves']
    yield from figures['joint']['histograms']


def loads(report):
    by_name = {joint.name: joint for joint in report.joints}
    return [by_name[name] for name in report.joint_names]


@pytest.mark.parametrize('report', REPORTS.values(), ids=REPORTS)
def test_plotly_accepts_every_figure(report):
    for figure in all_figures(page_data(report())['figures']):
        # Raises at the first property that plotly does not know.
        go.Figure(data=colored(figure['data']), layout=colored(figure['layout']))
        for mode in figure.get('modes', ()):
            go.Layout(colored(mode['layout']))
            assert len(mode['visible']) == len(figure['data'])


@pytest.mark.parametrize('report', [refused_report, block_report])
def test_without_torques_nothing_is_drawn(report):
    assert page_data(report()) is None


def test_the_bars_are_the_worst_torques_and_their_shares():
    report = arm7_report()
    share, torque, limits = page_data(report)['figures']['worst']['data']
    joints = loads(report)
    assert torque['x'] == [abs(joint.gravity.worst) for joint in joints]
    assert share['x'] == [100.0 * joint.gravity.share for joint in joints]
    assert limits['x'] == [joint.effort for joint in joints]


def test_a_joint_over_its_limit_has_another_colour():
    report = weak_report()
    share = page_data(report)['figures']['worst']['data'][0]
    over = [joint.gravity.share > 1.0 for joint in loads(report)]
    assert any(over) and not all(over)
    assert [color == {'css': 'problem'} for color in share['marker']['color']] == over
    assert [tone(value) for value in (0.5, 0.9, 1.1, math.nan)] == [
        'accent', 'warning', 'problem', 'faint']


def test_without_limits_only_torques_are_shown():
    figures = page_data(unlimited_report())['figures']
    for name in ('worst', 'distribution'):
        assert [mode['label'] for mode in figures[name]['modes']] == ['torque']
        visible = [trace['visible'] for trace in figures[name]['data']]
        assert visible == figures[name]['modes'][0]['visible']
    assert figures['joint']['first'] == int(np.argmax(
        [joint.gravity.magnitude for joint in loads(unlimited_report())]))


def test_the_boxes_are_quantiles_of_the_report():
    report = arm7_report()
    shares, torques, _, _ = page_data(report)['figures']['distribution']['data']
    for place, joint in enumerate(loads(report)):
        known = dict(zip(joint.gravity.levels, joint.gravity.quantiles, strict=True))
        for key, level in (('lowerfence', 0.05), ('q1', 0.25), ('median', 0.5), ('q3', 0.75),
                           ('upperfence', 0.95)):
            assert torques[key][place] == known[level]
            assert shares[key][place] == pytest.approx(100.0 * known[level] / joint.effort)


def test_curve_and_histogram_belong_to_their_joint():
    report = arm7_report()
    figures = page_data(report)['figures']['joint']
    for place, joint in enumerate(loads(report)):
        curve, worst = figures['curves'][place]['data']
        assert curve['y'] == list(joint.gravity.curve_torques)
        scale = 1.0 if joint.kind == 'prismatic' else 180.0 / math.pi
        np.testing.assert_allclose(curve['x'],
                                   scale * np.array(joint.gravity.curve_positions))
        assert worst['y'] == [joint.gravity.worst]
        assert worst['x'] == [scale * joint.gravity.position[place]]
        bars = figures['histograms'][place]['data'][0]
        np.testing.assert_allclose(
            bars['y'], 100.0 * np.array(joint.gravity.counts) / sum(joint.gravity.counts))


def test_the_joint_that_is_shown_first_is_nearest_to_its_limit():
    report = weak_report()
    first = page_data(report)['figures']['joint']['first']
    assert first == int(np.argmax([joint.gravity.share for joint in loads(report)]))


def test_masses_are_those_of_the_bodies():
    report = arm7_report()
    bars = page_data(report)['figures']['mass']['data'][0]
    assert bars['x'] == [body.mass for body in report.bodies]
    assert sum(bars['x']) == pytest.approx(report.moving_mass)


def test_a_long_name_loses_its_middle():
    assert short('shoulder_pan_joint') == 'shoulder_pan_joint'
    cut = short('a' * 50 + 'b' * 50)
    assert len(cut) <= 26 and cut.startswith('aaa') and cut.endswith('bbb') and '…' in cut
