"""Selections of joints by name: order and errors."""

import time

from dynamics_node import RobotModel
from dynamics_node.dynamics import JointSelection
from dynamics_node.errors import ArgumentError
import numpy as np
import pytest
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)


def refusal(names):
    """Return why names are refused."""
    with pytest.raises(ArgumentError) as caught:
        JointSelection(ARM, names)
    return str(caught.value)


def test_a_selection_of_any_joints_in_any_order():
    names = ARM.joint_names[3], ARM.joint_names[0]
    selection = JointSelection(ARM, names)
    assert selection.names == names
    np.testing.assert_array_equal(selection.index, [3, 0])
    np.testing.assert_array_equal(selection.permutation(names[::-1]), [1, 0])
    assert JointSelection(ARM).names == ARM.joint_names


def test_unknown_and_repeated_names_are_refused_with_a_reason():
    message = refusal(['elbow_pitch', 'nose', 'elbow_pitch'])
    assert message == (
        "joints: 'nose' is not a joint that can be moved; 'elbow_pitch' is given "
        f'twice; available: {", ".join(ARM.joint_names)}'
    )


def test_control_characters_in_names_are_escaped():
    assert r"'\x1b[2J' is not a joint" in refusal(['\x1b[2J'])


def test_a_hundred_thousand_wrong_names_are_refused_at_once_and_in_short():
    # The torque waits as long as this takes, which was ten seconds for twenty thousand.
    begin = time.process_time()
    message = refusal([f'nose {i}' for i in range(100_000)])
    assert time.process_time() - begin < 2.0
    assert "'nose 4' is not a joint that can be moved; and 99995 more like these" in message
    assert len(message) < 1000


def test_a_mimic_joint_is_named_with_its_leader():
    with pytest.raises(
        ArgumentError,
        match=r"'right_finger_slide' follows 'left_finger_slide': "
        'leave it out; available',
    ):
        JointSelection(ARM, ('right_finger_slide', 'wrist_roll'))


def difference(names):
    """Return why names are no permutation of the first three joints."""
    with pytest.raises(ArgumentError) as caught:
        JointSelection(ARM, ARM.joint_names[:3]).permutation(names)
    return str(caught.value)


def test_an_invalid_permutation_is_refused_with_the_wrong_name():
    yaw, pitch, roll = ARM.joint_names[:3]
    expected = '; expected each of 3 joints once, or no name at all'
    assert difference([yaw, 'shoulder_pich', roll]) == (
        "joint_names: 'shoulder_pich' is not a joint that can be moved, is 'shoulder_pitch' "
        f"meant?; 'shoulder_pitch' is missing{expected}"
    )
    assert difference([yaw, pitch, pitch, roll]) == (
        f"joint_names: 'shoulder_pitch' is given twice{expected}"
    )
    assert difference([yaw, pitch]) == f"joint_names: '{roll}' is missing{expected}"
    assert difference([yaw, pitch, roll, 'elbow_pitch']) == (
        f"joint_names: 'elbow_pitch' is not one of the chosen joints{expected}"
    )
    assert "'right_finger_slide' follows 'left_finger_slide': leave it out" in difference(
        [yaw, pitch, roll, 'right_finger_slide']
    )


def test_a_hundred_thousand_names_that_are_no_permutation_are_refused_at_once():
    begin = time.process_time()
    message = difference(['x' * 300, *(f'shoulder_pitch {i}' for i in range(100_000))])
    assert time.process_time() - begin < 2.0
    assert 'and 99996 more like these' in message
    assert len(message) < 1500
