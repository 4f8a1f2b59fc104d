"""What the 3D view is told of the robot: shapes that have the inertia of the bodies."""

import json

from dynamics_node import RobotModel
from dynamics_node.report.html.scene import BALL_DENSITY, ball_radius, ellipsoid, scene
import numpy as np
import pytest
from support.robots import ARM7, random_urdf


@pytest.mark.parametrize('seed', range(5))
def test_the_ellipsoid_has_the_second_moments_of_the_body(seed):
    for J in RobotModel.from_urdf(random_urdf(seed)).tree.inertia:
        mass = J[3, 3]
        axes, com = ellipsoid(J), J[:3, 3] / mass
        # Of a solid ellipsoid: m a aᵀ / 5, summed over its semi-axes.
        found = mass / 5.0 * axes @ axes.T + mass * np.outer(com, com)
        np.testing.assert_allclose(found, J[:3, :3], rtol=1e-9, atol=1e-12 * np.trace(J))


def test_the_ellipsoid_of_a_known_solid_is_itself():
    J = np.diag([5.0 * 0.1**2 / 5.0, 5.0 * 0.2**2 / 5.0, 5.0 * 0.3**2 / 5.0, 5.0])
    np.testing.assert_allclose(np.abs(ellipsoid(J)), np.diag([0.1, 0.2, 0.3]), atol=1e-12)


def test_without_mass_there_is_no_shape():
    assert not ellipsoid(np.zeros((4, 4))).any() and ball_radius(0.0) == 0.0


def test_a_ball_weighs_what_its_body_weighs():
    volume = 4.0 / 3.0 * np.pi * ball_radius(2.5) ** 3
    assert volume * BALL_DENSITY == pytest.approx(2.5)


def test_the_scene_is_plain_data_of_the_model():
    model = RobotModel.from_urdf(ARM7)
    told = json.loads(json.dumps(scene(model), allow_nan=False))
    assert told['joints'] == list(model.joint_names)
    assert sum(told['mass']) == pytest.approx(model.moving_mass)
    assert len(told['body']) == len(model.tree.moving_joint_names) == len(told['placement'])
    assert told['prismatic'] == [name.endswith('slide') for name in model.joint_names]
    assert told['limit'] == model.effort_limits.tolist()
    assert np.all(np.array(told['lower']) <= told['neutral'])
    assert np.all(np.array(told['upper']) >= told['neutral'])


def test_a_slider_has_ends_where_the_joint_has_none():
    text = ARM7.read_text()
    model = RobotModel.from_urdf(text.replace('upper="2.1"', 'upper="1e16"'))
    assert (model.position_limits == 1e16).any()
    told = scene(model)
    limits, neutral = model.position_limits, model.neutral_position
    for place, (lower, upper) in enumerate(zip(told['lower'], told['upper'], strict=True)):
        assert lower == limits[place, 0]
        far = limits[place, 1] == 1e16
        assert upper == (neutral[place] + np.pi if far else limits[place, 1])


def test_a_stick_goes_to_every_body_and_from_the_base_to_the_first():
    model = RobotModel.from_urdf(ARM7)
    sticks = scene(model)['sticks']
    assert {body for _, (body, _) in sticks} == set(range(len(model.tree.moving_joint_names)))
    assert [body for (body, _), _ in sticks].count(-1) == 1


def test_a_stick_goes_on_to_the_farthest_link_of_the_last_body():
    text = (
        '<robot name="r"><link name="base"/><link name="rod"/><link name="near"/>'
        '<link name="tool"/><joint name="j" type="continuous"><parent link="base"/>'
        '<child link="rod"/><axis xyz="0 1 0"/></joint>'
        '<joint name="a" type="fixed"><parent link="rod"/><child link="near"/>'
        '<origin xyz="0 0 0.1"/></joint>'
        '<joint name="b" type="fixed"><parent link="near"/><child link="tool"/>'
        '<origin xyz="0 0 0.3"/></joint></robot>'
    )
    sticks = scene(RobotModel.from_urdf(text))['sticks']
    assert sticks[-1] == [[0, [0.0, 0.0, 0.0]], [0, [0.0, 0.0, 0.4]]]
