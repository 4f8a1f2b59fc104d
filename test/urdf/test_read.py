"""Reading a URDF: accepted and refused descriptions, and the names in every problem."""

from pathlib import Path
import subprocess
import sys

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.robots import random_urdf

INERTIAL = (
    '<inertial><origin xyz="0 0 0.1" rpy="0 0 0"/><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
)


def two_links(joint='<axis xyz="0 0 1"/>', kind='revolute', inertial=INERTIAL, more=''):
    """Return a robot with one joint; parts can be replaced."""
    return (
        f'<robot name="r"><link name="a"/><link name="b">{inertial}</link>'
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{joint}</joint>'
        f'{more}</robot>'
    )


def problems(text):
    """Return the problems for which a description is refused."""
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(text)
    for problem in caught.value.problems:
        assert problem in str(caught.value)
    return caught.value.problems


def test_values_are_returned_as_plain_data():
    robot = read_urdf(
        two_links(
            '<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="2" effort="30" velocity="4"/>'
            '<dynamics damping="0.5" friction="0.1"/>'
        )
    )
    joint, link = robot.joints[0], robot.links[1]
    assert (robot.name, robot.root, joint.kind) == ('r', 'a', 'revolute')
    assert (joint.lower, joint.upper, joint.effort, joint.velocity) == (-1, 2, 30, 4)
    assert (joint.damping, joint.friction) == (0.5, 0.1)
    np.testing.assert_allclose(
        joint.placement, [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-15
    )
    assert link.inertial.mass == 1.0
    np.testing.assert_array_equal(link.inertial.placement[:3, 3], [0, 0, 0.1])
    assert robot.links[0].inertial is None
    assert robot.warnings == ()


def test_meshes_are_never_opened(tmp_path):
    mesh = (
        '<visual><geometry><mesh filename="{}"/></geometry></visual>'
        '<collision><geometry><mesh filename="{}"/></geometry></collision>'
    )
    for address in (
        'package://nowhere/a.stl',
        'file:///dev/zero',
        'http://localhost:1/a.dae',
        '../../a.stl',
        str(tmp_path),
    ):
        text = two_links(inertial=INERTIAL + mesh.format(address, address))
        assert read_urdf(text).links[1].inertial.mass == 1.0


def test_no_address_opens_a_file_or_socket():
    # In a separate process, because an audit hook cannot be removed. The first read loads
    # modules; the second one is audited.
    mesh = '<mesh filename="{}"/>'
    parts = ''.join(
        f'<visual><geometry>{mesh.format(address)}</geometry></visual><collision><geometry>'
        f'{mesh.format(address)}</geometry></collision><material name="{i}"><texture '
        f'filename="{address}"/></material>'
        for i, address in enumerate(
            (
                'file:///etc/hostname',
                '/etc/hostname',
                '../a.stl',
                'package://a/b.dae',
                'http://localhost:1/a.dae',
                'ftp://localhost/a.obj',
            )
        )
    )
    text = two_links(inertial=INERTIAL + parts, more=parts).encode()
    run = subprocess.run(
        [
            sys.executable,
            '-c',
            (
                'from dynamics_node.urdf import read_urdf\n'
                'from fuzz.audit import nothing_opened\n'
                f'text = {text!r}\n'
                'read_urdf(text)\n'
                'with nothing_opened():\n'
                '    assert read_urdf(text).links[1].inertial.mass == 1.0\n'
            ),
        ],
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2] / 'tools',
        check=False,
    )
    assert run.returncode == 0, run.stderr


def test_the_first_robot_loads_yourdfpy_without_output():
    run = subprocess.run(
        [
            sys.executable,
            '-W',
            'default',
            '-c',
            'import logging, sys\n'
            'logging.basicConfig(level=logging.DEBUG)\n'
            'from dynamics_node.urdf import read_urdf\n'
            'assert "yourdfpy" not in sys.modules and "trimesh" not in sys.modules\n'
            f'read_urdf({random_urdf(1)!r})\n'
            'assert "yourdfpy" in sys.modules\n',
        ],
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2],
        check=False,
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, '', '')


