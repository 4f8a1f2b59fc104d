"""All findings together, on robots as they come."""

from dynamics_node.report import make_report
from dynamics_node.report.findings import KINDS
from dynamics_node.report.report import SEVERITIES
import pytest
from support.robots import PENDULUM, public_robot, public_robots, random_urdf

# Public robots about which nothing is to be said but notes.
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
