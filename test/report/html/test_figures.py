"""The figures of the page: all of them legal for plotly."""

from dynamics_node.report.html.figures import page_data
import numpy as np
import plotly.graph_objects as go
import pytest
from support.report_pages import (
    arm7_report,
    block_report,
    loaded_joints,
    pendulum_report,
    refused_report,
    unlimited_report,
    weak_report,
)

REPORTS = {
    'arm7': arm7_report,
    'weak': weak_report,
    'unlimited': unlimited_report,
    'pendulum': pendulum_report,
}


def colored(value):
    """Return a figure with a color in the place of every name of one."""
    if isinstance(value, dict):
        return (
            '#123456'
            if set(value) == {'css'}
            else {key: colored(part) for key, part in value.items()}
        )
    return [colored(part) for part in value] if isinstance(value, list) else value


def all_figures(figures):
    yield from (figures[name] for name in ('worst', 'distribution', 'mass'))
    yield from figures['joint']['curves']
    yield from figures['joint']['histograms']


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


def test_the_joint_that_is_shown_first_is_nearest_to_its_limit():
    report = weak_report()
    first = page_data(report)['figures']['joint']['first']
    assert first == int(np.argmax([joint.gravity.share for joint in loaded_joints(report)]))


def test_without_limits_the_joint_with_the_largest_torque_comes_first():
    first = page_data(unlimited_report())['figures']['joint']['first']
    assert first == int(
        np.argmax([joint.gravity.magnitude for joint in loaded_joints(unlimited_report())])
    )
