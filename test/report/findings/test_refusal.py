"""Robots that are refused still get a report."""

from dynamics_node import RobotDescriptionError
from dynamics_node.report import make_report
from dynamics_node.urdf import read_urdf
import pytest
from support.arms import arm, changed
from support.robots import public_robot

BROKEN = [
    arm().replace('revolute', 'floating', 1),
    arm().replace('<child link="link3"/>', '<child link="nowhere"/>'),
    arm().replace('mass value="2.5"', 'mass value="2,5"'),
    arm().replace('name="link4"', 'name="link3"'),
    changed(arm(), 'link3', mass=-1.0),
    changed(arm(), 'link3', tensor={'ixx': -1.0}),
    arm().replace('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>'),
    '<robot name="empty"/>',
]


@pytest.mark.parametrize('text', BROKEN)
def test_every_problem_is_in_the_report(text):
    report = make_report(text, samples=100)
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(text)
    assert report.refusals == caught.value.problems
    assert (report.verdict, report.model, report.payload) == ('refused', None, None)
    assert report.counts['problem'] and not report.is_clean
    said = ' '.join(finding.what for finding in report.findings)
    for problem in report.refusals:
        assert problem in said or 'inertia is not physical' in problem or 'mass is -' in problem
    for entry in report.joints:
        assert entry.gravity is None


def test_what_could_be_read_is_shown():
    report = make_report(BROKEN[2], samples=100)
    by_name = {link.name: link for link in report.links}
    assert by_name['link1'].mass == 3.0 and by_name['link1'].carrier == 'joint1'
    assert by_name['link2'].mass != by_name['link2'].mass and by_name['link2'].has_inertial
    assert [joint.name for joint in report.joints] == [f'joint{i}' for i in range(1, 6)]


def test_many_reasons_are_one_finding_with_all_of_them():
    report = make_report(
        public_robot('alex_description/urdf/alex_psyonic_hands.urdf'), samples=100
    )
    [found] = [finding for finding in report.findings if finding.kind == 'refused']
    assert len(report.refusals) == 8
    for reason in report.refusals:
        assert reason in found.what


def test_what_only_the_model_refuses_is_told_too():
    # Mimic joints that multiply each other to numbers that no robot has.
    text = arm()
    for i in range(2, 6):
        text = text.replace(
            f'name="joint{i}" type="revolute">',
            f'name="joint{i}" type="revolute"><mimic joint="joint{i - 1}" multiplier="1e20"/>',
        )
    report = make_report(text, samples=20)
    told = [finding.what for finding in report.findings if finding.kind == 'refused']
    assert report.verdict == 'refused' and told == list(report.refusals)
    assert all('multiplier' in what for what in told)
