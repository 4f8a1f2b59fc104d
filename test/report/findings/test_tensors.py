"""Inertia tensors, placeholders and copies."""

from dynamics_node import RobotModel
from dynamics_node.inertia import steiner
from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed, rod, scaled_tensor
from support.findings import findings
from support.robots import public_robot

XARM7 = 'xarm_description/urdf/xarm7.urdf'


def diagonal(text, q):
    """Return the diagonal of D."""
    return np.diagonal(RobotModel.from_urdf(text).mass_matrix(q))


@pytest.mark.parametrize('link, entry', [('link2', 'izz'), ('link3', 'iyy')])
def test_a_missing_decimal_point_is_found_and_corrected(link, entry):
    text = arm()
    right = float(text.split(f'name="{link}"')[1].split(f'{entry}="')[1].split('"')[0])
    [found] = findings(changed(text, link, tensor={entry: 10.0 * right}), 'triangle_inequality')
    assert (found.severity, found.subjects) == ('problem', (link,))
    # It passes the positive definite check: the robot is taken, with a warning.
    assert (
        make_report(changed(text, link, tensor={entry: 10.0 * right}), samples=100).verdict
        == 'usable'
    )
    assert f'{entry}="{right:.6g}" is physically possible' in found.advice
    assert '10 times too large' in found.advice
    assert 'gravity torques do not change' in found.effect


def test_the_effect_of_a_missing_decimal_point_is_that_on_d():
    text = arm()
    broken = changed(text, 'link5', tensor={'ixx': 0.05})
    [found] = findings(broken, 'triangle_inequality')
    # Joint 5 turns about x, so D_55 has ixx of link 5 and the gripper and nothing else.
    before, after = diagonal(broken, np.zeros(5))[4], found.effect
    corrected = float(found.advice.split('ixx="')[2].split('"')[0])
    right = changed(broken, 'link5', tensor={'ixx': corrected})
    share = before / diagonal(right, np.zeros(5))[4]
    assert "joint 'joint5'" in after
    share_text = after.split('up to ')[1]
    assert share_text.startswith(
        f'{share - 1.0:.3g} times more' if share > 11.0 else f'{100.0 * (share - 1.0):.3g} % more'
    )


def test_a_public_arm_with_a_missing_decimal_point():
    text = public_robot(XARM7).read_text()
    inertia = text.split('<link name="link2"')[1].split('<inertia ')[1].split('/>')[0]
    izz = float(inertia.split('izz="')[1].split('"')[0])
    [found] = findings(changed(text, 'link2', tensor={'izz': 10.0 * izz}), 'triangle_inequality')
    assert found.subjects == ('link2',)
    assert f'izz="{izz:.6g}" is physically possible' in found.advice


def test_rounding_is_a_note():
    # A flat plate is on the edge, and rounded digits go over it.
    text = changed(arm(), 'link5', tensor={'ixx': 0.02005, 'iyy': 0.01, 'izz': 0.01})
    [found] = findings(text, 'triangle_inequality')
    assert found.severity == 'note' and 'rounding' in found.advice


def test_a_link_on_the_base_is_a_note():
    [found] = findings(changed(arm(), 'base', tensor={'ixx': 5.0}), 'triangle_inequality')
    assert found.severity == 'note' and 'stands on the base' in found.effect


def test_several_links_are_one_finding():
    text = arm()
    for link in ('link1', 'link2', 'link3', 'link4'):
        text = changed(text, link, tensor={'izz': 9.0})
    [found] = findings(text, 'triangle_inequality')
    assert set(found.subjects) == {'link1', 'link2', 'link3', 'link4'}
    assert found.what.startswith('4 links have')


def test_what_is_not_positive_definite_is_refused_with_its_part_in_d():
    text = changed(arm(), 'link5', tensor={'ixx': -0.01})
    report = make_report(text, samples=300)
    [found] = [finding for finding in report.findings if finding.kind == 'impossible_inertia']
    assert report.verdict == 'refused' and found.severity == 'problem'
    assert '-0.01 kg m^2' in found.what and "joint 'joint5'" in found.effect
    [note] = findings(changed(arm(), 'base', tensor={'ixx': -0.01}), 'impossible_inertia')
    assert note.severity == 'note'


def test_moments_far_too_large_are_found_though_a_body_has_them():
    [found] = findings(scaled_tensor(arm(), 'link3', 1000.0), 'inertia_too_large')
    assert (found.severity, found.subjects) == ('warning', ('link3',))
    assert 'more inertia (D_jj)' in found.effect


def test_the_wrist_of_the_public_ur5_is_found():
    # 0.22 kg m^2 at 1.2 kg: a radius of gyration of 0.42 m in a link of 0.1 m.
    report = make_report(public_robot('ur_description/urdf/ur5_robot.urdf'), samples=300)
    [found] = [finding for finding in report.findings if finding.kind == 'inertia_too_large']
    # The first is longer, but has the very same tensor as the second.
    assert set(found.subjects) == {'wrist_1_link', 'wrist_2_link', 'wrist_3_link'}


