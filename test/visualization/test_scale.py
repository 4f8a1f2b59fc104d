"""Sizes follow the robot's own."""

import dataclasses
import re

from dynamics_node import RobotModel
from dynamics_node.visualization.scale import ARC, arc_radii, make_scale, reach
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM, public_robot


def scaled(text, factor):
    """Return a URDF with all places times a factor; axes are directions and stay."""

    def place(match):
        numbers = ' '.join(f'{factor * float(x):.17g}' for x in match[2].split())
        return f'<origin{match[1]}xyz="{numbers}"'

    return re.sub(r'<origin([^>]*)xyz="([^"]*)"', place, text)


def without_travel(tree):
    """Return a tree without position limits: those of prismatic joints are lengths too."""
    limits = tree.limits.copy()
    limits[:, :2] = -np.inf, np.inf
    return dataclasses.replace(tree, limits=limits)


def test_the_reach_of_the_pendulum_is_its_length_to_the_center_of_mass():
    assert reach(RobotModel.from_urdf(PENDULUM).tree) == pytest.approx(0.35)


def test_the_reach_of_known_arms_is_about_what_their_makers_say():
    # 0.85 m from shoulder to wrist, and what is behind: offsets count in full.
    assert (
        1.0
        < reach(RobotModel.from_urdf(public_robot('ur_description/urdf/ur5_robot.urdf')).tree)
        < 1.6
    )
    assert (
        0.3
        < reach(RobotModel.from_urdf(public_robot('so_arm_description/urdf/so101.urdf')).tree)
        < 0.6
    )


@pytest.mark.parametrize('factor', [0.01, 7.0])
def test_a_robot_of_another_size_has_the_same_picture(factor):
    one, other = (
        make_scale(without_travel(RobotModel.from_urdf(text).tree))
        for text in (ARM7.read_text(), scaled(ARM7.read_text(), factor))
    )
    assert other.reach == pytest.approx(factor * one.reach)
    assert other.arcs == pytest.approx(factor * one.arcs)
    assert other.heaviest == one.heaviest


def test_rails_count():
    urdf = (
        '<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/><inertia '
        'ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" '
        'type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/><limit '
        'lower="-1" upper="2" effort="1" velocity="1"/></joint></robot>'
    )
    assert reach(RobotModel.from_urdf(urdf).tree) == pytest.approx(3.0)
    endless = (
        urdf.replace('lower="-1" upper="2"', '')
        .replace('prismatic', 'revolute')
        .replace('revolute', 'continuous')
    )
    assert reach(RobotModel.from_urdf(endless).tree) == 1.0  # without any length


def test_joints_near_each_other_have_smaller_arcs():
    tree = RobotModel.from_urdf(ARM7).tree
    longest = reach(tree)
    radii = arc_radii(tree, longest)
    assert (radii <= ARC * longest).all() and (radii >= 0.5 * ARC * longest - 1e-12).all()
    assert radii.min() < radii.max()