def test_a_link_has_one_read_only_pseudo_inertia():
    inertial = read_urdf(two_links()).links[1].inertial
    matrix = inertial.pseudo_inertia
    assert matrix is inertial.pseudo_inertia and not matrix.flags.writeable
    np.testing.assert_allclose(matrix[:3, 3], [0, 0, 0.1])


def test_other_elements_are_ignored():
    assert read_urdf(
        two_links(
            more='<gazebo><x y="z"/></gazebo><transmission/>'
            '<material name="m"/><ros2_control><joint name="q"/>'
            '</ros2_control><!-- a comment -->'
        )
    )


def test_other_name_spaces_are_removed_before_yourdfpy(caplog):
    # With an xml:id that is no name, lxml (of yourdfpy) would log an error and parse again.
    text = two_links(
        '<axis xyz="0 0 1" xml:id="1 2"/><x:axis xmlns:x="a b" xyz="1 0 0"/>',
        inertial=INERTIAL.replace('<mass', '<mass xml:id="3 4"') + '<visual xml:id="5 6"/>',
    )
    np.testing.assert_array_equal(read_urdf(text).joints[0].axis, [0, 0, 1])
    assert caplog.text == ''


@pytest.mark.parametrize(
    'text, message',
    [
        ('', 'it is empty'),
        ('   \n ', 'it is empty'),
        (b'', 'it is empty'),
        (b' \n', 'it is empty'),
        ('<robot><link', 'it is not XML: .*line 1'),
        ('<robot>\n<link>\n</robot>', 'it is not XML: mismatched tag, line 3'),
        ('<html/>', 'root element is <html>, expected <robot>'),
        ('<!DOCTYPE robot [<!ENTITY a "b">]><robot name="r"/>', 'it has a DOCTYPE'),
        ('<robot name="r">' + '<a>' * 40 + '</a>' * 40 + '</robot>', 'nested more than 32 deep'),
        (
            '<robot name="r">' + ''.join(f'<link name="{i}"/>' for i in range(1001)) + '</robot>',
            'more than 1000 links',
        ),
        ('<robot name="r">' + ' ' * 5_000_001 + '</robot>', 'at most 5000000 are accepted'),
        (b'<robot name="\xff"/>', 'it is not UTF-8 text: byte 13'),
        ('<?xml version="1.0" encoding="utf-16"?><robot name="r"/>', "its encoding is 'utf-16'"),
        ('<robot name="\ud800"/>', 'it is not UTF-8'),
        ('<robot name="r"/>', 'it has no <link>'),
        ('<robot name="r">&undefined;</robot>', 'it is not XML: undefined entity'),
    ],
)
def test_unreadable_text_is_refused_before_yourdfpy(text, message):
    with pytest.raises(RobotDescriptionError, match=message):
        read_urdf(text)


@pytest.mark.parametrize('value', ['nan', 'inf', '-inf', '1_0', '0x1', '1e999', 'one', '', '1,5'])
@pytest.mark.parametrize('place', ['mass', 'ixx', 'xyz', 'axis', 'limit', 'damping'])
def test_only_finite_decimal_numbers_are_numbers(place, value):
    joint, inertial = '<axis xyz="0 0 1"/>', INERTIAL
    if place == 'mass':
        inertial = INERTIAL.replace('value="1"', f'value="{value}"')
    elif place == 'ixx':
        inertial = INERTIAL.replace('ixx="1"', f'ixx="{value}"')
    elif place == 'xyz':
        joint += f'<origin xyz="0 0 {value}"/>'
    elif place == 'axis':
        joint = f'<axis xyz="{value} 0 1"/>'
    elif place == 'limit':
        joint += f'<limit lower="{value}" upper="1"/>'
    else:
        joint += f'<dynamics damping="{value}"/>'
    [problem] = problems(two_links(joint, inertial=inertial))
    assert "'b'" in problem if place in ('mass', 'ixx') else "'j'" in problem
    assert 'expected' in problem
    assert 'got' in problem


