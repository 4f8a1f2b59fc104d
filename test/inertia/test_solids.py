"""Numerical integration, and the closed forms of solids compared with it."""

from dynamics_node import ArgumentError
from dynamics_node.inertia import (
    box,
    check_physical,
    cylinder,
    inertia_tensor_at_com,
    pseudo_inertia_by_integration,
    sphere,
)
import numpy as np
import pytest


def _half_circle(radius):
    return lambda y: (-np.sqrt(radius**2 - y**2), np.sqrt(radius**2 - y**2))


def test_a_variable_density_is_integrated():
    # Density x over the unit cube: moments are products of ∫x^a dx = 1 / (a + 1).
    J = pseudo_inertia_by_integration(lambda x, y, z: x, (0, 1), (0, 1), (0, 1))
    np.testing.assert_allclose(
        J,
        [
            [1 / 4, 1 / 6, 1 / 6, 1 / 3],
            [1 / 6, 1 / 6, 1 / 8, 1 / 4],
            [1 / 6, 1 / 8, 1 / 6, 1 / 4],
            [1 / 3, 1 / 4, 1 / 4, 1 / 2],
        ],
        atol=1e-15,
    )


def test_more_nodes_do_not_change_the_result():
    def limits(x, y):
        return -np.sqrt(1 - y**2), np.sqrt(1 - y**2)

    coarse = pseudo_inertia_by_integration(1.0, (0, 1), (-1, 1), limits, order=12)
    fine = pseudo_inertia_by_integration(1.0, (0, 1), (-1, 1), limits, order=24)
    np.testing.assert_allclose(coarse, fine, atol=1e-13)


def test_the_cylinder_is_its_integral():
    m, r, length = 3.0, 0.2, 0.7
    circle = _half_circle(r)
    integral = pseudo_inertia_by_integration(
        m / (np.pi * r**2 * length), (-length / 2, length / 2), (-r, r), lambda x, y: circle(y)
    )
    # Integrated along x, the solid's axis is z: exchange the two.
    swap = [2, 1, 0, 3]
    np.testing.assert_allclose(integral[np.ix_(swap, swap)], cylinder(m, r, length), atol=1e-14)


def test_the_box_is_its_integral():
    integral = pseudo_inertia_by_integration(
        2.0 / (0.1 * 0.2 * 0.3), (-0.05, 0.05), (-0.1, 0.1), (-0.15, 0.15)
    )
    np.testing.assert_allclose(integral, box(2.0, (0.1, 0.2, 0.3)), atol=1e-15)


def test_the_sphere_is_its_integral():
    r = 0.3
    circle = _half_circle(r)
    integral = pseudo_inertia_by_integration(
        2.0 / (4 / 3 * np.pi * r**3),
        (-r, r),
        lambda x: circle(x),
        lambda x, y: (
            -np.sqrt(max(r**2 - x**2 - y**2, 0.0)),
            np.sqrt(max(r**2 - x**2 - y**2, 0.0)),
        ),
    )
    np.testing.assert_allclose(integral, sphere(2.0, r), atol=1e-14)


def test_tensors_are_those_of_the_textbook():
    m, r, length = 3.0, 0.2, 0.7
    np.testing.assert_allclose(
        np.diag(inertia_tensor_at_com(cylinder(m, r, length))),
        [m * (3 * r**2 + length**2) / 12] * 2 + [m * r**2 / 2],
        rtol=1e-14,
    )
    np.testing.assert_allclose(
        np.diag(inertia_tensor_at_com(sphere(m, r))), [2 / 5 * m * r**2] * 3, rtol=1e-14
    )
    np.testing.assert_allclose(
        np.diag(inertia_tensor_at_com(box(m, (1, 2, 3)))),
        m / 12 * np.array([13, 10, 5]),
        rtol=1e-14,
    )


def test_solids_are_physical_and_can_be_placed():
    shift = np.eye(4)
    shift[:3, 3] = 1, 2, 3
    for matrix in (cylinder(1, 1, 1, shift), box(1, (1, 1, 1), shift), sphere(1, 1, shift)):
        check_physical(matrix)
        np.testing.assert_allclose(matrix[:3, 3], [1, 2, 3])


@pytest.mark.parametrize(
    'call, name',
    [
        (lambda: cylinder(0.0, 1, 1), 'mass'),
        (lambda: cylinder(1, -1, 1), 'radius'),
        (lambda: box(1, (1, 1, np.nan)), 'size_z'),
        (lambda: sphere(1, np.inf), 'radius'),
        (lambda: box(1, (1, 1)), 'size'),
    ],
)
def test_a_size_that_is_not_positive_is_refused_by_name(call, name):
    with pytest.raises(ArgumentError, match=name):
        call()
