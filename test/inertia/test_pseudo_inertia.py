"""Pseudo-inertia matrices: built, decomposed, transformed and added."""

from dynamics_node import ArgumentError
from dynamics_node.inertia import (
    axial_moments,
    combine,
    cylinder,
    inertia_tensor_at_com,
    mass_and_com,
    planar_moments,
    pseudo_inertia,
    steiner,
    transform_pseudo_inertia,
)
from dynamics_node.inertia.pseudo_inertia import rotation_from_rpy
import numpy as np
import pytest

TENSOR = np.array([[0.3, -0.02, 0.01], [-0.02, 0.4, 0.03], [0.01, 0.03, 0.35]])
COM = np.array([0.1, -0.2, 0.3])


def _transform(seed):
    rng = np.random.default_rng(seed)
    transform = np.eye(4)
    transform[:3, :3] = rotation_from_rpy(rng.uniform(-3, 3, 3))
    transform[:3, 3] = rng.normal(size=3)
    return transform


def test_planar_and_axial_moments_are_inverse_to_each_other():
    sigma = planar_moments(TENSOR)
    np.testing.assert_allclose(axial_moments(sigma), TENSOR, atol=1e-16)
    # The lecture's relations, written out.
    Ix, Iy, Iz = np.diag(TENSOR)
    assert sigma[0, 0] == pytest.approx((Iy + Iz - Ix) / 2, rel=1e-15)
    assert sigma[1, 1] == pytest.approx((Ix + Iz - Iy) / 2, rel=1e-15)
    assert sigma[2, 2] == pytest.approx((Ix + Iy - Iz) / 2, rel=1e-15)
    assert Ix == pytest.approx(sigma[1, 1] + sigma[2, 2], rel=1e-15)


def test_products_of_inertia_change_sign_between_tensor_and_planar_moments():
    assert planar_moments(TENSOR)[0, 1] == -TENSOR[0, 1]


def test_mass_com_and_tensor_are_recovered():
    matrix = pseudo_inertia(2.5, COM, TENSOR)
    mass, com = mass_and_com(matrix)
    assert mass == 2.5
    np.testing.assert_allclose(com, COM, rtol=1e-15)
    np.testing.assert_allclose(inertia_tensor_at_com(matrix), TENSOR, atol=1e-15)
    np.testing.assert_array_equal(matrix, matrix.T)


def test_rpy_turns_the_tensor_but_not_the_center_of_mass():
    rpy = (0.3, -0.4, 1.2)
    matrix = pseudo_inertia(2.5, COM, TENSOR, rpy)
    R = rotation_from_rpy(rpy)
    np.testing.assert_allclose(inertia_tensor_at_com(matrix), R @ TENSOR @ R.T, atol=1e-15)
    np.testing.assert_allclose(mass_and_com(matrix)[1], COM, rtol=1e-15)


def test_rpy_is_about_fixed_axes_x_then_y_then_z():
    roll, pitch, yaw = 0.3, -0.4, 1.2
    Rx = rotation_from_rpy((roll, 0, 0))
    Ry = rotation_from_rpy((0, pitch, 0))
    Rz = rotation_from_rpy((0, 0, yaw))
    np.testing.assert_allclose(rotation_from_rpy((roll, pitch, yaw)), Rz @ Ry @ Rx, atol=1e-16)
    np.testing.assert_allclose(Rx @ [0, 1, 0], [0, np.cos(roll), np.sin(roll)], atol=1e-16)
    np.testing.assert_allclose(Rz @ [1, 0, 0], [np.cos(yaw), np.sin(yaw), 0], atol=1e-16)


def test_steiner_agrees_with_moving_the_pseudo_inertia():
    matrix = pseudo_inertia(2.5, COM, TENSOR)
    np.testing.assert_allclose(
        axial_moments(matrix[:3, :3]), steiner(TENSOR, 2.5, COM), atol=1e-15
    )


def test_moving_to_another_frame_keeps_mass_and_principal_moments():
    matrix = pseudo_inertia(2.5, COM, TENSOR)
    transform = _transform(1)
    moved = transform_pseudo_inertia(matrix, transform)
    np.testing.assert_allclose(
        mass_and_com(moved)[1], transform[:3, :3] @ COM + transform[:3, 3], atol=1e-15
    )
    np.testing.assert_allclose(
        np.linalg.eigvalsh(inertia_tensor_at_com(moved)), np.linalg.eigvalsh(TENSOR), rtol=1e-13
    )


def test_two_halves_of_a_cylinder_are_the_cylinder():
    shift = np.eye(4)
    shift[2, 3] = 0.25
    back = np.linalg.inv(shift)
    half = cylinder(1.5, 0.1, 0.5)
    np.testing.assert_allclose(
        combine([(half, shift), (half, back)]), cylinder(3.0, 0.1, 1.0), atol=1e-16
    )


def test_the_sum_of_no_bodies_is_zero():
    np.testing.assert_array_equal(combine([]), np.zeros((4, 4)))


def test_a_body_without_mass_has_its_center_at_the_origin():
    mass, com = mass_and_com(np.zeros((4, 4)))
    assert mass == 0.0
    np.testing.assert_array_equal(com, np.zeros(3))


@pytest.mark.parametrize(
    'call, message',
    [
        (lambda: planar_moments(np.eye(4)), r'expected shape \(3, 3\), got \(4, 4\)'),
        (lambda: pseudo_inertia(1, [0, 0], TENSOR), r'center of mass: expected shape \(3,\)'),
        (lambda: mass_and_com(np.eye(3)), r'pseudo-inertia: expected shape \(4, 4\)'),
        (lambda: transform_pseudo_inertia(np.eye(4), np.eye(3)), r'transform: expected shape'),
    ],
)
def test_a_wrong_shape_is_refused_with_the_expected_one(call, message):
    with pytest.raises(ArgumentError, match=message):
        call()