@pytest.mark.parametrize('attribute', ['value', 'ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz'])
def test_an_attribute_that_is_missing_is_named(attribute):
    [problem] = problems(two_links(inertial=INERTIAL.replace(f' {attribute}=', ' other=')))
    tag = 'mass' if attribute == 'value' else 'inertia'
    assert problem == f"link 'b': <{tag}> {attribute} is missing"
    [problem] = problems(two_links('<axis/>'))
    assert problem == "joint 'j': <axis> xyz is missing"


@pytest.mark.parametrize('value', ['1', '-0.5', '+2.', '.5', '1e-3', ' 7 ', '1E+2'])
def test_usual_notations_of_numbers_are_accepted(value):
    robot = read_urdf(two_links(inertial=INERTIAL.replace('0 0 0.1', f'0 0 {value}')))
    assert robot.links[1].inertial.placement[2, 3] == float(value)


def test_all_problems_are_listed_at_once():
    listed = problems(
        '<robot name="r"><link name="a"/><link name="a"/><link/>'
        '<link name="b"><inertial><mass value="x"/></inertial></link>'
        '<joint name="j" type="floating"><parent link="a"/><child link="nowhere"/></joint>'
        '<joint name="k" type="spherical"><child link="b"/></joint></robot>'
    )
    for text in (
        "link 'a' is defined 2 times",
        'a <link> has no name',
        "joint 'j': type floating is not supported",
        "child link 'nowhere' does not",
        "joint 'k': type 'spherical' is unknown",
        '<parent link="..."/> is missing',
        "link 'b': <mass> value: expected a finite number, got 'x'",
        "link 'b': <inertial> has no <inertia>",
    ):
        assert any(text in problem for problem in listed), text


@pytest.mark.parametrize('kind', ['floating', 'planar'])
def test_joints_with_several_axes_are_refused_by_name(kind):
    [problem] = problems(two_links(kind=kind))
    assert problem == (
        f"joint 'j': type {kind} is not supported; use one of revolute, "
        'continuous, prismatic, fixed'
    )


def link_pairs(*pairs):
    """Return a robot with fixed joints between named links."""
    names = dict.fromkeys(name for pair in pairs for name in pair)
    return (
        '<robot name="r">'
        + ''.join(f'<link name="{name}"/>' for name in names)
        + ''.join(
            f'<joint name="j{i}" type="fixed"><parent link="{a}"/><child link="{b}"/></joint>'
            for i, (a, b) in enumerate(pairs)
        )
        + '</robot>'
    )


@pytest.mark.parametrize(
    'text, message',
    [
        (link_pairs(('a', 'b'), ('c', 'd')), "it has 2 root links, must be one: 'a', 'c'"),
        (link_pairs(('a', 'b'), ('b', 'c'), ('c', 'a')), "form a cycle: 'b' -> 'a' -> 'c' -> 'b'"),
        (link_pairs(('a', 'c'), ('b', 'c')), "link 'c' is the child of 2 joints"),
        (link_pairs(('r', 'x'), ('a', 'b'), ('b', 'a')), 'form a cycle'),
    ],
)
def test_links_that_are_not_one_tree_are_refused(text, message):
    assert any(message in problem for problem in problems(text))


def mimics(**leaders):
    """Return a chain of joints that mimic others."""
    parts = ['<link name="base"/>']
    for i, (name, leader) in enumerate(leaders.items()):
        parent = 'base' if i == 0 else f'link{i - 1}'
        mimic = f'<mimic joint="{leader}" multiplier="2"/>' if leader else ''
        parts.append(
            f'<link name="link{i}"/><joint name="{name}" type="revolute">'
            f'<parent link="{parent}"/><child link="link{i}"/>{mimic}</joint>'
        )
    return '<robot name="r">' + ''.join(parts) + '</robot>'


