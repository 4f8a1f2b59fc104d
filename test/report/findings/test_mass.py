"""Masses, centers of mass and missing tools."""

from xml.etree import ElementTree

from dynamics_node import RobotModel
from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed, G
from support.findings import findings
from support.robots import ARM7, public_robot, public_robots

PANDA = 'panda_description/urdf/panda.urdf'
XARM7 = 'xarm_description/urdf/xarm7.urdf'


def test_a_sound_arm_has_no_findings():
    assert make_report(arm(), samples=500).findings == ()


@pytest.mark.parametrize('link, mass', [('link2', 0.007), ('link3', 0.002), ('link1', 0.003)])
def test_a_link_of_7_g_is_found_with_its_effect(link, mass):
    [found] = findings(changed(arm(), link, mass=mass), 'grams')
    assert (found.severity, found.subjects) == ('warning', (link,))
    assert f'{1000.0 * mass:g} g' in found.what
    right = 1000.0 * mass
    assert f'if it weighed {right:g} kg' in found.effect
    assert 'instead of' in found.effect or 'next to nothing' in found.effect


def test_the_effect_of_7_g_is_that_of_the_robot_with_7_kg():
    text = changed(arm(), 'link2', mass=0.007)
    [found] = findings(text, 'grams')
    before, after = (
        make_report(changed(text, 'link2', mass=mass), samples=500) for mass in (0.007, 7.0)
    )
    joint = next(name for name in after.joint_names if f"'{name}'" in found.effect)
    torques = [
        next(entry.gravity.magnitude for entry in report.joints if entry.name == joint)
        for report in (after, before)
    ]
    assert f'would be {torques[0]:.3g} N m instead of {torques[1]:.3g} N m' in found.effect


@pytest.mark.parametrize('factor', [1.0, 1e-3])
def test_7_g_in_a_public_arm_are_found_with_and_without_its_inertia(factor):
    text = public_robot(XARM7).read_text()
    for link in ('link2', 'link4'):
        broken = changed(text, link, mass=0.007)
        if factor != 1.0:
            broken = changed(broken, link, tensor=1e-6)
        [found] = findings(broken, 'grams')
        assert found.subjects == (link,)


def test_a_last_link_in_grams_is_found_with_and_without_its_inertia():
    text = arm(tool=False)
    for broken in (
        changed(text, 'link5', mass=0.0008),
        changed(changed(text, 'link5', mass=0.0008), 'link5', tensor=1e-7),
    ):
        [found] = findings(broken, 'grams')
        assert found.subjects == ('link5',) and 'if it weighed 0.8 kg' in found.effect


def test_grams_beside_a_gripper_of_kilograms_are_found_by_their_inertia():
    [found] = findings(changed(arm(), 'link5', mass=0.0008), 'grams')
    assert found.subjects == ('link5',) and 'sqrt(I/m)' in found.what


@pytest.mark.parametrize('link', ['panda_link7', 'panda_hand'])
def test_7_g_beside_what_is_fixed_to_it_are_found(link):
    text = public_robot(PANDA).read_text()
    assert not findings(text, 'grams')
    [found] = findings(changed(text, link, mass=0.007), 'grams')
    assert found.subjects == (link,) and 'N m' in found.effect
    # 7 kg is no hand; 15 g of a finger do not tell its mass either.
    proposed = float(found.effect.split('as much as its neighbors, ')[1].removesuffix(' kg'))
    assert 0.5 < proposed < 2.0


def test_massless_feet_are_no_finding():
    assert not findings(public_robot('hyq_description/robots/hyq_no_sensors.urdf'), 'grams')


def test_moments_in_another_unit_are_no_masses_in_grams():
    robot = ElementTree.fromstring(public_robot(PANDA).read_text())
    for inertia in robot.iter('inertia'):
        for key, value in inertia.attrib.items():
            inertia.set(key, repr(1e6 * float(value)))
    text = ElementTree.tostring(robot, encoding='unicode')
    assert not findings(text, 'grams')
    [found] = findings(text, 'inertia_too_large')
    assert len(found.subjects) > 5


def test_a_light_link_between_light_ones_is_no_finding():
    small = tuple(mass / 500.0 for mass in (3.0, 2.5, 2.0, 1.2, 0.8))
    assert not findings(arm(small), 'grams')


@pytest.mark.parametrize('take', ['inertial', 'mass'])
def test_a_robot_without_inertials_has_one_problem(take):
    text = arm()
    for link in ('link1', 'link2', 'link3', 'link4', 'link5', 'gripper'):
        text = (
            changed(text, link, inertial=False)
            if take == 'inertial'
            else changed(text, link, mass=0.0, tensor=0.0)
        )
    report = make_report(text, samples=100)
    assert [finding.kind for finding in report.findings] == ['no_inertial']
    [found] = report.findings
    assert found.severity == 'problem'
    assert not RobotModel.from_urdf(text).gravity_torque(np.full(5, 0.3)).any()
    assert ('none of them has an <inertial>' in found.what) == (take == 'inertial')


def test_a_shape_without_mass_at_the_end_is_a_warning_with_what_it_could_weigh():
    text = changed(arm(), 'gripper', inertial=False).replace('gripper', 'lamp')
    [found] = findings(text, 'shape_without_mass')
    assert (found.severity, found.subjects) == ('warning', ('lamp',))
    assert 'no <inertial>' in found.what
    # 2 kg, the median of the five links, 1.2 m from the second joint.
    assert "joint 'joint2'" in found.effect and 'if it weighed 2 kg' in found.effect
    before = make_report(text, samples=500)
    [joint] = [joint for joint in before.joints if joint.name == 'joint2']
    added = 2.0 * G * (0.3 + 0.25 + 0.2 + 0.15)
    assert f'would be {joint.gravity.magnitude + added:.3g} N m' in found.effect


