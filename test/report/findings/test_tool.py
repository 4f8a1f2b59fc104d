"""Arms that end without a tool that weighs something."""

from dynamics_node.report import make_report
import pytest
from support.arms import arm, changed, G
from support.robots import public_robot, public_robots

FRAME = (
    '<link name="tool0"/><joint name="f" type="fixed"><parent link="link5"/>'
    '<child link="tool0"/><origin xyz="0.15 0 0"/></joint></robot>'
)


def findings(text):
    """Return the findings of the kind."""
    return [
        finding
        for finding in make_report(text, samples=500).findings
        if finding.kind == 'missing_gripper'
    ]


def test_a_gripper_that_is_seen_without_mass_is_a_warning():
    [found] = findings(changed(arm(), 'gripper', inertial=False))
    assert (found.severity, found.subjects) == ('warning', ('gripper',))
    # 1 kg at 0.3 + 0.25 + 0.2 + 0.15 m from joint 2.
    torque = G * 0.9
    assert f"{torque:.3g} N m to joint 'joint2', {torque / 3.0:.3g} %" in found.effect
    assert 'payload.link: gripper' in found.advice


@pytest.mark.parametrize(
    'text',
    [arm(tool=False).replace('</robot>', FRAME), arm(tool=False)],
    ids=['a frame', 'nothing'],
)
def test_an_arm_that_ends_in_its_flange_is_a_note(text):
    [found] = findings(text)
    assert found.severity == 'note'
    assert 'without its mass' in found.effect


def test_it_is_not_told_twice():
    report = make_report(changed(arm(), 'gripper', inertial=False), samples=100)
    assert [finding.kind for finding in report.findings] == ['missing_gripper']


def test_a_gripper_with_mass_is_no_finding():
    assert not findings(arm())


def test_fingers_are_a_gripper():
    fingers = ''.join(
        f'<link name="part{i}"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" '
        f'iyy="1e-4" iyz="0" izz="1.2e-4"/></inertial></link><joint name="s{i}" type="prismatic">'
        f'<parent link="link5"/><child link="part{i}"/><axis xyz="0 1 0"/>'
        '<limit lower="0" upper="0.1" effort="50" velocity="1"/></joint>'
        for i in range(2)
    )
    assert not findings(arm(tool=False).replace('</robot>', fingers + '</robot>'))


def test_which_public_robots_have_none():
    # Those that end in a flange, a tool frame or a gripper without mass; no leg, no head.
    warned, noted = set(), set()
    for name in public_robots():
        if not any(
            part in name
            for part in (
                'ur3',
                'ur5',
                'ur10_robot',
                'xarm',
                'panda.urdf',
                'kinova',
                'z1',
                'so10',
                'solo',
                'go1',
                'tiago_no_hand',
                'talos_left_arm',
            )
        ):
            continue
        for finding in findings(public_robot(name)):
            (warned if finding.severity == 'warning' else noted).add(name.split('/')[-1])
    assert warned == {'ur3_gripper.urdf', 'ur5_gripper.urdf'}
    assert noted >= {'ur3_robot.urdf', 'ur5_robot.urdf', 'ur10_robot.urdf', 'xarm7.urdf'}
    assert not any(
        word in name
        for name in noted
        for word in ('panda', 'kinova', 'z1', 'so10', 'solo', 'anymal', 'go1')
    )
