"""Start poses, damping, pushes and effort limits for unprepared robots."""

from dynamics_node.demo.missing_values import (
    add_missing_damping,
    filled_in_limits,
    joints_without_limit,
)
from dynamics_node.demo.mujoco_arm import MujocoArm
from dynamics_node.demo.mujoco_model import TIME_STEP
from dynamics_node.demo.poses import (
    choose_pose,
    gravity_peak,
    plan_push,
    random_poses,
    start_pose,
    WANTED,
)
from dynamics_node.demo.robot_text import RobotRefusedError
import numpy as np
import pytest


@pytest.fixture(scope='module')
def arm(arm7_text):
    """Return arm7; the tests place it as they need it."""
    return MujocoArm(arm7_text)


def test_a_chosen_pose_is_the_same_every_time(arm):
    assert np.array_equal(choose_pose(arm), choose_pose(arm))


@pytest.mark.parametrize('choose', [choose_pose, lambda arm: start_pose(arm, 'arm7')])
def test_a_start_pose_can_be_held_and_falls(arm, choose):
    pose = choose(arm)
    torque = arm.gravity_torque(pose)
    for value, effort, joint in zip(pose, torque, arm.driven):
        assert joint.lower <= value <= joint.upper
        assert abs(effort) <= 0.8 * joint.effort
    assert arm.skeleton(pose)[:, 2].min() >= 0.0
    arm.place(pose)
    arm.set_brakes(False)
    arm.step(int(1 / TIME_STEP))
    assert np.degrees(np.abs(arm.driven_position - pose)[:7].max()) > 20.0


def test_a_robot_that_is_too_weak_for_itself_is_refused(arm7_text):
    weak = arm7_text.replace('effort="90"', 'effort="0.001"')
    with pytest.raises(RobotRefusedError, match='give the parameter start_pose'):
        choose_pose(MujocoArm(weak))


def test_arm7_needs_no_extra_damping(arm7_text):
    arm = MujocoArm(arm7_text)
    before = arm.damping().copy()
    assert add_missing_damping(arm) == []
    assert np.array_equal(arm.damping(), before)


def test_missing_damping_is_added_and_reported(arm7_text):
    text = arm7_text.replace('<dynamics damping="5" ', '<dynamics damping="0.003" ')
    arm = MujocoArm(text)
    changes = add_missing_damping(arm)
    assert [line.split()[0] for line in changes] == ['shoulder_yaw', 'shoulder_pitch']
    assert '0.003 -> ' in changes[0] and changes[0].endswith('N m s/rad')
    assert np.all(arm.damping()[:2] > 1.0) and arm.damping()[2] == 4.0


def test_a_planned_push_moves_the_softest_joint_as_far_as_planned(arm):
    pose = start_pose(arm, 'arm7')
    force = plan_push(arm, pose, 0.25)
    torque = arm.last_link_jacobian(pose).T @ force
    way = np.abs(torque * 0.25 / arm.damping()[:8])
    assert way[:7].max() == pytest.approx(WANTED)


def test_a_push_keeps_off_the_limits(arm):
    pose = start_pose(arm, 'arm7')
    pose[0] = 2.75
    torque = arm.last_link_jacobian(pose).T @ plan_push(arm, pose, 0.25)
    assert torque[0] <= 0.0


def test_missing_effort_limits_are_filled_in(arm7_text):
    bare = MujocoArm(arm7_text.replace('effort="90" ', ''))
    names = ['shoulder_yaw', 'shoulder_pitch', 'upper_arm_roll', 'elbow_pitch']
    assert joints_without_limit(bare) == names
    limits = filled_in_limits(bare)
    assert limits[4:].tolist() == [30, 30, 12, 40]
    assert np.all(limits[:4] >= np.maximum(1.0, 2 * gravity_peak(bare)[:4]))


def test_random_poses_keep_away_from_the_limits(arm):
    poses = np.array(list(random_poses(arm, 200)))
    lower = np.array([joint.lower for joint in arm.driven])
    upper = np.array([joint.upper for joint in arm.driven])
    assert np.all(poses > lower + 0.1 * (upper - lower))
    assert np.all(poses < upper - 0.1 * (upper - lower))