def test_a_shape_without_mass_in_the_middle_may_be_in_its_neighbor():
    cover = (
        '<link name="cover"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
        '<joint name="c" type="fixed"><parent link="link2"/><child link="cover"/></joint>'
    )
    [found] = findings(arm().replace('</robot>', cover + '</robot>'), 'shape_without_mass')
    assert found.severity == 'note'


def test_frames_without_shape_are_no_findings():
    frames = (
        '<link name="camera"/><joint name="c" type="fixed"><parent link="link2"/>'
        '<child link="camera"/></joint>'
    )
    assert not make_report(arm().replace('</robot>', frames + '</robot>'), samples=100).findings


def test_a_joint_that_moves_nothing_is_a_problem():
    text = changed(changed(arm(), 'gripper', inertial=False), 'link5', inertial=False)
    [found] = findings(text, 'joint_moves_nothing')
    assert (found.severity, found.subjects) == ('problem', ('joint5',))
    report = make_report(text, samples=100)
    assert not report.conditioning.is_positive_definite
    assert 'singular_mass_matrix' not in {finding.kind for finding in report.findings}


@pytest.mark.parametrize('mass', ['1,5', 'inf', '1e308'])
def test_a_mass_that_cannot_be_read_is_no_joint_that_moves_nothing(mass):
    text = changed(arm(tool=False), 'link5', mass=77.0).replace('"77.0"', f'"{mass}"')
    assert [finding.kind for finding in make_report(text, samples=50).findings] == ['refused']


def test_a_negative_mass_is_refused_with_a_finding():
    report = make_report(changed(arm(), 'link3', mass=-2.0), samples=500)
    assert report.verdict == 'refused'
    [found] = [finding for finding in report.findings if finding.kind == 'negative_mass']
    assert (found.severity, found.subjects) == ('problem', ('link3',))
    assert '-2 kg' in found.what and 'N m' in found.effect
    assert 'refused' not in {finding.kind for finding in report.findings}


def test_our_own_arm_is_clean():
    report = make_report(ARM7)
    assert report.is_clean and report.findings == ()


def test_millimeters_written_as_meters_are_found():
    [found] = findings(changed(arm(), 'link3', com=[125.0, 0.0, 0.0]), 'far_com')
    assert (found.severity, found.subjects) == ('warning', ('link3',))
    assert '125 m' in found.what and 'a thousandth of that, 0.125 m' in found.effect
    right = make_report(arm(), samples=300)
    joint = next(joint for joint in right.joints if f"'{joint.name}'" in found.effect)
    assert f'would be {joint.gravity.magnitude:.3g} N m' in found.effect


def test_coordinates_of_the_whole_robot_are_found():
    [found] = findings(changed(arm(), 'link5', com=[1.1, 0.0, 0.0]), 'far_com')
    assert found.subjects == ('link5',)


def test_a_center_of_mass_a_little_outside_is_no_finding():
    assert not findings(changed(arm(), 'link3', com=[0.3, 0.1, 0.0]), 'far_com')


def test_a_tenth_of_the_distance_is_tried_first():
    [found] = findings(changed(arm(), 'link5', com=[0.0, 0.0, 1.5]), 'far_com')
    assert 'a tenth of that, 0.15 m' in found.effect


FRAME = (
    '<link name="tool0"/><joint name="f" type="fixed"><parent link="link5"/>'
    '<child link="tool0"/><origin xyz="0.15 0 0"/></joint></robot>'
)


def test_a_gripper_that_is_seen_without_mass_is_a_warning():
    [found] = findings(changed(arm(), 'gripper', inertial=False), 'missing_gripper')
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
    [found] = findings(text, 'missing_gripper')
    assert found.severity == 'note'
    assert 'without its mass' in found.effect


def test_a_missing_gripper_is_not_also_a_massless_shape():
    report = make_report(changed(arm(), 'gripper', inertial=False), samples=100)
    assert [finding.kind for finding in report.findings] == ['missing_gripper']


def test_a_gripper_with_mass_is_no_finding():
    assert not findings(arm(), 'missing_gripper')


def test_fingers_are_a_gripper():
    fingers = ''.join(
        f'<link name="part{i}"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" '
        f'iyy="1e-4" iyz="0" izz="1.2e-4"/></inertial></link><joint name="s{i}" type="prismatic">'
        f'<parent link="link5"/><child link="part{i}"/><axis xyz="0 1 0"/>'
        '<limit lower="0" upper="0.1" effort="50" velocity="1"/></joint>'
        for i in range(2)
    )
    assert not findings(
        arm(tool=False).replace('</robot>', fingers + '</robot>'), 'missing_gripper'
    )


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
        for finding in findings(public_robot(name), 'missing_gripper'):
            (warned if finding.severity == 'warning' else noted).add(name.split('/')[-1])
    assert warned == {'ur3_gripper.urdf', 'ur5_gripper.urdf'}
    assert noted >= {'ur3_robot.urdf', 'ur5_robot.urdf', 'ur10_robot.urdf', 'xarm7.urdf'}
    assert not any(
        word in name
        for name in noted
        for word in ('panda', 'kinova', 'z1', 'so10', 'solo', 'anymal', 'go1')
    )
