"""Identities of mechanics on random trees: each holds between two independent routes."""

import re

from dynamics_node import RobotModel
from dynamics_node.inertia.pseudo_inertia import rotation_from_rpy
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.robots import random_state, random_urdf

seeds = st.integers(0, 2**32 - 1)
on_random_trees = settings(deadline=None)


def sample(seed, **options):
    """Return a random model and a random state of it."""
    model = RobotModel.from_urdf(random_urdf(seed, **options))
    return model, *random_state(np.random.default_rng(seed), model)


def central(function, q, step=1e-5):
    """Return the derivatives of a function by each joint, by central differences (4th order)."""

    def one(e):
        return (
            8 * (function(q + step * e) - function(q - step * e))
            - (function(q + 2 * step * e) - function(q - 2 * step * e))
        ) / (12 * step)

    return [one(e) for e in np.eye(q.size)]


@on_random_trees
@given(seeds)
def test_the_mass_matrix_is_symmetric_and_positive_definite(seed):
    model, q, _ = sample(seed)
    D = model.mass_matrix(q)
    np.testing.assert_array_equal(D, D.T)
    assert np.linalg.eigvalsh(D)[0] > 0


@on_random_trees
@given(seeds)
def test_gravity_is_the_slope_of_the_potential_energy(seed):
    model, q, _ = sample(seed)
    G = model.gravity_torque(q)
    np.testing.assert_allclose(
        G, central(model.potential_energy, q), rtol=0, atol=1e-8 * max(1.0, np.abs(G).max())
    )


@on_random_trees
@given(seeds)
def test_the_rate_of_the_mass_matrix_is_c_plus_its_transpose(seed):
    model, q, qd = sample(seed)
    C = model.coriolis_matrix(q, qd)
    rate = sum(dD * speed for dD, speed in zip(central(model.mass_matrix, q), qd, strict=True))
    np.testing.assert_allclose(C + C.T, rate, atol=1e-7 * max(1.0, np.abs(C).max()))


@on_random_trees
@given(seeds)
def test_c_is_the_christoffel_matrix_from_finite_differences(seed):
    model, q, qd = sample(seed)
    dD = np.array(central(model.mass_matrix, q))  # dD[k, i, j] = ∂D_ij/∂q_k
    christoffel = 0.5 * (
        np.einsum('kij->ikj', dD) + np.einsum('jik->ikj', dD) - np.einsum('ijk->ikj', dD)
    )
    C = np.einsum('ikj,k->ij', christoffel, qd)
    np.testing.assert_allclose(
        model.coriolis_matrix(q, qd), C, atol=1e-7 * max(1.0, np.abs(C).max())
    )


@on_random_trees
@given(seeds)
def test_the_coriolis_matrix_is_zero_at_rest_and_linear_in_velocity(seed):
    model, q, qd = sample(seed)
    C = model.coriolis_matrix(q, qd)
    np.testing.assert_array_equal(model.coriolis_matrix(q, 0 * qd), np.zeros_like(C))
    np.testing.assert_allclose(
        model.coriolis_matrix(q, 2 * qd),
        2 * C,
        rtol=1e-12,
        atol=1e-13 * np.abs(C).max(initial=0.0),
    )


@on_random_trees
@given(seeds)
def test_doubling_all_masses_doubles_d_c_and_g(seed):
    model, q, qd = sample(seed)
    heavy = RobotModel.from_urdf(random_urdf(seed, mass_scale=2.0))
    for one, two in zip(model.dynamics(q, qd), heavy.dynamics(q, qd), strict=True):
        np.testing.assert_allclose(
            two, 2 * one, rtol=1e-12, atol=1e-13 * np.abs(one).max(initial=0.0)
        )


@on_random_trees
@given(seeds)
def test_listing_joints_in_another_order_permutes_rows_and_columns(seed):
    text = random_urdf(seed)
    model, q, qd = sample(seed)
    lines = text.split('\n')
    shuffled = [lines[0], *np.random.default_rng(seed).permutation(lines[1:-1]), lines[-1]]
    other = RobotModel.from_urdf('\n'.join(shuffled))
    order = [model.joint_names.index(name) for name in other.joint_names]
    D, C, G = model.dynamics(q, qd)
    D2, C2, G2 = other.dynamics(q[order], qd[order])
    for actual, expected in (
        (D2, D[np.ix_(order, order)]),
        (C2, C[np.ix_(order, order)]),
        (G2, G[order]),
    ):
        np.testing.assert_allclose(
            actual, expected, rtol=0, atol=1e-12 * max(1.0, np.abs(expected).max())
        )


@on_random_trees
@given(seeds)
def test_turning_base_and_gravity_together_changes_no_effort(seed):
    text = random_urdf(seed)
    model, q, qd = sample(seed)
    rpy = np.random.default_rng(seed).uniform(-3, 3, 3)
    turned = RobotModel.from_urdf(
        text.replace(
            '</robot>',
            '<link name="world"/><joint name="turn" type="fixed">'
            '<parent link="world"/><child link="base"/><origin xyz="1 2 3" '
            f'rpy="{rpy[0]} {rpy[1]} {rpy[2]}"/></joint></robot>',
        ),
        rotation_from_rpy(rpy) @ model.gravity,
    )
    for one, two in zip(model.dynamics(q, qd), turned.dynamics(q, qd), strict=True):
        np.testing.assert_allclose(two, one, rtol=0, atol=1e-11 * max(1.0, np.abs(one).max()))


