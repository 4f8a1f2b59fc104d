"""Joints by name: an order of one's own, and what is refused."""

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


def test_any_joints_in_any_order():
    names = ARM.joint_names[3], ARM.joint_names[0]
    selection = JointSelection(ARM, names)
    assert selection.names == names
    np.testing.assert_array_equal(selection.index, [3, 0])
    np.testing.assert_array_equal(selection.permutation(names[::-1]), [1, 0])
    assert JointSelection(ARM).names == ARM.joint_names


def test_unknown_names_and_names_twice_are_said_in_words():
    message = refusal(['elbow_pitch', 'nose', 'elbow_pitch'])
    assert message == ("joints: 'nose' is not a joint that can be moved; 'elbow_pitch' is given "
                       f'twice; available: {", ".join(ARM.joint_names)}')


def test_what_a_terminal_would_obey_is_written_out():
    assert r"'\x1b[2J' is not a joint" in refusal(['\x1b[2J'])


def test_a_hundred_thousand_wrong_names_are_refused_at_once_and_in_short():
    # The torque waits as long as this takes, which was ten seconds for twenty thousand.
    begin = time.process_time()
    message = refusal([f'nose {i}' for i in range(100_000)])
    assert time.process_time() - begin < 2.0
    assert "'nose 4' is not a joint that can be moved; so it is for 99995 more" in message
    assert len(message) < 1000


def test_a_joint_that_follows_another_is_said_to_follow():
    with pytest.raises(ArgumentError, match=r"'right_finger_slide' follows 'left_finger_slide': "
                                            'leave it out; available'):
        JointSelection(ARM, ('right_finger_slide', 'wrist_roll'))
