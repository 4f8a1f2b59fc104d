"""The simulator's URDF reader, and the text it passes to MuJoCo."""

import math

from dynamics_node.demo.mujoco_model import mimic_map
from dynamics_node.demo.robot_text import movable_joints, mujoco_text, RobotRefusedError
import pytest


def robot(*joints):
    """Return a URDF text with these joint elements."""
    return '<robot name="r"><link name="a"/>' + ''.join(joints) + '</robot>'


def joint(name, kind='revolute', inner=''):
    """Return a joint element."""
    return f'<joint name="{name}" type="{kind}"><parent link="a"/><child link="b"/>{inner}</joint>'


def test_prefixes_that_nothing_declares_do_no_harm():
    text = robot(joint('z', inner='<limit drake:acceleration="2.5" effort="3"/>'), '<drake:x/>')
    [only] = movable_joints(text)
    assert only.effort == 3.0
    assert 'drake:acceleration="2.5"' in mujoco_text(text)


def test_joints_come_in_the_order_of_the_document():
    text = robot(
        joint('z'), joint('f', 'fixed'), joint('a', 'continuous'), joint('m', 'prismatic')
    )
    assert [j.name for j in movable_joints(text)] == ['z', 'a', 'm']
    assert [j.turns for j in movable_joints(text)] == [True, True, False]


def test_limits_and_damping_are_read():
    stated, bare, endless, empty = movable_joints(
        robot(
            joint(
                'a',
                inner='<limit lower="-1" upper="2" effort="3" velocity="4"/>'
                '<dynamics damping="5"/>',
            ),
            joint('b'),
            joint('c', 'continuous', '<limit lower="-1" upper="1" effort="7"/>'),
            joint('d', inner='<limit effort="1" velocity="1"/>'),
        )
    )
    assert (stated.lower, stated.upper, stated.effort, stated.velocity, stated.damping) == (
        -1,
        2,
        3,
        4,
        5,
    )
    assert (bare.lower, bare.upper, bare.effort) == (-math.inf, math.inf, 0)
    assert (empty.lower, empty.upper, empty.effort) == (-math.inf, math.inf, 1)
    assert (endless.lower, endless.upper, endless.effort) == (-math.inf, math.inf, 7)


def test_a_chain_of_mimic_joints_ends_at_the_driven_one():
    matrix, offset = mimic_map(
        movable_joints(
            robot(
                joint('c', inner='<mimic joint="b" multiplier="2" offset="1"/>'),
                joint('b', inner='<mimic joint="a" multiplier="3" offset="4"/>'),
                joint('a'),
            )
        )
    )
    assert matrix.tolist() == [[6], [3], [1]]
    assert offset.tolist() == [9, 4, 0]


@pytest.mark.parametrize(
    'text, sentence',
    [
        ('<robot', 'is not XML'),
        ('<sdf/>', 'expected a URDF with <robot> at its top, got <sdf>'),
        (robot(), 'no movable joint'),
        (robot(joint('f', 'floating')), "joint 'f' is floating"),
    ],
)
def test_what_cannot_be_simulated_is_refused_with_a_sentence(text, sentence):
    with pytest.raises(RobotRefusedError, match=sentence):
        movable_joints(text)


@pytest.mark.parametrize(
    'inner, sentence',
    [
        ('<mimic joint="b"/>', "mimics 'b', which is no movable joint"),
        ('<mimic joint="a"/>', "'a' mimics itself in a circle"),
    ],
)
def test_a_mimic_joint_without_an_end_is_refused(inner, sentence):
    with pytest.raises(RobotRefusedError, match=sentence):
        mimic_map(movable_joints(robot(joint('a', inner=inner))))


def test_mujoco_gets_no_meshes_collisions_or_mimic_tags():
    text = mujoco_text(
        '<robot name="r"><link name="a">'
        '<visual><geometry><mesh filename="package://x/y.dae"/></geometry></visual>'
        '<visual><geometry><box size="1 1 1"/></geometry></visual>'
        '<collision><geometry><sphere radius="1"/></geometry></collision></link>'
        + joint('j', inner='<mimic joint="k"/>')
        + '</robot>'
    )
    assert 'mesh' not in text and 'collision' not in text and 'mimic' not in text
    assert '<box' in text and 'inertiafromgeom="false"' in text
