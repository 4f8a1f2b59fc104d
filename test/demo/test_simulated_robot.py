"""The ROS interface of the simulated robot, over DDS."""

import math

from dynamics_node.demo.mujoco_arm import MujocoArm
import numpy as np
import pytest

DRIVEN = [
    'shoulder_yaw',
    'shoulder_pitch',
    'upper_arm_roll',
    'elbow_pitch',
    'forearm_roll',
    'wrist_pitch',
    'wrist_roll',
    'left_finger_slide',
]
NO_BODY = """<robot name="ghost"><link name="a"/><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>"""


def holding_command(robot, arm7_text):
    """Return MuJoCo's gravity torque where the robot stands, in the order of a command."""
    here = robot.positions()
    return MujocoArm(arm7_text).gravity_torque(np.array([here[name] for name in DRIVEN])).tolist()


def largest_way(before, after):
    """Return the largest displacement of a joint that turns [deg]."""
    return max(math.degrees(abs(after[name] - before[name])) for name in DRIVEN[:-1])


def test_it_publishes_the_original_description(robot, arm7_text):
    robot.wait_for(lambda: robot.description)
    assert robot.description == arm7_text


def test_joint_states_are_alphabetical_and_complete(robot):
    state = robot.states[-1]
    assert list(state.name) == sorted([*DRIVEN, 'right_finger_slide'])
    assert len(state.position) == len(state.velocity) == len(state.effort) == 9


def test_joint_states_come_at_about_the_rate(robot):
    states = robot.spin_for(1.0)
    stamps = [state.header.stamp.sec + state.header.stamp.nanosec * 1e-9 for state in states]
    assert len(states) < 525
    gaps = np.diff(stamps)
    assert (gaps > 0.0).all()
    # The shortest ones tell the rate, however many are missing in between.
    assert 0.001 < np.quantile(gaps, 0.2) < 0.003


def test_the_brakes_hold_at_start_up(robot):
    positions = {tuple(state.position) for state in robot.spin_for(0.3)}
    assert len(positions) == 1


def test_released_without_a_command_it_falls(robot):
    before = robot.positions()
    assert robot.call('set_brakes', data=False).success
    robot.wait_for(lambda: largest_way(before, robot.positions()) > 20.0)
    assert robot.position('shoulder_pitch') > before['shoulder_pitch']


def test_one_command_is_held_for_ever(robot, arm7_text):
    before, torque = robot.positions(), holding_command(robot, arm7_text)
    robot.command(torque)
    robot.wait_for(lambda: robot.efforts()['shoulder_pitch'] != 0.0)
    robot.call('set_brakes', data=False)
    robot.spin_for(0.7)
    assert largest_way(before, robot.positions()) < 0.01
    assert robot.efforts() == pytest.approx(
        {**dict(zip(DRIVEN, torque)), 'right_finger_slide': 0.0}
    )


@pytest.mark.parametrize('wrong', [[], [1.0] * 7, [1.0] * 9, [math.nan] * 8])
def test_a_wrong_command_is_ignored(robot, wrong):
    good = [0.1 * i for i in range(8)]
    robot.command(good)
    robot.wait_for(lambda: robot.efforts()['left_finger_slide'] == good[-1])
    robot.command(wrong)
    efforts = {tuple(state.effort) for state in robot.spin_for(0.1)}
    assert efforts == {tuple(robot.states[-1].effort)}
    assert robot.efforts()['left_finger_slide'] == good[-1]


def test_nothing_is_clamped(robot):
    robot.command([1e4] * 8)
    robot.wait_for(lambda: robot.efforts()['wrist_roll'] == 1e4)


def test_a_push_moves_the_held_arm(robot, arm7_text):
    before = robot.positions()
    robot.command(holding_command(robot, arm7_text))
    robot.wait_for(lambda: robot.efforts()['shoulder_pitch'] != 0.0)
    robot.call('set_brakes', data=False)
    answer = robot.call('push')
    assert answer.success and ' N for 0.25 s' in answer.message
    robot.wait_for(lambda: largest_way(before, robot.positions()) > 5.0)


def test_a_push_on_the_brakes_is_refused(robot):
    answer = robot.call('push')
    assert not answer.success and 'brakes are engaged' in answer.message


def test_reset_travels_back_without_a_jump(robot):
    start = robot.positions()
    robot.command([5.0] * 8)
    robot.call('set_brakes', data=False)
    robot.spin_for(0.2)
    first = len(robot.states)
    assert robot.call('reset').success
    assert not robot.call('set_brakes', data=False).success  # it is on its way
    robot.wait_for(lambda: robot.positions() == pytest.approx(start, abs=1e-9))
    way = robot.states[first:]
    steps = np.abs(np.diff([state.position for state in way], axis=0)).max(axis=1)
    gaps = np.diff([state.header.stamp.sec + 1e-9 * state.header.stamp.nanosec for state in way])
    # The fastest joint's speed limit; a busy machine may leave longer gaps than 0.05 s.
    assert (steps < 2.6 * np.maximum(gaps, 0.05)).all()
    assert not any(robot.efforts().values())


def test_ctrl_c_ends_it_quietly(start_robot):
    order = list(reversed(DRIVEN))
    pose = [0.1, 0.5, 0.0, 0.3, 0.0, 0.2, 0.0, 0.01]
    robot = start_robot(f'joints:=[{", ".join(order)}]', f'start_pose:={pose}')
    assert [robot.position(name) for name in DRIVEN] == pytest.approx(pose)
    robot.command([float(i) for i in range(8)])
    robot.wait_for(lambda: robot.efforts()['shoulder_yaw'] == 7.0)
    assert robot.efforts()['wrist_roll'] == 1.0
    code, output = robot.close()
    assert code == 0
    assert all(line.startswith('[INFO]') for line in output.splitlines()), output


def test_what_cannot_be_run_is_refused_in_one_sentence(refusals, tmp_path):
    path = tmp_path / 'ghost.urdf'
    path.write_text(NO_BODY)
    ghost, blind, lost = refusals(
        ['--ros-args', '-p', f'robot_description_file:={path}'],
        ['--view'],
        ['--ros-args', '-p', 'start_pose:=[1.0]'],
    )
    assert ghost.startswith('simulated_robot: MuJoCo cannot simulate this robot: ')
    assert blind.startswith('simulated_robot: the viewer needs a display')
    assert lost.startswith('simulated_robot: start_pose: expected 8 finite numbers for shoulder_')