@pytest.mark.parametrize(
    'text, message',
    [
        (mimics(j='', k='elbow'), "joint 'k': mimics 'elbow', which is not a movable joint"),
        (mimics(j='k', k='j'), "mimic joints form a cycle: 'j' -> 'k' -> 'j'"),
        (mimics(j='j'), "mimic joints form a cycle: 'j' -> 'j'"),
    ],
)
def test_mimic_joints_must_end_at_a_movable_joint(text, message):
    assert message in problems(text)


def test_mimic_of_mimic_is_read():
    joints = read_urdf(mimics(j='', k='j', m='k')).joints
    assert [joint.mimic and joint.mimic.leader for joint in joints] == [None, 'j', 'k']
    assert joints[1].mimic.multiplier == 2.0


def test_axis_is_normalized_or_defaulted_with_a_warning_and_never_zero():
    robot = read_urdf(two_links('<axis xyz="0 3 4"/>'))
    np.testing.assert_allclose(robot.joints[0].axis, [0, 0.6, 0.8])
    assert robot.warnings == ("joint 'j': axis has length 5, it is normalized to 1",)
    robot = read_urdf(two_links(''))
    np.testing.assert_array_equal(robot.joints[0].axis, [1, 0, 0])
    assert robot.warnings == ("joint 'j': axis is missing, (1, 0, 0) is used",)
    [problem] = problems(two_links('<axis xyz="0 0 0"/>'))
    assert problem == "joint 'j': axis has length 0, must be a direction"


def with_diagonal(ixx, iyy, izz, mass=1.0):
    """Return a robot with the given principal moments of its moving link."""
    return two_links(
        inertial=(
            f'<inertial><mass value="{mass}"/><inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{iyy}" '
            f'iyz="0" izz="{izz}"/></inertial>'
        )
    )


def test_impossible_inertia_is_refused_and_suspicious_inertia_is_warned_about():
    [problem] = problems(with_diagonal(-0.1, 1, 1))
    assert problem == (
        "link 'b': inertia is not physical: smallest principal moment of inertia "
        'is -0.1 kg m^2, must be >= 0'
    )
    [problem] = problems(with_diagonal(1, 1, 1, mass=-2))
    assert problem == "link 'b': mass is -2 kg, must be >= 0"
    [warning] = read_urdf(with_diagonal(3, 1, 1)).warnings
    assert 'violate the triangle inequality: 3 > 1 + 1' in warning


def test_rounding_of_a_point_mass_is_not_an_impossible_inertia():
    # As in the URDF of iCub: -5.4e-20 kg m² on a link of half a kilogram.
    assert read_urdf(with_diagonal(-5.42101e-20, 0, 0, mass=0.526)).warnings == ()
    # Beyond rounding.
    [problem] = problems(with_diagonal(-1e-13, 1, 1))
    assert 'smallest principal moment of inertia is -1e-13' in problem


def test_impossible_inertia_that_no_joint_moves_is_only_suspicious():
    text = with_diagonal(-0.1, 1, 1).replace('revolute', 'fixed')
    [warning] = read_urdf(text).warnings
    assert 'smallest principal moment' in warning


@pytest.mark.parametrize(
    'limit',
    ['', '<limit/>', '<limit effort="0" velocity="-1"/>', '<limit effort="inf" velocity="nan"/>'],
)
def test_unknown_effort_and_velocity_limits_are_nan(limit):
    joint = read_urdf(two_links('<axis xyz="0 0 1"/>' + limit, kind='continuous')).joints[0]
    assert np.isnan([joint.effort, joint.velocity]).all()
    assert (joint.lower, joint.upper) == (-np.inf, np.inf)


def test_a_source_of_another_type_is_refused():
    with pytest.raises(RobotDescriptionError, match='expected URDF text or a path, got int'):
        read_urdf(7)


