"""Shapes of masses: position, size, and defects in red."""

from dynamics_node import RobotModel
from dynamics_node.visualization import BOX, Picture, SPHERE, TEXT
from dynamics_node.visualization.bodies import BodyShapes
from dynamics_node.visualization.scale import make_scale
import numpy as np
import pinocchio
import pytest
from support.mujoco_oracle import MujocoOracle
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, PENDULUM, public_robot, random_state, random_urdf

ROBOTS = {
    'arm7': ARM7,
    'ur5': public_robot('ur_description/urdf/ur5_robot.urdf'),
    'panda': public_robot('panda_description/urdf/panda.urdf'),
    'so101': public_robot('so_arm_description/urdf/so101.urdf'),
    'talos': public_robot('talos_data/robots/talos_reduced.urdf'),
    **{f'random {seed}': seed for seed in range(6)},
}


def text_of(name):
    source = ROBOTS[name]
    return random_urdf(source) if isinstance(source, int) else source.read_text()


def drawn(robot, q):
    """Return the shapes of a robot without torques."""
    none = np.full(len(robot.joint_names), np.nan)
    return Picture(robot.tree, robot.joint_names).shapes(robot, q, None, none, none)


def of_group(shapes, group, kind):
    return {shape.number: shape for shape in shapes if shape.group == group and shape.kind == kind}


def rotation(shape):
    x, y, z, w = shape.orientation
    return pinocchio.Quaternion(w, x, y, z).toRotationMatrix()


def half_turns():
    """Return rotations by 0 and pi about each axis, and random ones."""
    Q = np.linalg.qr(np.random.default_rng(3).normal(size=(50, 3, 3)))[0]
    axes = np.vstack([np.ones(3), 2.0 * np.eye(3) - 1.0])
    return np.concatenate([axes[:, :, None] * np.eye(3), Q * np.linalg.det(Q)[:, None, None]])


def test_orientations_are_exact_for_any_rotation():
    scale = make_scale(RobotModel.from_urdf(PENDULUM).tree)
    body = BodyShapes(['body'], [np.diag([1.0, 2.0, 3.0, 1.0])], [0], scale)
    for R in half_turns():
        pose = np.eye(4)
        pose[:3, :3] = R
        [box] = of_group(body.shapes(pose[None]), 'inertia', BOX).values()
        assert np.linalg.norm(box.orientation) == pytest.approx(1.0, abs=1e-15)
        # The box has its own principal axes: those of a diagonal J, in any order.
        axes = R.T @ rotation(box)
        assert np.abs(axes) == pytest.approx(np.round(np.abs(axes)), abs=1e-14)
        assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize('name', ROBOTS)
def test_every_center_of_mass_is_where_mujoco_has_it(name):
    text = text_of(name)
    robot, judge = RobotModel.from_urdf(text), MujocoOracle(text)
    q, _ = random_state(np.random.default_rng(1), robot)
    B, b = judge.fold(robot.joint_names)
    judge._pose(B @ q + b)
    mass, moment = np.zeros(len(robot.tree.parent)), np.zeros((len(robot.tree.parent), 3))
    for link, frame in robot.tree.links.items():
        if frame.body >= 0:
            body = judge.model.body('link_named_world' if link == 'world' else link).id
            mass[frame.body] += judge.model.body_mass[body]
            moment[frame.body] += judge.model.body_mass[body] * judge.data.xipos[body]
    spheres = of_group(drawn(robot, q), 'center_of_mass', SPHERE)
    assert set(spheres) == set(np.flatnonzero(mass > 0.0).tolist())
    assert spheres
    for k, sphere in spheres.items():
        assert sphere.position == pytest.approx(moment[k] / mass[k], abs=1e-11)


@pytest.mark.parametrize('name', ROBOTS)
def test_centers_and_boxes_are_those_of_pinocchio(name):
    text = text_of(name)
    robot, judge = RobotModel.from_urdf(text), PinocchioOracle(text)
    q, _ = random_state(np.random.default_rng(2), robot)
    B, b = judge.fold(list(robot.joint_names))
    pinocchio.forwardKinematics(judge.model, judge.data, judge._configuration(B @ q + b))
    shapes = drawn(robot, q)
    spheres, boxes = (
        of_group(shapes, *what) for what in (('center_of_mass', SPHERE), ('inertia', BOX))
    )
    heaviest = max(inertia.mass for inertia in judge.model.inertias[1:])
    largest = max(sphere.size[0] for sphere in spheres.values())
    for k, joint in enumerate(robot.tree.moving_joint_names):
        i = judge.model.getJointId(joint)
        inertia, pose = judge.model.inertias[i], judge.data.oMi[i]
        if not inertia.mass > 0.0:
            assert k not in spheres and k not in boxes
            continue
        assert spheres[k].position == pytest.approx(pose.act(inertia.lever), abs=1e-11)
        # Volumes are proportional to masses, down to the smallest radius.
        volume = (spheres[k].size[0] / largest) ** 3
        assert volume == pytest.approx(max(inertia.mass / heaviest, 0.08**3), rel=1e-9)
        if k not in boxes:
            assert of_group(shapes, 'problems', TEXT)[2 * k + 1].text.endswith('inertia')
            continue
        box, R = boxes[k], rotation(boxes[k])
        assert box.position == spheres[k].position
        a, b_, c = box.size
        moments = inertia.mass / 12.0 * np.array([b_**2 + c**2, a**2 + c**2, a**2 + b_**2])
        tensor = pose.rotation @ inertia.inertia @ pose.rotation.T
        # Up to the least thickness: half a thousandth of the robot's length.
        assert R @ np.diag(moments) @ R.T == pytest.approx(
            tensor, abs=1e-5 * np.trace(tensor) + 1e-7 * inertia.mass
        )


