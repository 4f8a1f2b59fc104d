"""Best-effort reading of defective URDFs."""

from dynamics_node import RobotDescriptionError
from dynamics_node.urdf import examine_urdf, read_urdf
import pytest
from support.arms import arm, changed
from support.robots import ARM7


def test_a_correct_robot_is_read_whole():
    result = examine_urdf(ARM7)
    assert result.is_whole and not result.problems and not result.unread
    described, expected = result.description, read_urdf(ARM7)
    assert [link.name for link in described.links] == [link.name for link in expected.links]
    assert (described.root, described.warnings) == (expected.root, expected.warnings)


@pytest.mark.parametrize(
    'text, links, joints, unread',
    [
        (arm().replace('mass value="2.5"', 'mass value="x"'), 7, 6, {'link2'}),
        (arm().replace('revolute', 'spherical', 1), 7, 5, set()),
        (arm().replace('<child link="link5"/>', '<child link="missing"/>'), 7, 5, set()),
        (arm().replace('<link name="link5">', '<link name="link4">'), 6, 4, set()),
        (arm().replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0"/>'), 7, 5, set()),
    ],
)
def test_readable_parts_are_kept(text, links, joints, unread):
    result = examine_urdf(text)
    with pytest.raises(RobotDescriptionError) as caught:
        read_urdf(text)
    assert result.problems == caught.value.problems and not result.is_whole
    assert len(result.description.links) == links and len(result.description.joints) == joints
    assert result.unread == unread and result.description.root == ''


def test_a_robot_with_wrong_numbers_is_still_whole():
    result = examine_urdf(changed(arm(), 'link3', mass=-2.0))
    assert result.is_whole and len(result.problems) == 1 and result.description.root == 'base'


def test_stated_values_are_kept_beside_the_used_ones():
    text = changed(
        arm(), 'joint2', axis=False, limit={'lower': 1, 'upper': -1, 'effort': 0, 'velocity': None}
    )
    joint = examine_urdf(text).description.joints[1]
    assert (joint.stated.lower, joint.stated.upper, joint.stated.effort) == (1.0, -1.0, 0.0)
    assert joint.stated.velocity != joint.stated.velocity and not joint.stated.has_axis
    assert joint.effort != joint.effort and joint.lower == -float('inf')


def test_shapes_are_reduced_to_flags():
    by_name = {
        link.name: link
        for link in examine_urdf(arm().replace('visual', 'collision', 2)).description.links
    }
    assert by_name['base'].has_shape and not by_name['base'].has_visual
    assert by_name['link1'].has_shape and by_name['link1'].has_visual
