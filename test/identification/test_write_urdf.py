"""Writing inertia and friction into a URDF: what changes, and what three readers make of it."""

import difflib
import re

from dynamics_node import RobotModel
from dynamics_node.errors import ArgumentError, RobotDescriptionError
from dynamics_node.identification.write_urdf import write_urdf
from dynamics_node.inertia import pseudo_inertia
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.mujoco_oracle import MujocoOracle
from support.pinocchio_oracle import PinocchioOracle
from support.robots import public_robot, random_state, random_urdf, ROBOTS

# Those with inertia that MuJoCo and Pinocchio both read, one of each kind of formatting.
PUBLIC = (
    'panda_description/urdf/panda.urdf',
    'ur_description/urdf/ur5_robot.urdf',
    'kinova_description/robots/kinova.urdf',
    'xarm_description/urdf/xarm7.urdf',
    'tiago_description/robots/tiago.urdf',
    'talos_data/robots/talos_full_v2.urdf',
    'z1_description/urdf/z1.urdf',
)
TEXTS = {
    **{name: public_robot(name).read_bytes() for name in PUBLIC},
    **{path.name: path.read_bytes() for path in sorted(ROBOTS.glob('*.urdf'))},
    **{f'random tree {seed}': random_urdf(seed).encode() for seed in range(20)},
}
NEW = pseudo_inertia(2.5, (0.01, -0.2, 0.3), np.diag((0.03, 0.02, 0.04)))

# Everything that a file may have around the numbers.
FILE = """<?xml version='1.0' encoding="utf-8"?>
<!-- <inertial> of <link name="arm"> in a comment -->
<robot name="r" xmlns:x="http://a/b">
    <link name="base"/>
    <link name='arm' >
        <!-- measured -->
        <inertial>
            <origin rpy="0.3 0 1"  xyz = "0  0 0.1" />
            <mass value='1.50'/> <!-- kg -->
            <inertia ixx="1e-2" ixy="0" ixz="0" iyy="0.010" iyz="0" izz="0.01"/>
        </inertial>
        <x:inertial><mass value="9"/></x:inertial>
    </link>
    <link name="a&amp;b &quot;é&quot;">
        <inertial>
            <mass value="1"/>
            <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
        </inertial>
    </link>
    <gazebo><link name="arm"><inertial/></link><![CDATA[<link name="arm"><inertial/>]]></gazebo>
    <joint type="revolute" name="j1">
        <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
        <dynamics friction="0.2"/>
    </joint>
    <joint type="revolute" name="j2">
        <parent link="arm"/>
        <child link="a&amp;b &quot;é&quot;"/>
        <axis xyz="0 1 0"/>
    </joint>
</robot>
"""
INERTIAL = re.compile('(?<=<inertial>).*?(?=</inertial>)', re.DOTALL)
ESCAPED = 'a&b "é"'


def changed_lines(before, after):
    """Return the removed and the added lines of a change, without their indentation."""
    removed, added = [], []
    for line in difflib.ndiff(before.splitlines(True), after.splitlines(True)):
        if line.startswith(('- ', '+ ')):
            (removed if line[0] == '-' else added).append(line[2:].strip())
    return removed, added


def own_inertia(text):
    """Return link → J of every link with an inertial."""
    return {
        link.name: link.inertial.pseudo_inertia
        for link in read_urdf(text).links
        if link.inertial is not None
    }


def other_inertia(text, seed=0):
    """Return link → another J of a real body, of every link with mass."""
    rng = np.random.default_rng(seed)
    result = {}
    for name, matrix in own_inertia(text).items():
        if matrix[3, 3] > 0.0:
            mass, size = matrix[3, 3] * rng.uniform(0.5, 2.0), rng.uniform(0.02, 0.2)
            cloud = rng.normal(size=(20, 3)) * size + rng.normal(size=3) * size
            points = np.column_stack([cloud, np.ones(20)])
            result[name] = mass / 20 * points.T @ points
    return result


def assert_same_inertia(actual, expected):
    """Compare J of links, relative to the size of each entry."""
    for name, matrix in expected.items():
        scale = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
        assert (np.abs(actual[name] - matrix) <= 1e-12 * scale).all(), name


@pytest.mark.parametrize('name', TEXTS)
def test_read_again_each_link_has_the_given_inertia(name):
    new = other_inertia(TEXTS[name])
    result = write_urdf(TEXTS[name], new)
    assert_same_inertia(own_inertia(result), new)
    assert write_urdf(result, new) == result


@pytest.mark.parametrize('name', TEXTS)
def test_the_inertia_that_a_urdf_has_changes_no_byte(name):
    text = TEXTS[name]
    friction = {joint.name: (joint.damping, joint.friction) for joint in read_urdf(text).joints}
    assert write_urdf(text, own_inertia(text), friction).encode() == text


@pytest.mark.parametrize('name', TEXTS)
def test_nothing_outside_of_inertial_elements_changes(name):
    before = TEXTS[name].decode()
    after = write_urdf(before, other_inertia(before))
    assert before != after
    for text in (before, after):
        assert text.count('<inertial>') == len(own_inertia(TEXTS[name]))
    outside = [INERTIAL.sub('', text) for text in (before, after)]
    assert outside[0] == outside[1]