PROBLEMS = {
    'no real body has this inertia': '<mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.3" '
    'ixy="0" ixz="0" iyz="0"/>',
    'inertia without mass': '<mass value="0"/><inertia ixx="0.1" iyy="0.1" izz="0.1" '
    'ixy="0" ixz="0" iyz="0"/>',
}


@pytest.mark.parametrize('problem', PROBLEMS)
def test_an_impossible_body_is_red_with_a_text(problem):
    robot = RobotModel.from_urdf(
        '<robot name="r"><link name="a"/><link name="wrong"><inertial>'
        + PROBLEMS[problem]
        + '</inertial></link><joint name="j" type="continuous"><parent link="a"/>'
        '<child link="wrong"/></joint></robot>'
    )
    shapes = drawn(robot, [0.3])
    [box], [text] = (list(of_group(shapes, 'problems', kind).values()) for kind in (BOX, TEXT))
    assert text.text == f'wrong: {problem}'
    assert box.color[0] == 1.0 and max(box.color[1:3]) < 0.2
    assert not of_group(shapes, 'inertia', BOX)


def test_frames_without_mass_are_no_problem():
    robot = RobotModel.from_urdf(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" '
        'type="continuous"><parent link="a"/><child link="b"/></joint>'
        '</robot>'
    )
    assert {shape.group for shape in drawn(robot, [0.3])}.isdisjoint(
        {'center_of_mass', 'inertia', 'problems'}
    )


def test_links_of_the_base_are_left_out():
    robot = RobotModel.from_urdf(ARM7)
    assert robot.tree.base_inertia[3, 3] > 0.0
    names = of_group(drawn(robot, robot.neutral_position), 'center_of_mass', SPHERE)
    assert len(names) == len(robot.tree.moving_joint_names)


def test_the_payload_is_a_separate_body():
    empty = RobotModel.from_urdf(ARM7)
    q = np.clip(np.full(8, 0.4), *empty.position_limits.T)
    inertia = np.diag([0.02, 0.03, 0.04])
    robot = empty.with_payload('hand', 2.0, (0.0, 0.1, 0.2), inertia)
    shapes, before = drawn(robot, q), drawn(empty, q)
    assert [shape for shape in shapes if shape.group != 'payload'] == before
    [sphere], [box] = (of_group(shapes, 'payload', kind).values() for kind in (SPHERE, BOX))
    assert sphere.number != box.number
    pose = robot.link_pose(q, 'hand')
    assert sphere.position == pytest.approx((pose @ [0.0, 0.1, 0.2, 1.0])[:3], abs=1e-14)
    body = of_group(shapes, 'center_of_mass', SPHERE)
    mass = robot.tree.inertia[0, 3, 3]
    assert (sphere.size[0] / body[0].size[0]) ** 3 == pytest.approx(2.0 / mass)
    assert sphere.color != body[0].color
    a, b, c = np.sort(box.size)
    assert 2.0 / 12.0 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2]) == pytest.approx(
        [0.04, 0.03, 0.02]
    )


def test_a_payload_on_the_base_is_not_drawn():
    robot = RobotModel.from_urdf(ARM7)
    robot = robot.with_payload(robot.tree.root, 2.0)
    assert 'payload' not in {shape.group for shape in drawn(robot, robot.neutral_position)}


def test_a_light_payload_on_a_heavy_robot_is_visible():
    text = random_urdf(0)
    robot = RobotModel.from_urdf(text)
    heaviest = robot.tree.inertia[:, 3, 3].max()
    light = robot.with_payload(robot.tip_link, 1e-12 * heaviest)
    q = np.zeros(len(robot.joint_names))
    sizes = [shape.size[0] for shape in drawn(light, q) if shape.kind == SPHERE]
    assert min(sizes) == pytest.approx(0.08 * max(sizes))