def test_a_path_may_contain_spaces(tmp_path):
    path = tmp_path / 'my robot.urdf'
    path.write_text(random_urdf(1))
    assert read_urdf(path).name == read_urdf(str(path)).name == 'random'
    with pytest.raises(RobotDescriptionError, match=r'cannot read .*directory'):
        read_urdf(str(tmp_path))


def test_xacro_is_refused():
    [problem] = problems(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="a"/><link name="a"/></robot>'
    )
    assert 'contains xacro elements: expand it first' in problem
    [problem] = problems('<robot name="r"><xacro:include filename="a"/><link name="a"/></robot>')
    assert 'contains xacro elements: expand it first' in problem
    [problem] = problems(
        '<robot name="r" xmlns:x="http://www.ros.org/wiki/xacro">'
        '<link name="a"><x:if value="1"/></link></robot>'
    )
    assert 'contains xacro elements: expand it first' in problem
    [problem] = problems(two_links('<axis xyz="0 0 1"/><limit effort="${e}" velocity="1"/>'))
    assert problem == (
        "joint 'j': <limit> effort: expected a number, got '${e}'; a xacro file "
        'must be expanded first'
    )
    [problem] = problems(two_links('<axis xyz="0 $(arg y) 1"/>'))
    assert problem.endswith("got '0 $(arg y) 1'; a xacro file must be expanded first")


@pytest.mark.parametrize(
    'attribute',
    [
        'drake:acceleration="2.5"',
        'a:b:c="${x}"',
        ':="1"',
        'drake:effort="nan" drake:lower="9"',
        'xmlns:xacro="x"',
        'xml:effort="7"',
    ],
)
@pytest.mark.parametrize(
    'element',
    [
        '',
        '<drake:collision_filter_group name="g"><drake:member '
        'link="a"/></drake:collision_filter_group>',
        '<drake:link name="a"/><drake:joint/>',
        '<:/>',
    ],
)
def test_undeclared_prefixes_are_ignored_as_by_urdfdom(attribute, element):
    limit = '<limit lower="-1" upper="2" effort="30" velocity="2"/>'
    plain = two_links('<axis xyz="0 0 1"/>' + limit)
    text = plain.replace('<limit', f'<limit {attribute}').replace('</robot>', f'{element}</robot>')
    assert text.count(attribute) == 1
    read, expected = read_urdf(text), read_urdf(plain)
    assert [link.name for link in read.links] == [link.name for link in expected.links]
    [joint] = read.joints
    assert (joint.lower, joint.upper, joint.effort, joint.velocity) == (-1.0, 2.0, 30.0, 2.0)
    assert read.warnings == expected.warnings


def test_a_default_name_space_does_not_hide_the_robot():
    text = two_links('<axis xyz="0 0 1"/>').replace('<robot', '<robot xmlns="http://a/b"')
    assert len(read_urdf(text).joints) == 1


@pytest.mark.parametrize(
    'text',
    [
        '<robot name="r"><a:b></b:a><link name="a"/></robot>',
        '<robot name="r" a:b="1" a:b="2"/>',
        '<robot name="r"><link name="a" drake:x=1/></robot>',
        '<a:robot name="r"/>',
        '<robot name="r"><link name="a"/><a:b>' + '<c:d>' * 40 + '</c:d>' * 40 + '</a:b></robot>',
        '<robot name="r"><link name="a" b:c="&d;"/></robot>',
        '<!DOCTYPE r [<!ATTLIST link a:b CDATA "1">]><robot name="r"><link name="a"/></robot>',
    ],
)
def test_invalid_or_deep_xml_with_prefixes_is_refused(text):
    assert len(problems(text)) == 1


def test_an_axis_too_long_to_normalize_is_refused():
    [problem] = problems(two_links('<axis xyz="1e308 1e308 1"/>'))
    assert problem.startswith("joint 'j': axis has length")