@pytest.mark.parametrize('name', TEXTS)
@pytest.mark.parametrize('oracle', [PinocchioOracle, MujocoOracle])
def test_other_readers_compute_the_same_efforts(name, oracle):
    text = TEXTS[name].decode()
    new = other_inertia(text)
    result = write_urdf(text, new)
    model, judge = RobotModel.from_urdf(result), oracle(result)
    rng = np.random.default_rng(1)
    for _ in range(3):
        q, qd = random_state(rng, model)
        qdd = rng.normal(0.0, 3.0, q.size)
        expected = model.inverse_dynamics(q, qd, qdd)
        efforts = judge.inverse_dynamics(model.joint_names, q, qd, qdd)
        assert np.abs(efforts - expected).max() <= 1e-9 * np.abs(expected).max()


def test_only_numbers_that_differ_are_written():
    matrix = own_inertia(FILE)['arm']
    # Another mass at the same place, with the same tensor about the center of mass.
    heavier = pseudo_inertia(2.0, (0, 0, 0.1), np.eye(3) * 0.01)
    assert matrix[3, 3] == 1.5
    result = write_urdf(FILE, {'arm': heavier})
    assert result == FILE.replace("value='1.50'", "value='2.0'")


def test_the_place_keeps_the_numbers_and_blanks_that_are_equal():
    moved = pseudo_inertia(1.5, (0, 0, 0.12), np.eye(3) * 0.01)
    result = write_urdf(FILE, {'arm': moved})
    assert result == FILE.replace('xyz = "0  0 0.1"', 'xyz = "0  0 0.12"')


def test_the_inertial_frame_keeps_its_rotation():
    result = write_urdf(FILE, {'arm': NEW})
    assert '<origin rpy="0.3 0 1"  xyz = "0.01  -0.2 0.3" />' in result
    assert_same_inertia(own_inertia(result), {'arm': NEW})


def test_a_missing_origin_is_inserted():
    result = write_urdf(FILE, {ESCAPED: NEW})
    removed, added = changed_lines(FILE, result)
    assert removed[0] == '<mass value="1"/>'
    assert added[0] == '<origin xyz="0.01 -0.2 0.3" rpy="0 0 0"/>'
    assert '        <inertial>\n            <origin xyz' in result
    assert_same_inertia(own_inertia(result), {ESCAPED: NEW})


def test_an_origin_without_place_gets_one():
    text = FILE.replace('  xyz = "0  0 0.1"', '')
    result = write_urdf(text, {'arm': NEW})
    assert '<origin rpy="0.3 0 1" xyz="0.01 -0.2 0.3" />' in result
    assert_same_inertia(own_inertia(result), {'arm': NEW})


def test_a_missing_origin_at_the_center_of_mass_stays_missing():
    centered = pseudo_inertia(1.0, np.zeros(3), np.eye(3) * 0.2)
    assert '<origin' not in write_urdf(FILE, {ESCAPED: centered}).partition('a&amp;b')[2]


def test_a_link_that_closes_itself_is_opened():
    # Numbers that binary fractions hold exactly.
    matrix = pseudo_inertia(2.0, (0.5, 0.0, -0.25), np.diag((0.25, 0.5, 0.375)))
    result = write_urdf(FILE, {'base': matrix})
    before, after = FILE.split('    <link name="base"/>\n')
    assert result.startswith(before)
    assert result.endswith(after)
    assert result[len(before) : -len(after)].splitlines() == [
        '    <link name="base">',
        '        <inertial>',
        '            <origin xyz="0.5 0.0 -0.25" rpy="0 0 0"/>',
        '            <mass value="2.0"/>',
        '            <inertia ixx="0.25" ixy="0.0" ixz="0.0" iyy="0.5" iyz="0.0" izz="0.375"/>',
        '        </inertial>',
        '    </link>',
    ]


@pytest.mark.parametrize(
    'link',
    [
        '<link name="base" />',
        '<link name="base"></link>',
        '<link name="base">\n    </link>',
        '<link name="base"><visual/></link>',
        '<link name="base">  <!-- <inertial/> -->\n    </link>',
        '<link name="base"><inertial/></link>',
        '<link name="base">\n        <inertial />\n    </link>',
        '<link name="base"><inertial></inertial></link>',
    ],
)
def test_a_missing_inertial_is_inserted(link):
    text = FILE.replace('<link name="base"/>', link)
    result = write_urdf(text, {'base': NEW})
    assert_same_inertia(own_inertia(result), {'base': NEW})
    assert write_urdf(result, {'base': NEW}) == result


def test_a_link_without_mass_keeps_the_place_of_its_frame():
    text = FILE.replace("value='1.50'", "value='0'")
    assert write_urdf(text, own_inertia(text)) == text


def test_no_inertial_is_inserted_for_nothing():
    assert write_urdf(FILE, {'base': np.zeros((4, 4))}) == FILE


