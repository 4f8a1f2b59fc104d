"""The physics of the simulated robot: against Pinocchio, and brakes, pushes, mimic joints."""

from dynamics_node.demo.mujoco_arm import MujocoArm, UnstableError
from dynamics_node.demo.mujoco_model import TIME_STEP
from dynamics_node.demo.poses import random_poses, start_pose
from dynamics_node.demo.robot_text import RobotRefusedError
from dynamics_node.demo.viewer import add_scenery, arrange_scenery, FLOOR
import numpy as np
import pinocchio
import pytest


@pytest.fixture
def arm(arm7_text):
    """Return arm7 at its start pose, on its brakes."""
    arm = MujocoArm(arm7_text)
    arm.place(start_pose(arm, 'arm7'))
    return arm


@pytest.fixture(scope='module')
def oracle(arm7_text):
    """Return a function q -> (D, G) of the driven joints by Pinocchio."""
    arm = MujocoArm(arm7_text)
    model = pinocchio.buildModelFromXML(arm7_text)
    data = model.createData()
    columns = [model.joints[model.getJointId(name)].idx_v for name in arm.names]

    def both(driven):
        full = np.zeros(model.nv)
        full[columns] = arm.mimic_matrix @ driven + arm.mimic_offset
        matrix = np.triu(pinocchio.crba(model, data, full))
        matrix = (matrix + np.triu(matrix, 1).T)[np.ix_(columns, columns)]
        torque = pinocchio.computeGeneralizedGravity(model, data, full)[columns]
        return arm.mimic_matrix.T @ matrix @ arm.mimic_matrix, arm.mimic_matrix.T @ torque

    return both


def test_mass_matrix_agrees_with_pinocchio(arm, oracle):
    for pose in random_poses(arm, 50):
        assert np.abs(arm.mass_matrix(pose) - oracle(pose)[0]).max() < 1e-6


def test_gravity_torque_agrees_with_pinocchio(arm, oracle):
    for pose in random_poses(arm, 50):
        assert np.abs(arm.gravity_torque(pose) - oracle(pose)[1]).max() < 1e-5


@pytest.mark.parametrize('link', ['base', 'forearm', 'hand', 'right_finger'])
def test_a_link_named_world_is_a_link_like_any_other(arm, arm7_text, link):
    assert f'"{link}"' in arm7_text
    renamed = MujocoArm(arm7_text.replace(f'"{link}"', '"world"'))
    pose = start_pose(arm, 'arm7')
    assert renamed.mass_matrix(pose) == pytest.approx(arm.mass_matrix(pose))
    assert renamed.gravity_torque(pose) == pytest.approx(arm.gravity_torque(pose))


def test_the_second_finger_follows_the_first(arm):
    arm.place(start_pose(arm, 'arm7') + [0, 0, 0, 0, 0, 0, 0, -0.02])
    arm.set_brakes(False)
    arm.set_effort([0, 0, 0, 0, 0, 0, 0, 2.0])
    errors = []
    for _ in range(400):
        arm.step()
        errors.append(abs(arm.position[-1] - arm.position[-2]))
    assert arm.position[-2] > 0.005
    assert max(errors) < 1e-4


def test_brakes_hold_against_any_effort(arm):
    before, start = arm.position.copy(), arm.data.time
    arm.set_effort(np.full(8, 1000.0))
    arm.step(200)
    assert np.array_equal(arm.position, before)
    assert arm.data.time - start == pytest.approx(200 * TIME_STEP)


def test_released_it_falls_and_the_brakes_catch_it(arm):
    before = arm.position.copy()
    arm.set_brakes(False)
    arm.step(1000)
    assert np.degrees(np.abs(arm.position - before)[:7].max()) > 20.0
    arm.set_brakes(True)
    caught = arm.position.copy()
    arm.step(1000)
    assert np.array_equal(arm.position, caught) and not arm.velocity.any()


