"""Complete pictures: valid for RViz, gravity, payload, with and without torques."""

from dynamics_node import RobotModel
from dynamics_node.visualization import ARROW, Picture
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from support.robots import ARM7, PENDULUM, public_robot, public_robots, random_urdf

SHAPES = {'sphere', 'box', 'disc', 'line', 'arrow', 'text'}


def assert_valid(shapes):
    """Assert RViz's conditions, and distinct names."""
    names = [(shape.group, shape.number) for shape in shapes]
    assert len(set(names)) == len(names)
    for shape in shapes:
        numbers = [
            *shape.size,
            *shape.color,
            *shape.position,
            *shape.orientation,
            *(x for point in shape.points for x in point),
        ]
        assert np.isfinite(numbers).all(), shape
        assert min(shape.size) > 0.0, shape
        assert np.linalg.norm(shape.orientation) == pytest.approx(1.0, abs=1e-12), shape
        assert 0.0 < shape.color[3] <= 1.0 and min(shape.color) >= 0.0, shape
        assert max(shape.color) <= 1.0 and shape.group, shape
        assert shape.kind in SHAPES and bool(shape.text) == (shape.kind == 'text'), shape
        assert len(shape.points) == 2 or shape.kind != ARROW


def picture_of(robot, q, effort, limits):
    return Picture(robot.tree, robot.joint_names).shapes(
        robot, q, robot.gravity_torque(q), effort, limits
    )


def at_rest(source, gravity=(0.0, 0.0, -9.81)):
    """Return the shapes of a robot in neutral position, without efforts, and its arrow."""
    robot = RobotModel.from_urdf(source).with_gravity(gravity)
    q = robot.neutral_position
    shapes = picture_of(robot, q, np.zeros(len(q)), robot.effort_limits)
    return shapes, next((shape for shape in shapes if shape.kind == ARROW), None)


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10_000),
    scale=st.sampled_from([1e-6, 1.0, 1e6]),
    load=st.sampled_from([0.0, 1e-300, 1.0, 1e30]),
    gravity=st.sampled_from([0.0, 1e-9, 9.81]),
    payload=st.sampled_from([0.0, 1e-9, 1.0, 1e5]),
)
def test_pictures_of_random_robots_are_valid(seed, scale, load, gravity, payload):
    robot = RobotModel.from_urdf(random_urdf(seed, mass_scale=scale)).with_gravity(
        (0.0, 0.6 * gravity, -0.8 * gravity)
    )
    rng = np.random.default_rng(seed)
    n = len(robot.joint_names)
    link = robot.link_names[int(rng.integers(len(robot.link_names)))]
    robot = robot.with_payload(link, payload, rng.normal(size=3))
    q = rng.normal(0.0, 10.0 ** rng.uniform(-3, 3), n)
    effort = np.where(rng.random(n) < 0.3, np.nan, rng.normal(size=n) * load)
    limits = np.where(rng.random(n) < 0.5, np.nan, rng.random(n) * load)
    assert_valid(picture_of(robot, q, effort, limits))


@pytest.mark.parametrize('name', public_robots()[::4])
def test_pictures_of_public_robots_are_valid(name):
    try:
        robot = RobotModel.from_urdf(public_robot(name))
    except ValueError:
        pytest.skip('refused as a robot')
    if not robot.joint_names:
        pytest.skip('no joint that can be moved')
    q = robot.neutral_position
    assert_valid(picture_of(robot, q, np.ones(len(q)), robot.effort_limits))


def test_a_position_that_is_not_finite_has_no_picture():
    robot = RobotModel.from_urdf(PENDULUM)
    picture = Picture(robot.tree, robot.joint_names)
    nothing = np.array([np.nan])
    assert picture.shapes(robot, np.array([np.nan]), np.zeros(1), nothing, nothing) == []


@pytest.mark.parametrize('gravity', [(0.0, 0.0, -9.81), (0.0, 9.81, 0.0), (3.0, -1.0, -2.0)])
def test_the_arrow_of_gravity_has_its_direction_and_size(gravity):
    shapes, arrow = at_rest(ARM7, gravity)
    vector = np.subtract(arrow.points[1], arrow.points[0])
    size = np.linalg.norm(gravity)
    assert vector / np.linalg.norm(vector) == pytest.approx(np.array(gravity) / size)
    _, earth = at_rest(ARM7)
    assert np.linalg.norm(vector) / np.linalg.norm(earth.points[1]) == pytest.approx(size / 9.81)
    [text] = [shape.text for shape in shapes if (shape.group, shape.number) == ('gravity', 1)]
    assert text == f'{size:.3g} m/s^2'


def test_without_gravity_there_is_no_arrow():
    shapes, _ = at_rest(ARM7, (0.0, 0.0, 0.0))
    assert shapes and 'gravity' not in {shape.group for shape in shapes}


def test_without_a_torque_neither_torques_nor_efforts_are_drawn():
    robot = RobotModel.from_urdf(ARM7)
    picture = Picture(robot.tree, robot.joint_names)
    whole, without = (
        picture.shapes(robot, robot.neutral_position, torque, np.ones(8), robot.effort_limits)
        for torque in (np.ones(8), None)
    )
    assert without == whole[: len(without)]
    assert {shape.group for shape in whole[len(without) :]} == {
        'joints',
        'gravity_torque',
        'effort',
        'torque_text',
    }


REACH = 0.35  # m, of the pendulum


@pytest.mark.parametrize(('strength', 'times'), [(9.81, 1.0), (1.62, 1.62 / 9.81), (1000.0, 2.0)])
def test_the_arrow_of_gravity_is_never_longer_than_twice_that_of_the_earth(strength, times):
    _, arrow = at_rest(PENDULUM, (0.0, 0.0, -strength))
    assert np.linalg.norm(arrow.points[1]) == pytest.approx(0.2 * REACH * times)


@pytest.mark.parametrize('gravity', [(0.0, 0.0, -9.81), (9.81, 0.0, 0.0)])
def test_the_arrow_of_gravity_stands_beside_the_base_and_above_it(gravity):
    _, arrow = at_rest(PENDULUM, gravity)
    down = np.array(gravity) / 9.81
    end = np.add(arrow.position, arrow.points[1])
    beside = end - (end @ down) * down
    assert np.linalg.norm(beside) == pytest.approx(0.2 * REACH)
    assert end @ down == pytest.approx(0.0, abs=1e-12)


def test_another_payload_replaces_the_previous_one():
    robot = RobotModel.from_urdf(ARM7)
    picture = Picture(robot.tree, robot.joint_names)

    def payload(model):
        q = robot.neutral_position
        return [
            shape.size
            for shape in picture.shapes(model, q, np.zeros(8), np.ones(8), robot.effort_limits)
            if shape.group == 'payload'
        ]

    small, large = (robot.with_payload('hand', mass) for mass in (1.0, 2.0))
    first, second = payload(small), payload(large)
    assert first and second[0][0] == pytest.approx(first[0][0] * 2.0 ** (1 / 3))
    assert payload(robot) == [] and payload(small) == first