def test_a_text_in_one_line_stays_in_one_line():
    text = (
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>'
    )
    result = write_urdf(text, {'b': NEW}, {'j': (0.5, 0.0)})
    assert '\n' not in result
    assert '<axis xyz="0 0 1"/><dynamics damping="0.5" friction="0.0"/></joint>' in result
    assert_same_inertia(own_inertia(result), {'b': NEW})


def test_line_breaks_of_windows_stay():
    text = FILE.replace('\n', '\r\n')
    changes = ({'base': NEW, 'arm': NEW, ESCAPED: NEW}, {'j1': (0.5, 0.1), 'j2': (0.4, 0.0)})
    result = write_urdf(text, *changes)
    assert result.replace('\r\n', '') == result.replace('\r\n', '').replace('\n', '')
    assert result == write_urdf(FILE, *changes).replace('\n', '\r\n')


def test_a_byte_order_mark_and_text_of_bytes_stay():
    text = '\ufeff' + FILE
    assert write_urdf(text.encode(), {'arm': NEW}) == '\ufeff' + write_urdf(FILE, {'arm': NEW})


def test_tabs_are_taken_over():
    text = FILE.replace('    ', '\t')
    result = write_urdf(text, {'base': NEW}, {'j2': (1.0, 2.0)})
    assert '\n\t<link name="base">\n\t\t<inertial>\n\t\t\t<origin' in result
    assert '\n\t\t<dynamics damping="1.0" friction="2.0"/>\n\t</joint>' in result


def test_friction_changes_the_dynamics_of_the_joint():
    result = write_urdf(FILE, {}, {'j1': (0.5, 0.25)})
    assert result == FILE.replace('friction="0.2"', 'friction="0.25" damping="0.5"')
    assert write_urdf(FILE, {}, {'j1': (0.0, 0.2), 'j2': (0.0, 0.0)}) == FILE


def test_missing_dynamics_are_inserted_behind_the_other_elements():
    result = write_urdf(FILE, {}, {'j2': (0.5, 0.25)})
    assert changed_lines(FILE, result) == ([], ['<dynamics damping="0.5" friction="0.25"/>'])
    assert '        <axis xyz="0 1 0"/>\n        <dynamics damping' in result
    joint = read_urdf(result).joints[1]
    assert (joint.damping, joint.friction) == (0.5, 0.25)


def test_dynamics_without_attributes_get_both_in_order():
    text = FILE.replace('<dynamics friction="0.2"/>', '<dynamics/>')
    result = write_urdf(text, {}, {'j1': (0.5, 0.25)})
    assert '<dynamics damping="0.5" friction="0.25"/>' in result


def test_numbers_are_written_exactly():
    third = 1.0 / 3.0
    result = write_urdf(FILE, {}, {'j1': (third, 1e-7), 'j2': (2.0 / 3.0, 0.1 + 0.2)})
    joints = read_urdf(result).joints
    assert (joints[0].damping, joints[0].friction) == (third, 1e-7)
    assert (joints[1].damping, joints[1].friction) == (2.0 / 3.0, 0.1 + 0.2)


def test_a_number_written_as_a_reference_is_replaced_as_a_whole():
    text = FILE.replace('"0  0 0.1"', '"&#48;&#32;0 0.1"')
    assert write_urdf(text, own_inertia(text)) == text
    result = write_urdf(text, {'arm': NEW})
    assert 'xyz = "0.01 -0.2 0.3"' in result


@pytest.mark.parametrize(
    'inertia, friction, message',
    [
        ({'armm': NEW}, {}, "expected links of the URDF, got 'armm', is 'arm' meant?"),
        ({}, {'j3': (1, 1), 'j1': (1, 1)}, "expected joints of the URDF, got 'j3'"),
        ({'arm': np.eye(3)}, {}, "link 'arm': expected a pseudo-inertia of shape (4, 4)"),
        ({'arm': NEW * np.nan}, {}, "link 'arm': expected a pseudo-inertia of shape (4, 4), fin"),
        ({'arm': NEW + np.eye(4)[[1, 0, 3, 2]] @ np.diag((1, 0, 0, 0))}, {}, 'symmetric'),
        ({}, {'j1': (-0.1, 0.0)}, "joint 'j1': expected damping and friction, finite and >= 0"),
        ({}, {'j1': (0.1, np.inf)}, "joint 'j1': expected damping and friction, finite"),
    ],
)
def test_wrong_arguments_are_refused(inertia, friction, message):
    with pytest.raises(ArgumentError) as caught:
        write_urdf(FILE, inertia, friction)
    assert message in str(caught.value)


def test_what_would_not_be_read_again_is_refused():
    with pytest.raises(RobotDescriptionError, match="link 'arm': mass is -2"):
        write_urdf(FILE, {'arm': -NEW})
    with pytest.raises(RobotDescriptionError, match='DOCTYPE'):
        write_urdf('<!DOCTYPE robot><robot name="r"><link name="a"/></robot>', {'a': NEW})
