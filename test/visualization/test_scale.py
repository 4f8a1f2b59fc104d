"""Sizes of shapes are proportional to the robot."""

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


# UR5: 0.85 m from shoulder to wrist; offsets count in full.
@pytest.mark.parametrize(
    ('name', 'low', 'high'),
    [
        ('ur_description/urdf/ur5_robot.urdf', 1.0, 1.6),
        ('so_arm_description/urdf/so101.urdf', 0.3, 0.6),
    ],
)
def test_the_reach_of_known_arms_is_about_that_of_their_data_sheets(name, low, high):
    path = public_robot(name)
    assert low < reach(RobotModel.from_urdf(path).tree) < high


@pytest.mark.parametrize('factor', [0.01, 7.0])
def test_a_robot_of_another_size_has_the_same_picture(factor):
    one, other = (
        make_scale(without_travel(RobotModel.from_urdf(text).tree))
        for text in (ARM7.read_text(), scaled(ARM7.read_text(), factor))
    )
    assert other.reach == pytest.approx(factor * one.reach)
    assert other.arcs == pytest.approx(factor * one.arcs)
    assert other.heaviest == one.heaviest


def test_the_reach_contains_the_travel_of_a_rail():
    urdf = (
        '<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/><inertia '
        'ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" '
        'type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/><limit '
        'lower="-1" upper="2" effort="1" velocity="1"/></joint></robot>'
    )
    assert reach(RobotModel.from_urdf(urdf).tree) == pytest.approx(3.0)
    endless = urdf.replace('lower="-1" upper="2"', '').replace('prismatic', 'continuous')
    assert reach(RobotModel.from_urdf(endless).tree) == 1.0  # without any length


def test_joints_near_each_other_have_smaller_arcs():
    tree = RobotModel.from_urdf(ARM7).tree
    longest = reach(tree)
    radii = arc_radii(tree, longest)
    assert (radii <= ARC * longest).all() and (radii >= 0.5 * ARC * longest - 1e-12).all()
    assert radii.min() < radii.max()