def test_a_tensor_about_the_frame_is_found_where_products_tell():
    com, mass = np.array([0.1, 0.08, 0.05]), 2.0
    own = np.diag([0.004, 0.005, 0.006])
    about_frame = own + steiner(np.zeros((3, 3)), mass, com)
    names = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
    for tensor, count in ((about_frame, 1), (own, 0)):
        entries = dict(zip(names, tensor[np.triu_indices(3)].tolist(), strict=True))
        text = changed(arm(), 'link3', mass=mass, com=com.tolist(), tensor=entries)
        found = findings(text, 'tensor_not_about_com')
        assert len(found) == count
    text = changed(
        arm(),
        'link3',
        mass=mass,
        com=com.tolist(),
        tensor=dict(zip(names, about_frame[np.triu_indices(3)].tolist(), strict=True)),
    )
    [found] = findings(text, 'tensor_not_about_com')
    assert 'more inertia (D_jj) than with the tensor moved' in found.effect


def test_a_negative_multiple_of_the_identity_is_refused_with_a_finding():
    report = make_report(changed(arm(), 'link3', tensor=-0.01), samples=50)
    assert report.verdict == 'refused'
    assert [finding.kind for finding in report.findings] == ['impossible_inertia']


def test_an_excess_of_rounding_is_no_1_times():
    [found] = findings(
        changed(arm(), 'link3', tensor={'ixx': 0.01, 'iyy': 0.01, 'izz': 0.02008}),
        'triangle_inequality',
    )
    assert '0.4 % more than the sum of the two others' in found.what


def test_rounding_is_not_shown_as_a_moment():
    [found] = findings(
        changed(arm(), 'link3', tensor={'ixx': -1e-22, 'iyy': 0.02, 'izz': 8e-23}),
        'triangle_inequality',
    )
    assert 'the two others are 0 and 0' in found.what


def test_several_too_large_tensors_have_their_radii_in_one_finding():
    text = changed(changed(arm(), 'link3', tensor=2.0), 'link4', tensor=1.5)
    [found] = findings(text, 'inertia_too_large')
    assert 'as if its mass were 1 m from its center, in a link of 0.3 m' in found.what


@pytest.mark.parametrize('value', [1.0, 1e-6, 1e-9])
def test_a_placeholder_tensor_is_found(value):
    found = findings(changed(arm(), 'link3', tensor=value), 'placeholder_tensor')
    assert [finding.subjects for finding in found] == [('link3',)]
    assert found[0].severity == 'warning' and '(D_jj)' in found[0].effect


def test_no_tensor_at_all_is_a_note():
    [found] = findings(changed(arm(), 'link3', tensor=0.0), 'placeholder_tensor')
    assert found.severity == 'note' and 'no inertia' in found.what


def test_one_kilogram_and_a_tensor_of_1e_3_are_a_warning():
    # The tensor alone would be a likely one.
    text = changed(changed(arm(), 'link4', tensor=1e-3), 'link4', mass=1.0)
    [found] = findings(text, 'placeholder_tensor')
    assert found.severity == 'warning' and 'exactly 1 kg' in found.what


def test_several_masses_of_one_kilogram_have_the_effect_of_two_kilograms():
    text = changed(changed(arm(), 'link4', mass=1.0), 'link3', mass=1.0)
    [found] = findings(text, 'placeholder_mass')
    assert (found.severity, found.subjects) == ('note', ('link3', 'link4'))
    assert 'if each of them weighed 2 kg' in found.effect
    assert not findings(changed(arm(), 'link4', mass=1.0), 'placeholder_mass')


def test_one_inertial_copied_along_a_chain_is_found():
    text = arm(masses=(2.0,) * 5, lengths=(0.3, 0.2, 0.25, 0.15, 0.1))
    for link, length in (('link1', 0.3), ('link2', 0.2), ('link3', 0.25)):
        text = text.replace(rod(2.0, length), rod(2.0, 0.3))
        assert link in text
    [found] = findings(text, 'identical_inertials')
    assert found.subjects == ('link1', 'link2', 'link3')
    # Of the three the last matters most; the first turns about the vertical.
    assert "if 'link3' weighed twice as much" in found.effect


def test_equal_modules_are_no_copies():
    text = arm(masses=(2.0,) * 5, lengths=(0.3,) * 5)
    # The first is at another distance from the base, the others are equal parts.
    assert not findings(text.replace('xyz="0.1 0 0"', 'xyz="0.3 0 0"'), 'identical_inertials')


def test_a_heavy_link_balanced_on_its_joint_is_a_note():
    [found] = findings(changed(arm(), 'link2', com=[0.0, 0.0, 0.0]), 'com_at_joint')
    assert (found.severity, found.subjects) == ('note', ('link2',))
    assert "halfway to joint 'joint3'" in found.effect and '+' in found.effect
