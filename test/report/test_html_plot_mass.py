"""The plot of masses."""

from dynamics_node.report.html_plot_mass import mass_figure
import pytest
from support.report_pages import arm7_report


def test_masses_are_those_of_the_bodies():
    report = arm7_report()
    bars = mass_figure(report.bodies)['data'][0]
    assert bars['x'] == [body.mass for body in report.bodies]
    assert sum(bars['x']) == pytest.approx(report.moving_mass)
