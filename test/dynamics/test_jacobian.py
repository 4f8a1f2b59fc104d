"""Jacobians of points and link poses, against Pinocchio and finite differences."""

from dynamics_node import ArgumentError, RobotModel
import numpy as np
import pinocchio
import pytest
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, public_robot, random_state, random_urdf


def judged(text, names, q, link, point):
    """Return Pinocchio's Jacobian of a point of a link for the independent joints, and a pose."""
    judge = PinocchioOracle(text)
    B, b = judge.fold(list(names))
    x = judge._configuration(B @ q + b)
    frame = judge.model.getFrameId(link, pinocchio.FrameType.BODY)
    J = pinocchio.computeFrameJacobian(
        judge.model, judge.data, x, frame, pinocchio.LOCAL_WORLD_ALIGNED
    )
    pinocchio.framesForwardKinematics(judge.model, judge.data, x)
    pose = judge.data.oMf[frame].homogeneous
    offset = pose[:3, :3] @ point
    J = J.copy()
    J[:3] -= pinocchio.skew(offset) @ J[3:]
    return J @ B, pose


@pytest.mark.parametrize('seed', range(6))
def test_random_trees_on_every_link(seed):
    text = random_urdf(seed)
    robot = RobotModel.from_urdf(text)
    rng = np.random.default_rng(seed)
    q, _ = random_state(rng, robot)
    for link in robot.link_names:
        point = rng.normal(size=3)
        expected, pose = judged(text, robot.joint_names, q, link, point)
        scale = max(1.0, np.abs(expected).max())
        assert robot.jacobian(q, link, point) == pytest.approx(expected, abs=1e-13 * scale)
        assert robot.link_pose(q, link) == pytest.approx(pose, abs=1e-13 * np.abs(pose).max())


@pytest.mark.parametrize(
    ('name', 'link'),
    [
        ('panda_description/urdf/panda.urdf', 'panda_rightfinger'),
        ('ur_description/urdf/ur5_robot.urdf', 'tool0'),
        ('tiago_description/robots/tiago.urdf', 'arm_tool_link'),
    ],
)
def test_public_robots(name, link):
    text = public_robot(name).read_text()
    robot = RobotModel.from_urdf(text)
    q, _ = random_state(np.random.default_rng(5), robot)
    expected, pose = judged(text, robot.joint_names, q, link, np.array([0.1, 0.2, 0.3]))
    assert robot.jacobian(q, link, (0.1, 0.2, 0.3)) == pytest.approx(expected, abs=1e-13)
    assert robot.link_pose(q, link) == pytest.approx(pose, abs=1e-13)


def test_the_jacobian_is_the_derivative_of_the_point():
    robot = RobotModel.from_urdf(random_urdf(3))
    q, _ = random_state(np.random.default_rng(0), robot)
    link, point, h = robot.link_names[-1], np.array([0.1, -0.2, 0.3]), 1e-6

    def place(q):
        return (robot.link_pose(q, link) @ [*point, 1.0])[:3]

    numeric = np.array([(place(q + h * e) - place(q - h * e)) / (2 * h) for e in np.eye(q.size)]).T
    assert robot.jacobian(q, link, point)[:3] == pytest.approx(numeric, abs=1e-8)


def test_gravity_torque_is_the_weight_times_the_jacobian():
    robot = RobotModel.from_urdf(ARM7)
    q, com, mass = np.linspace(-1.0, 1.0, 8), (0.02, 0.01, 0.1), 2.5
    weight = np.array([*(mass * robot.gravity), 0.0, 0.0, 0.0])
    added = robot.with_payload('hand', mass, com).gravity_torque(q) - robot.gravity_torque(q)
    assert added == pytest.approx(-robot.jacobian(q, 'hand', com).T @ weight, abs=1e-12)


def test_batches_and_the_root_link():
    robot = RobotModel.from_urdf(ARM7)
    q = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 2, 8))
    many, poses = robot.jacobian(q, 'wrist'), robot.link_pose(q, 'wrist')
    assert many.shape == (3, 2, 6, 8)
    assert poses.shape == (3, 2, 4, 4)
    assert np.array_equal(many[2, 1], robot.jacobian(q[2, 1], 'wrist'))
    assert np.array_equal(poses[2, 1], robot.link_pose(q[2, 1], 'wrist'))
    assert not robot.jacobian(q, robot.tree.root).any()
    assert np.array_equal(robot.link_pose(q[0, 0], robot.tree.root), np.eye(4))
    assert robot.jacobian(np.empty((0, 8)), 'wrist').shape == (0, 6, 8)


def test_wrong_arguments_are_refused():
    robot = RobotModel.from_urdf(ARM7)
    with pytest.raises(ArgumentError, match='is not a link of the robot'):
        robot.jacobian(np.zeros(8), 'nowhere')
    with pytest.raises(ArgumentError, match='is not a link of the robot'):
        robot.link_pose(np.zeros(8), 'nowhere')
    with pytest.raises(ArgumentError, match='point: expected three numbers'):
        robot.jacobian(np.zeros(8), 'wrist', (1.0, 2.0))
    with pytest.raises(ArgumentError, match='q: expected shape'):
        robot.jacobian(np.zeros(7), 'wrist')
