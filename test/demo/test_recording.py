"""Measured displacements, and the expectations of the demo."""

from dynamics_node.demo.recording import Recording
from dynamics_node.demo.story import Outcome
import numpy as np
import pytest
from sensor_msgs.msg import JointState


def state(time, **positions):
    """Return a joint state, in alphabetical order as the robot publishes it."""
    names = sorted(positions)
    message = JointState(name=names, position=[positions[name] for name in names])
    message.velocity, message.effort = [0.0] * len(names), [0.0] * len(names)
    message.header.stamp.sec = int(time)
    message.header.stamp.nanosec = round((time - int(time)) * 1e9)
    return message


@pytest.fixture
def recording():
    """Return three states of a joint that turns and one that slides, among others."""
    recording = Recording(['turn', 'slide'], [True, False])
    recording.add(state(5.0, slide=0.0, turn=0.0, other=9.0))
    recording.add(state(5.5, slide=0.01, turn=0.5, other=9.0))
    recording.add(state(6.25, slide=0.0, turn=0.1, other=9.0))
    return recording


def test_the_order_of_the_joints_is_the_recording_s(recording):
    assert recording.positions().tolist() == [[0, 0], [0.5, 0.01], [0.1, 0]]
    assert recording.times().tolist() == [0, 0.5, 1.25]


def test_displacement_is_the_largest_on_the_way_not_the_last(recording):
    way = recording.displacement(np.zeros(2), 0.0, 1.25)
    assert way == pytest.approx([np.degrees(0.5), 10.0])
    assert recording.displacement(np.zeros(2), 1.0, 2.0) == pytest.approx([np.degrees(0.1), 0.0])


def outcome(recording, fall=60.0, drift=0.1, pushed=20.0, after=0.1):
    """Return an outcome with these degrees."""
    return Outcome(recording, 10.0, *(np.array([x, 0.0]) for x in (fall, drift, pushed, after)))


def test_a_good_run_has_no_failures(recording):
    assert outcome(recording).failures() == []


@pytest.mark.parametrize(
    'change, sentence',
    [
        ({'fall': 19.0}, 'it fell 19.0 degrees; expected more than 20'),
        ({'drift': 1.5}, 'held, it drifted 1.50 degrees; expected less than 1'),
        ({'drift': float('nan')}, 'held, it drifted nan degrees; expected less than 1'),
        ({'after': 2.0}, 'held after the push, it drifted 2.00 degrees; expected less than 1'),
        ({'pushed': 1.0}, 'the push moved it 1.0 degrees; expected more than 3'),
    ],
)
def test_every_figure_can_fail_the_demo(recording, change, sentence):
    failures = outcome(recording, **change).failures()
    assert len(failures) == 1 and sentence in failures[0]
