"""Arcs and arrows of torques: axis, direction, length, color and text."""

import math

from dynamics_node import RobotModel
from dynamics_node.visualization import colors, DISC, LINE, Picture, TEXT
import numpy as np
import pinocchio
import pytest
from support.robots import ARM7, public_robot, random_state, random_urdf

FULL = 270.0


def drawn(robot, q, torque, effort=None, limits=None, names=None):
    """Return the shapes by group and number."""
    names = robot.joint_names if names is None else names
    nothing = np.full(len(names), np.nan)
    shapes = Picture(robot.tree, names).shapes(
        robot,
        q,
        np.asarray(torque, dtype=float),
        nothing if effort is None else effort,
        nothing if limits is None else np.asarray(limits, dtype=float),
    )
    by_name = {(shape.group, shape.number): shape for shape in shapes}
    assert len(by_name) == len(shapes)
    return by_name


def rotation(shape):
    x, y, z, w = shape.orientation
    return pinocchio.Quaternion(w, x, y, z).toRotationMatrix()


def swept(shape):
    """Return the signed angle of an arc about its z axis, degrees."""
    arc = np.array(shape.points[:-3])  # then a barb, the tip and a barb
    assert shape.points[-2] == shape.points[-4]
    assert np.ptp(np.linalg.norm(arc, axis=1)) < 1e-12 and not arc[:, 2].any()
    angle = np.unwrap(np.arctan2(arc[:, 1], arc[:, 0]))
    return math.degrees(angle[-1] - angle[0])


@pytest.mark.parametrize(
    'source',
    [
        ARM7,
        public_robot('panda_description/urdf/panda.urdf'),
        random_urdf(3),
        random_urdf(5, joints=9),
    ],
    ids=['arm7', 'panda', 'random 3', 'random 5'],
)
def test_axes_are_those_of_small_motions(source):
    robot = RobotModel.from_urdf(source)
    n = len(robot.joint_names)
    q, _ = random_state(np.random.default_rng(4), robot)
    shapes = drawn(robot, q, np.ones(n), np.full(n, -2.0), np.full(n, 4.0))
    names, step = robot.tree.moving_joint_names, 1e-6
    for i, name in enumerate(robot.joint_names):
        k = names.index(name)
        ahead, back = (robot.body_poses(q + sign * step * np.eye(n)[i])[k] for sign in (1, -1))
        turn = pinocchio.log3(ahead[:3, :3] @ back[:3, :3].T) / (2 * step)
        shift = (ahead[:3, 3] - back[:3, 3]) / (2 * step)
        for group in ('gravity_torque', 'effort'):
            shape = shapes[group, i]
            axis = rotation(shape)[:, 2]
            assert axis == pytest.approx(shift if robot.tree.joint_type[k] else turn, abs=1e-8)
            assert shape.position == pytest.approx(robot.body_poses(q)[k, :3, 3], abs=1e-14)


@pytest.mark.parametrize('load', [0.001, 0.2, 0.5, 0.9999, 1.0, 1.2])
@pytest.mark.parametrize('sign', [1, -1])
def test_the_limit_is_three_quarters_of_a_turn(load, sign):
    robot = RobotModel.from_urdf(ARM7)
    limits = np.nan_to_num(robot.effort_limits, nan=10.0)
    shapes = drawn(
        robot, robot.neutral_position, sign * load * limits, -sign * load * limits, limits
    )
    for i, kind in enumerate(robot.tree.joint_type[: len(limits)]):
        torque, effort = shapes['gravity_torque', i], shapes['effort', i]
        if kind:
            length = torque.points[1][2] - torque.points[0][2]
            full = drawn(robot, robot.neutral_position, limits, None, limits)[
                'gravity_torque', i
            ].points[1][2]
            assert length == pytest.approx(sign * load * full, rel=1e-9, abs=0.003 * full)
        else:
            shortest = math.degrees(0.01)
            expected = sign * max(load * FULL, shortest)
            assert swept(torque) == pytest.approx(expected, rel=1e-9)
            assert swept(effort) == pytest.approx(-expected, rel=1e-9)
        for shape in (torque, effort):
            assert shape.color == pytest.approx(colors.of_load(load), abs=1e-12)
        assert torque.kind == effort.kind == LINE


def test_an_arc_never_closes_and_never_vanishes():
    robot = RobotModel.from_urdf(public_robot('ur_description/urdf/ur5_robot.urdf'))
    n = len(robot.joint_names)
    for torque, expected in ((1e9, 351.0), (-1e9, -351.0), (0.0, 0.573)):
        shapes = drawn(robot, np.zeros(n), np.full(n, torque), None, np.ones(n))
        assert swept(shapes['gravity_torque', 0]) == pytest.approx(expected, rel=1e-3)
        points = np.array(shapes['gravity_torque', 0].points)
        assert np.linalg.norm(np.diff(points, axis=0), axis=1).min() > 0.0


