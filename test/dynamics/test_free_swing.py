"""Closed loop: an arm integrated with forward dynamics keeps its energy, as in MuJoCo."""

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.free_swing import ARMS, energy_drift, free_arm, integrate, starting_position, swing

# The integrator's tolerance of 1e-12 for one step, over some thousand steps.
DRIFT = 1e-10


@pytest.mark.parametrize('name', ARMS)
def test_a_free_swing_keeps_its_energy(name):
    result = swing(name)
    assert result.kinetic > 5.0  # J: the arm really swings.
    assert result.drift <= DRIFT


@pytest.mark.parametrize('name', ARMS)
def test_mujoco_accelerates_the_same_along_the_swing(name):
    assert swing(name).mujoco <= 1e-11


def test_the_drift_of_energy_comes_from_the_integrator():
    # Ten thousand times the tolerance: the drift grows with it, so little of it is ours.
    model = RobotModel.from_urdf(free_arm('UR5'))
    coarse = integrate(model.forward_dynamics, starting_position(model), tolerance=1e-8)
    assert energy_drift(model, coarse)[1] > 100 * swing('UR5').drift


def test_a_wrong_coriolis_term_makes_the_energy_drift():
    model = RobotModel.from_urdf(free_arm('UR5'))

    def with_too_little_of_it(q, qd, tau):
        return model.forward_dynamics(q, 0.999 * qd, tau)

    wrong = integrate(with_too_little_of_it, starting_position(model), tolerance=1e-8)
    assert energy_drift(model, wrong)[1] > 1e-4


def test_a_swing_ends_where_it_began_when_time_runs_backwards():
    # Mechanics without friction is reversible: turn all speeds round and the arm comes back.
    model = RobotModel.from_urdf(free_arm('UR5'))
    start = starting_position(model)
    end = integrate(model.forward_dynamics, start).y[:, -1]
    n = start.size
    back = integrate(model.forward_dynamics, end[:n], speeds=-end[n:]).y[:, -1]
    np.testing.assert_allclose(back[:n], start, rtol=0, atol=1e-6)
    np.testing.assert_allclose(back[n:], np.zeros(n), rtol=0, atol=1e-6)