def test_the_gravity_torque_holds_it(arm):
    before = arm.position.copy()
    arm.set_effort(arm.gravity_torque(arm.driven_position))
    arm.set_brakes(False)
    arm.step(int(10 / TIME_STEP))
    assert np.degrees(np.abs(arm.position - before)[:7].max()) < 0.01


def test_a_viewer_that_clears_external_forces_does_not_stop_a_push(arm):
    arm.set_brakes(False)
    before = arm.driven_position
    arm.set_effort(arm.gravity_torque(before))
    arm.push([0.0, 20.0, 0.0], 0.1)
    for _ in range(100):
        arm.data.xfrc_applied[:] = 0.0
        arm.step(2)
    assert np.abs(arm.driven_position - before).max() > 0.02


def test_the_scenery_of_the_viewer_changes_no_dynamics(arm, arm7_text):
    seen = MujocoArm(arm7_text, add_scenery)
    reach, pose = arrange_scenery(seen), arm.driven_position
    assert np.array_equal(seen.mass_matrix(pose), arm.mass_matrix(pose))
    assert np.array_equal(seen.gravity_torque(pose), arm.gravity_torque(pose))
    assert seen.last_link == arm.last_link
    assert 0.8 < reach < 1.4 and seen.model.geom(FLOOR).pos[2] < 0.0


def test_a_push_ends_after_its_time(arm):
    arm.set_effort(arm.gravity_torque(arm.driven_position))
    arm.set_brakes(False)
    arm.push([0.0, 20.0, 0.0], 0.1)
    arm.step(150)
    assert arm.data.xfrc_applied[arm.last_link, 1] == 20.0
    arm.step(100)
    assert not arm.data.xfrc_applied.any()
    assert arm.position[0] > 0.001


def test_the_last_link_is_the_one_that_carries_the_hand(arm):
    assert arm.model.body(arm.last_link).name == 'wrist_disc'


def test_the_jacobian_of_the_last_link_is_its_derivative(arm):
    pose, step = arm.driven_position, 1e-6
    for column in range(len(pose)):
        forward, backward = pose.copy(), pose.copy()
        forward[column] += step
        backward[column] -= step
        slope = (arm.skeleton(forward)[-1] - arm.skeleton(backward)[-1]) / (2 * step)
        assert slope == pytest.approx(arm.last_link_jacobian(pose)[:, column], abs=1e-7)


def test_gliding_ends_at_the_goal_on_the_brakes(arm):
    goal = np.array([1.0, 0.2, -0.5, 1.0, 0.3, -0.4, 0.5, 0.04])
    steps = int(np.ceil(arm.glide_to(goal) / TIME_STEP)) + 1
    fastest = np.zeros(8)
    for _ in range(steps):
        arm.step()
        fastest = np.maximum(fastest, np.abs(arm.velocity[:8]))
    assert np.all(fastest < [joint.velocity for joint in arm.driven])
    assert not arm.gliding and arm.braked
    assert arm.driven_position == pytest.approx(goal, abs=1e-12)


def test_efforts_beyond_the_limits_are_not_clamped(arm):
    arm.set_brakes(False)
    arm.set_effort([0, 0, 0, 0, 0, 0, 1200.0, 0])
    arm.step()
    stated = arm.driven[6].effort * TIME_STEP / arm.mass_matrix(arm.driven_position)[6, 6]
    assert abs(arm.velocity[6]) > 10 * stated


def test_absurd_efforts_end_on_the_brakes(arm, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = arm.position.copy()
    arm.set_brakes(False)
    arm.set_effort(np.full(8, 1e9))
    with pytest.raises(UnstableError, match='brakes are engaged'):
        arm.step(10)
    assert arm.braked and np.array_equal(arm.position, before) and not arm.effort.any()
    assert not list(tmp_path.iterdir())


def test_mujoco_s_refusal_becomes_one_sentence():
    ghost = (
        '<robot name="g"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/></joint></robot>'
    )
    with pytest.raises(RobotRefusedError, match=r'cannot simulate this robot: .*mass') as caught:
        MujocoArm(ghost)
    assert '\n' not in str(caught.value)