@pytest.mark.parametrize('limits', [np.nan, 0.0, np.inf])
def test_without_limits_arcs_are_grey_and_relative_to_the_largest(limits):
    robot = RobotModel.from_urdf(public_robot('ur_description/urdf/ur5_robot.urdf'))
    torque = np.array([1.0, -4.0, 2.0, 0.0, 0.5, 0.0])
    shapes = drawn(robot, np.zeros(6), torque, None, np.full(6, limits))
    for i, value in enumerate(torque):
        shape = shapes['gravity_torque', i]
        assert shape.color == colors.UNLIMITED
        if value:
            assert swept(shape) == pytest.approx(value / 4.0 * FULL)
        assert shapes['torque_text', i].text == f'{robot.joint_names[i]}: {value:g} N m'


def test_unknown_efforts_are_not_drawn():
    robot = RobotModel.from_urdf(ARM7)
    n = len(robot.joint_names)
    effort = np.full(n, np.nan)
    effort[2] = 1.0
    shapes = drawn(robot, robot.neutral_position, np.ones(n), effort, np.full(n, 10.0))
    assert [number for group, number in shapes if group == 'effort'] == [2]


def test_texts_contain_the_gravity_torque_and_its_share_of_the_limit():
    robot = RobotModel.from_urdf(ARM7)
    n = len(robot.joint_names)
    torque = np.array([12.345, -4.5, 1e-17, 0.0, -1e-17, 30.0, 0.1, 2.5])
    shapes = drawn(robot, robot.neutral_position, torque, np.full(n, 99.0), np.full(n, 30.0))
    texts = [shapes['torque_text', i] for i in range(n)]
    assert [text.text.partition(': ')[2] for text in texts] == [
        '12.3 N m (41 %)',
        '-4.5 N m (15 %)',
        '0 N m (0 %)',
        '0 N m (0 %)',
        '0 N m (0 %)',
        '30 N m (100 %)',
        '0.1 N m (0 %)',
        '2.5 N (8 %)',
    ]
    assert [text.text.partition(':')[0] for text in texts] == list(robot.joint_names)
    assert all(text.kind == TEXT for text in texts)


def test_the_start_of_an_arc_does_not_turn_with_its_joint():
    robot = RobotModel.from_urdf(ARM7)
    n, turned = len(robot.joint_names), robot.neutral_position
    turned[1] += 1.0
    one, other = (drawn(robot, q, np.ones(n)) for q in (robot.neutral_position, turned))
    assert one['gravity_torque', 1].orientation == other['gravity_torque', 1].orientation
    assert one['gravity_torque', 2].orientation != other['gravity_torque', 2].orientation
    assert one['joints', 1].kind == DISC


def test_only_the_chosen_joints_have_torques_in_their_order():
    robot = RobotModel.from_urdf(ARM7)
    chosen = (robot.joint_names[3], robot.joint_names[1])
    shapes = drawn(robot, robot.neutral_position, [1.0, 2.0], None, [10.0, 10.0], chosen)
    texts = [shape.text for (group, _), shape in shapes.items() if group == 'torque_text']
    assert texts == [f'{chosen[0]}: 1 N m (10 %)', f'{chosen[1]}: 2 N m (20 %)']


def test_texts_of_coincident_joints_are_stacked():
    robot = RobotModel.from_urdf(public_robot('panda_description/urdf/panda.urdf'))
    n = len(robot.joint_names)
    shapes = drawn(robot, robot.neutral_position, np.ones(n))
    texts = [shapes['torque_text', i] for i in range(n)]
    for i, text in enumerate(texts):
        for other in texts[:i]:
            apart = np.abs(np.subtract(text.position, other.position))
            assert apart.max() > 1.2 * text.size[2], (text.text, other.text)


def test_without_limits_forces_and_torques_are_scaled_separately():
    robot = RobotModel.from_urdf(ARM7)
    torque = np.array([2.0, -8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1000.0])  # the last one slides
    shapes = drawn(robot, robot.neutral_position, torque)
    assert swept(shapes['gravity_torque', 0]) == pytest.approx(FULL / 4)
    assert swept(shapes['gravity_torque', 1]) == pytest.approx(-FULL)
    arrow, alone = (
        shapes['gravity_torque', 7],
        drawn(robot, robot.neutral_position, [0, 0, 0, 0, 0, 0, 0, 1.0])['gravity_torque', 7],
    )
    assert arrow.points == alone.points
