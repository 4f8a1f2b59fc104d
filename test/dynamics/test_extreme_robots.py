"""Deliberately ill-conditioned robots: no NaN, and the errors stated in docs/accuracy.md."""

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.cross_library import QUANTITIES
from support.extreme_robots import chain, extreme_robots, FEATHER
from support.extreme_sweep import compare_extreme

ROBOTS = extreme_robots()

# Of every element of D, C, G and of inverse dynamics, and of the energies.
BOUND = 1e-11

# Forward dynamics loses the digits that the condition of D takes, here times a few roundings.
ROUNDINGS = 100 * np.finfo(float).eps


@pytest.mark.parametrize('name', ROBOTS)
def test_an_extreme_robot_keeps_its_digits(name):
    row = compare_extreme(name)
    errors = row.errors['library', 'exact']
    assert set(errors) == set(QUANTITIES)
    for quantity in ('D', 'C', 'G', 'ID', 'energy'):
        assert errors[quantity] <= BOUND, quantity
    assert errors['FD'] <= max(BOUND, ROUNDINGS * row.condition)


@pytest.mark.parametrize('name', ROBOTS)
def test_no_quantity_of_an_extreme_robot_is_nan(name):
    model = RobotModel.from_urdf(ROBOTS[name])
    n = len(model.joint_names)
    # Folded, straight, far out of all limits and at speeds that no motor reaches.
    for q in (np.zeros(n), np.full(n, np.pi), np.full(n, 1e4)):
        for qd in (np.zeros(n), np.full(n, 1e3), np.full(n, 1e-12)):
            D, C, G = model.dynamics(q, qd)
            assert all(np.isfinite(term).all() for term in (D, C, G))
            assert np.linalg.eigvalsh(D / np.sqrt(np.outer(D.diagonal(), D.diagonal())))[0] > 0
            tau = model.inverse_dynamics(q, qd, np.ones(n))
            assert np.isfinite(tau).all()
            assert np.isfinite(model.forward_dynamics(q, qd, tau)).all()
            assert np.isfinite(model.kinetic_energy(q, qd) + model.potential_energy(q))


def test_sliding_joints_have_neither_c_nor_a_changing_d():
    model = RobotModel.from_urdf(chain([FEATHER, 100.0] * 4, 'prismatic'))
    q, qd = np.random.default_rng(0).normal(size=(2, 8))
    D, C, G = model.dynamics(q, qd)
    np.testing.assert_array_equal(C, np.zeros((8, 8)))
    np.testing.assert_array_equal(model.mass_matrix(np.zeros(8)), D)
    np.testing.assert_array_equal(model.gravity_torque(np.zeros(8)), G)
