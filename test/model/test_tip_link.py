"""The link at the end of an arm."""

from xml.etree import ElementTree

from dynamics_node.model import build_tree
from dynamics_node.urdf import read_urdf
import pytest
from support.arms import arm, pendulum
from support.robots import ARM7, public_robot


def end_of(source):
    """Return the link that carries a payload."""
    return build_tree(read_urdf(source)).tip_link


@pytest.mark.parametrize(
    'robot, link',
    [
        ('ur_description/urdf/ur5_robot.urdf', 'tool0'),
        ('ur_description/urdf/ur10_robot.urdf', 'tool0'),
        ('panda_description/urdf/panda.urdf', 'panda_hand_tcp'),
        ('xarm_description/urdf/xarm7.urdf', 'link_eef'),
        ('z1_description/urdf/z1.urdf', 'gripperStator'),
        ('kinova_description/robots/kinova.urdf', 'j2s6s200_end_effector'),
        ('tiago_description/robots/tiago_no_hand.urdf', 'wrist_ft_tool_link'),
        ('baxter_description/urdf/baxter.urdf', 'right_gripper'),
        ('pr2_description/urdf/pr2.urdf', 'r_gripper_tool_frame'),
        ('talos_data/robots/talos_full_v2.urdf', 'gripper_left_base_link'),
        ('tiago_pro_description/robots/tiago_pro.urdf', 'gripper_left_base_link'),
        ('romeo_description/urdf/romeo_small.urdf', 'l_gripper'),
        ('anymal_b_simple_description/robots/anymal-kinova.urdf', 'j2s6s200_end_effector'),
        ('so_arm_description/urdf/so101.urdf', 'gripper_frame_link'),
        ('alex_description/urdf/alex_nub_hands.urdf', 'LeftGripperYawLink'),
        ('alex_description/urdf/alex_sake_hands.urdf', 'LeftSakePalmLink'),
        ('g1_description/urdf/g1_29dof_with_hand_rev_1_0.urdf', 'left_hand_palm_link'),
        ('talos_data/robots/talos_left_arm.urdf', 'gripper_left_inner_single_link'),
    ],
)
def test_the_tip_of_public_arms_is_the_tool_and_no_finger(robot, link):
    assert end_of(public_robot(robot)) == link


def test_the_tip_of_the_arms_in_this_repository():
    assert end_of(ARM7) == 'tool_center'
    assert end_of(arm()) == 'gripper'
    assert end_of(pendulum()) == 'rod'


def test_the_tip_without_movable_joints_is_the_root():
    assert end_of('<robot name="a"><link name="stone"/></robot>') == 'stone'


def test_a_camera_on_the_hand_is_no_tool():
    camera = (
        '<link name="camera"/><joint name="c" type="fixed"><parent link="gripper"/>'
        '<child link="camera"/></joint></robot>'
    )
    assert end_of(arm().replace('</robot>', camera)) == 'gripper'


def test_an_arm_without_masses_ends_before_its_fingers():
    robot = ElementTree.fromstring(public_robot('panda_description/urdf/panda.urdf').read_text())
    for link in robot.findall('link'):
        for inertial in link.findall('inertial'):
            link.remove(inertial)
    assert end_of(ElementTree.tostring(robot, encoding='unicode')) == 'panda_hand_tcp'


def test_a_wrist_with_fixed_fingers_is_no_finger():
    robot = ElementTree.fromstring(public_robot('panda_description/urdf/panda.urdf').read_text())
    for joint in robot.findall('joint'):
        if 'finger' in joint.get('name'):
            joint.set('type', 'fixed')
    assert end_of(ElementTree.tostring(robot, encoding='unicode')) == 'panda_hand_tcp'