@on_random_trees
@given(seeds)
def test_a_fixed_link_counts_as_part_of_the_link_that_carries_it(seed):
    # Two halves of a link's inertia, one of them on a fixed link in the same place.
    text = random_urdf(seed, with_mimic=False)
    model, q, qd = sample(seed, with_mimic=False)
    match = re.search(
        r'<link name="(link\d+)"><inertial>(.*?)<mass value="(.*?)"/>'
        r'<inertia (.*?)/></inertial></link>',
        text,
    )
    name, origin, mass, inertia = match.groups()
    numbers = re.sub(r'"([^"]+)"', lambda m: f'"{float(m[1]) / 2:.17g}"', inertia)
    half = (
        f'<inertial>{origin}<mass value="{float(mass) / 2:.17g}"/><inertia {numbers}/></inertial>'
    )
    split = text.replace(
        match[0],
        (
            f'<link name="{name}">{half}</link><link name="half">{half}</link>'
            f'<joint name="weld" type="fixed"><parent link="{name}"/><child link="half"/></joint>'
        ),
    )
    for one, two in zip(
        model.dynamics(q, qd), RobotModel.from_urdf(split).dynamics(q, qd), strict=True
    ):
        np.testing.assert_allclose(two, one, rtol=0, atol=1e-13 * max(1.0, np.abs(one).max()))


@on_random_trees
@given(seeds)
def test_mimic_joints_fold_the_matrices_of_the_free_robot(seed):
    text = random_urdf(seed, joints=8)
    model, q, qd = sample(seed, joints=8)
    free = RobotModel.from_urdf(re.sub(r'<mimic .*?/>', '', text))
    order = [model.tree.moving_joint_names.index(name) for name in free.joint_names]
    B, b = model.tree.mimic_matrix[order], model.tree.offset[order]
    D, C, G = free.dynamics(B @ q + b, B @ qd)
    for actual, expected in zip(
        model.dynamics(q, qd), (B.T @ D @ B, B.T @ C @ B, B.T @ G), strict=True
    ):
        np.testing.assert_allclose(
            actual, expected, rtol=0, atol=1e-12 * max(1.0, np.abs(expected).max())
        )


@on_random_trees
@given(seeds)
def test_forward_dynamics_undoes_inverse_dynamics(seed):
    model, q, qd = sample(seed, with_mimic=False)
    qdd = np.random.default_rng(seed).normal(size=q.size)
    tau = model.inverse_dynamics(q, qd, qdd)
    condition = np.linalg.cond(model.mass_matrix(q))
    np.testing.assert_allclose(
        model.forward_dynamics(q, qd, tau),
        qdd,
        rtol=0,
        atol=1e-13 * condition * max(1.0, np.abs(tau).max()),
    )


@on_random_trees
@given(seeds)
def test_energy_changes_by_the_power_of_the_efforts_at_every_state(seed):
    # dE/dt = q̇ᵀ τ, with dE/dt by differences along a curve that has q̇ and q̈ at time zero.
    model, q, qd = sample(seed)
    qdd = np.random.default_rng(seed).normal(size=q.size)

    def energy(time):
        at, speed = q + time * qd + 0.5 * time**2 * qdd, qd + time * qdd
        return model.kinetic_energy(at, speed) + model.potential_energy(at)

    step = 1e-4
    rate = (8 * (energy(step) - energy(-step)) - (energy(2 * step) - energy(-2 * step))) / (
        12 * step
    )
    tau = model.inverse_dynamics(q, qd, qdd)
    size = np.abs(qd) @ np.abs(tau) + abs(energy(0.0))
    assert rate == pytest.approx(qd @ tau, rel=0, abs=1e-9 * size)


# A whole motion takes as long as thirty of the others.
@settings(deadline=None, max_examples=max(1, settings.default.max_examples // 30))
@given(seeds)
def test_energy_changes_by_the_power_of_the_efforts_along_a_motion(seed):
    model, q, qd = sample(seed, joints=4, with_mimic=False)
    n = q.size
    tau = np.random.default_rng(seed).normal(size=n)

    def derivative(t, x):
        qd = x[n : 2 * n]
        return np.concatenate([qd, model.forward_dynamics(x[:n], qd, tau), [tau @ qd]])

    end = solve_ivp(
        derivative,
        (0.0, 0.5),
        np.concatenate([q, qd, [0.0]]),
        rtol=1e-11,
        atol=1e-11,
        method='DOP853',
    ).y[:, -1]

    def energy(q, qd):
        return model.kinetic_energy(q, qd) + model.potential_energy(q)

    change = energy(end[:n], end[n : 2 * n]) - energy(q, qd)
    assert change == pytest.approx(end[-1], abs=1e-7 * max(1.0, abs(energy(q, qd))))
