"""The specification itself: both forms of the Christoffel symbols, and derivatives."""

from dynamics_node import RobotModel
from dynamics_node.kernels import textbook
import numpy as np
import pytest
from support.robots import random_urdf

SEEDS = range(6)


@pytest.mark.parametrize('seed', SEEDS)
def test_both_forms_of_the_christoffel_symbols_agree(seed):
    model = RobotModel.from_urdf(random_urdf(seed))
    q = np.random.default_rng(seed).uniform(-2, 2, len(model.joint_names))
    by_derivatives = textbook.christoffel_symbols(model.tree, q)
    by_traces = textbook.christoffel_symbols_by_traces(model.tree, q)
    scale = np.abs(by_derivatives).max()
    np.testing.assert_allclose(by_traces, by_derivatives, atol=1e-14 * scale)


@pytest.mark.parametrize('seed', SEEDS)
def test_derivatives_of_transforms_are_those_of_finite_differences(seed):
    model = RobotModel.from_urdf(random_urdf(seed, with_mimic=False))
    n = len(model.joint_names)
    q = np.random.default_rng(seed).uniform(-2, 2, n)
    _, dA, ddA = textbook.link_transforms(model.tree, q)
    step = 1e-6
    for i in range(n):
        body = int(np.flatnonzero(model.tree.q_index == i)[0])
        change = np.zeros(n)
        change[i] = step
        ahead, behind = (
            textbook.link_transforms(model.tree, q + sign * change) for sign in (1, -1)
        )
        np.testing.assert_allclose(dA[:, body], (ahead[0] - behind[0]) / (2 * step), atol=1e-8)
        np.testing.assert_allclose(ddA[:, :, body], (ahead[1] - behind[1]) / (2 * step), atol=1e-8)


@pytest.mark.parametrize('seed', SEEDS)
def test_gravity_is_the_slope_of_the_potential(seed):
    model = RobotModel.from_urdf(random_urdf(seed))
    n = len(model.joint_names)
    q = np.random.default_rng(seed).uniform(-2, 2, n)
    G = textbook.gravity_torque(model.tree, q, model.gravity)
    step = 1e-6
    slope = [
        (
            textbook.potential_energy(model.tree, q + step * e, model.gravity)
            - textbook.potential_energy(model.tree, q - step * e, model.gravity)
        )
        / (2 * step)
        for e in np.eye(n)
    ]
    np.testing.assert_allclose(G, slope, atol=1e-6 * max(1.0, np.abs(G).max()))
