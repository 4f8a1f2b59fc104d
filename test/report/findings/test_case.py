"""Who carries what, and how large it is."""

from dynamics_node.report import make_report
from dynamics_node.report.findings.context import FindingContext
from dynamics_node.urdf import examine_urdf
import pytest
from support.arms import arm


def test_masses_and_lengths_of_an_arm():
    case = FindingContext(make_report(arm(), samples=10), examine_urdf(arm()), None)
    assert case.moving_mass == pytest.approx(3.0 + 2.5 + 2.0 + 1.2 + 0.8 + 0.7)
    assert case.body_mass['joint5'] == pytest.approx(1.5)
    assert case.mass_behind['joint3'] == pytest.approx(1.2 + 0.8 + 0.7)
    assert case.body_parent['joint1'] is None and case.body_children['joint2'] == ['joint3']
    assert case.reach == pytest.approx(0.1 + 0.3 + 0.3 + 0.25 + 0.2 + 0.15)
    assert case.size('link3') == pytest.approx(0.3) and case.has_shapes
    assert [entry.name for entry in case.moved][:2] == ['link1', 'link2']


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
    case = FindingContext(report, examine_urdf(text), None)
    assert case.reach == 0.0 and set(case.mass_behind) == {'j'}
