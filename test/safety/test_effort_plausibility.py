"""Efforts that can hardly be torques are noticed at rest; contacts and payloads are not."""

import math

from dynamics_node.safety import EffortAtRest
import numpy as np
import pytest

NAMES = ('shoulder', 'elbow', 'wrist')
LIMITS = (90.0, 40.0, 10.0)
G = np.array([-40.0, 15.0, 0.5])  # N m


def rest(unit, effort, torque=G, seconds=2.5, start=0.0, velocity=0.001):
    """Let the arm stand for a time; return whether something was found out."""
    found = [
        unit.update(time, np.full(len(torque), velocity), np.array(effort), torque)
        for time in start + np.arange(0.0, seconds, 0.1)
    ]
    return any(found)


@pytest.mark.parametrize(
    'effort',
    [G, 1.4 * G, 0.7 * G, G + [15.0, 5.0, 5.0]],
    ids=['torque', 'payload', 'lighter', 'contact'],
)
def test_what_can_be_torque_is_believed(effort):
    unit = EffortAtRest(NAMES, LIMITS)
    assert rest(unit, effort)
    assert unit.doubt == ''


@pytest.mark.parametrize(
    'effort',
    [0.0 * G, -G, 0.08 * G, 1000.0 * G, [0.1, -0.2, 0.0]],
    ids=['zeros', 'other sign', 'current', 'thousandths', 'without gravity'],
)
def test_what_can_hardly_be_torque_is_doubted_with_both_numbers(effort):
    unit = EffortAtRest(NAMES, LIMITS)
    assert rest(unit, effort)
    assert unit.doubt == (
        f'shoulder reports {effort[0] + 0.0:.4g} at rest, where the model says that -40 holds it'
    )


def test_the_doubt_goes_when_torque_comes():
    unit = EffortAtRest(NAMES, LIMITS)
    rest(unit, 0.0 * G)
    assert unit.doubt
    assert rest(unit, G, start=3.0)
    assert unit.doubt == ''


def test_nothing_is_said_before_the_arm_has_stood_for_a_while():
    unit = EffortAtRest(NAMES, LIMITS)
    assert not rest(unit, 0.0 * G, seconds=1.9)
    assert not unit.update(2.0, np.array([0.0, 0.0, 0.1]), 0.0 * G, G)  # it moves
    assert not rest(unit, 0.0 * G, start=2.1, seconds=1.9)
    assert unit.doubt == ''


def test_to_forget_begins_anew_and_keeps_the_doubt():
    unit = EffortAtRest(NAMES, LIMITS)
    rest(unit, 0.0 * G)
    unit.forget()
    rest(unit, G, start=3.0, seconds=1.9)
    unit.forget()
    assert not rest(unit, G, start=5.0, seconds=1.9)
    assert unit.doubt


@pytest.mark.parametrize(
    'torque, limits',
    [([2.6, 1.1, 0.29], LIMITS), ([0.09, 0.0, 0.0], [math.nan] * 3)],
    ids=['of their limits', 'without limits'],
)
def test_joints_that_carry_little_prove_nothing(torque, limits):
    unit = EffortAtRest(NAMES, limits)
    assert not rest(unit, np.zeros(3), np.array(torque))
    assert unit.doubt == ''
    assert rest(unit, np.zeros(3), 1.2 * np.array(torque), start=3.0)
    assert unit.doubt


def test_the_joint_that_carries_most_of_what_it_can_speaks():
    unit = EffortAtRest(NAMES, LIMITS)
    rest(unit, [-40.0, 0.0, 0.0], np.array([-40.0, 30.0, 0.5]))
    assert unit.doubt.startswith('elbow reports 0 at rest')


def test_noise_is_averaged():
    rng = np.random.default_rng(0)
    unit = EffortAtRest(NAMES, LIMITS)
    found = [unit.update(0.002 * i, np.zeros(3), rng.normal(G, 30.0), G) for i in range(1200)]
    assert any(found)
    assert unit.doubt == ''
