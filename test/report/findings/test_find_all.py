"""All findings together; refused robots; the list of kinds."""

from pathlib import Path
import re

from dynamics_node import RobotDescriptionError
from dynamics_node.report import make_report
from dynamics_node.report.findings import KINDS
from dynamics_node.report.report import SEVERITIES
from dynamics_node.urdf import read_urdf
import pytest
from support.arms import arm, changed
from support.robots import PENDULUM, public_robot, public_robots, random_urdf

# Public robots with notes at most.
CLEAN = {
    'panda.urdf',
    'kinova.urdf',
    'z1.urdf',
    'xarm7.urdf',
    'so100.urdf',
    'so101.urdf',
    'solo12.urdf',
    'go2.urdf',
    'b1-z1.urdf',
    'anymal.urdf',
    'centauro.urdf',
    'tiago_no_hand.urdf',
    'ur10_robot.urdf',
}


# Each kind of robot once: those that differ in a limit, a box or a hand take long.
ROBOTS = [
    name
    for name in public_robots()
    if not any(
        part in name
        for part in (
            '_box',
            '_corrected',
            'talos_full',
            'tiago_dual',
            'tiago.urdf',
            'tiago_pro',
            'romeo.urdf',
            'romeo_small',
            'classical',
            'limited',
            'collision',
            'icub_reduced',
            '_right',
            'pendulum_',
            'anymal-kinova',
            'b1.urdf',
            'go1',
            'laikago',
            'simple.urdf',
            'solo.urdf',
            'sake',
            'human',
        )
    )
]


@pytest.mark.parametrize('name', ROBOTS)
def test_public_robots_get_few_findings_that_are_whole_sentences(name):
    report = make_report(public_robot(name), samples=32)
    assert len(report.findings) <= 8
    ranks = [SEVERITIES.index(finding.severity) for finding in report.findings]
    assert ranks == sorted(ranks)
    known = {link.name for link in report.links} | {joint.name for joint in report.joints}
    for finding in report.findings:
        assert finding.severity in KINDS[finding.kind][0], finding.kind
        assert set(finding.subjects) <= known
        assert finding.what and finding.advice
        assert 'nan' not in finding.effect and 'inf ' not in finding.effect
    if name.split('/')[-1] in CLEAN:
        assert report.is_clean, report.findings


def test_the_pendulum_of_this_project_is_clean():
    assert make_report(PENDULUM).is_clean


@pytest.mark.parametrize('seed', range(6))
def test_random_trees_get_a_report(seed):
    report = make_report(random_urdf(seed), samples=64)
    assert report.verdict == 'usable'
    assert all(finding.kind in KINDS for finding in report.findings)


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
    texts = ' '.join(finding.what for finding in report.findings)
    for problem in report.refusals:
        assert problem in texts or 'inertia is not physical' in problem or 'mass is -' in problem
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


def test_refusals_by_the_model_alone_are_findings_too():
    # Mimic joints that multiply each other to numbers that no robot has.
    text = arm()
    for i in range(2, 6):
        text = text.replace(
            f'name="joint{i}" type="revolute">',
            f'name="joint{i}" type="revolute"><mimic joint="joint{i - 1}" multiplier="1e20"/>',
        )
    report = make_report(text, samples=20)
    texts = [finding.what for finding in report.findings if finding.kind == 'refused']
    assert report.verdict == 'refused' and texts == list(report.refusals)
    assert all('multiplier' in what for what in texts)


ROOT = Path(__file__).parents[3]
SOURCES = ROOT / 'dynamics_node' / 'report' / 'findings'


def test_every_kind_is_used_and_tested():
    code = ' '.join(path.read_text() for path in SOURCES.glob('*.py') if path.name != 'kinds.py')
    tests = ' '.join(
        path.read_text()
        for path in Path(__file__).parent.glob('test_*.py')
        if path != Path(__file__)
    )
    for kind, (severities, meaning) in KINDS.items():
        assert f"'{kind}'" in code, kind
        assert f"'{kind}'" in tests, kind
        assert set(severities) <= set(SEVERITIES) and severities and meaning


def test_the_document_explains_every_kind_as_it_is():
    rows = re.findall(
        r'^\| `(\w+)` \| ([a-z, ]+) \| (.+?) \|',
        (ROOT / 'docs' / 'report.md').read_text(),
        re.MULTILINE,
    )
    assert [kind for kind, *_ in rows] == list(KINDS)
    for kind, severities, meaning in rows:
        assert severities.split(', ') == list(KINDS[kind][0]), kind
        assert meaning == KINDS[kind][1], kind
