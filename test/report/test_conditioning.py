"""How well D can be inverted."""

from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed
from support.robots import ARM7, public_robot

UR5 = 'ur_description/urdf/ur5_robot.urdf'


def test_the_numbers_are_those_of_numpy():
    report = make_report(public_robot(UR5), samples=400)
    found, model = report.conditioning, report.model
    assert np.linalg.cond(model.mass_matrix(np.array(found.position))) == (
        pytest.approx(found.worst, rel=1e-6)
    )
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (3000, 6))
    numbers = np.linalg.cond(model.mass_matrix(q))
    assert np.median(numbers) == pytest.approx(found.median, rel=0.1)
    assert numbers.max() == pytest.approx(found.worst, rel=0.1)
    assert found.is_positive_definite and not found.has_mixed_units
    assert (found.samples, found.weakest_joint) == (400, 'wrist_3_joint')


def test_joints_that_slide_and_turn_have_mixed_units():
    assert make_report(ARM7, samples=50).conditioning.has_mixed_units


def test_a_joint_that_moves_nothing_makes_it_infinite():
    text = changed(changed(arm(), 'gripper', inertial=False), 'link5', inertial=False)
    found = make_report(text, samples=50).conditioning
    assert not found.is_positive_definite and found.worst == np.inf
    assert found.weakest_joint == 'joint5'
