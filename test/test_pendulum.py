"""
The lecture's pendulum, from its URDF, to machine precision.

J from the closed form, from the URDF and from the integral; D; C = 0; and G with the sign that
holds the pendulum up (the lecture's own G pushes it down).

"""

from dynamics_node import RobotModel
from dynamics_node.inertia import cylinder, pseudo_inertia_by_integration
from dynamics_node.kernels import textbook
from dynamics_node.urdf import read_urdf
import numpy as np
import pytest
from support.robots import PENDULUM

M, L, R, g = 3.0, 0.7, 0.05, 9.81
EPS = np.finfo(float).eps

# The lecture's J of the rod about its far end.
LECTURE_J = np.array(
    [
        [M * L**2 / 3, 0, 0, -M * L / 2],
        [0, M * R**2 / 4, 0, 0],
        [0, 0, M * R**2 / 4, 0],
        [-M * L / 2, 0, 0, M],
    ]
)
ANGLES = np.linspace(-7.0, 7.0, 101)[:, None]


@pytest.fixture(scope='module')
def pendulum():
    return RobotModel.from_urdf(PENDULUM)


def test_the_urdf_has_the_lectures_pseudo_inertia():
    rod = next(link for link in read_urdf(PENDULUM).links if link.name == 'rod')
    np.testing.assert_allclose(rod.inertial.pseudo_inertia, LECTURE_J, rtol=0, atol=4 * EPS)


def test_the_recursive_of_the_cylinder_is_the_lectures_pseudo_inertia():
    along_x = np.array([[0, 0, 1, -L / 2], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(cylinder(M, R, L, along_x), LECTURE_J, rtol=0, atol=4 * EPS)


def test_the_lectures_integral_is_the_lectures_pseudo_inertia():
    integral = pseudo_inertia_by_integration(
        M / (L * np.pi * R**2),
        (-L, 0.0),
        (-R, R),
        lambda x, y: (-np.sqrt(R**2 - y**2), np.sqrt(R**2 - y**2)),
    )
    np.testing.assert_allclose(integral, LECTURE_J, rtol=0, atol=20 * EPS)


def test_the_mass_matrix_is_the_lectures(pendulum):
    expected = M * L**2 / 3 + M * R**2 / 4
    np.testing.assert_allclose(pendulum.mass_matrix(ANGLES), expected, rtol=8 * EPS)
    np.testing.assert_allclose(
        textbook.mass_matrix(pendulum.tree, ANGLES[3]), expected, rtol=8 * EPS
    )


def test_the_coriolis_matrix_is_zero(pendulum):
    C = pendulum.coriolis_matrix(ANGLES, np.full_like(ANGLES, 3.0))
    np.testing.assert_allclose(C, 0.0, atol=8 * EPS)


def test_gravity_torque_holds_the_pendulum_up(pendulum):
    # +1/2 M l g cos q: positive where the rod points forward, because the torque must lift.
    expected = 0.5 * M * L * g * np.cos(ANGLES)
    np.testing.assert_allclose(
        pendulum.gravity_torque(ANGLES), expected, rtol=0, atol=16 * EPS * M * L * g
    )
    assert pendulum.gravity_torque([0.0])[0] > 10.0
    np.testing.assert_allclose(
        textbook.gravity_torque(pendulum.tree, ANGLES[3], pendulum.gravity),
        expected[3],
        atol=16 * EPS * M * L * g,
    )


def test_the_uncorrected_formula_of_the_lecture_has_the_wrong_sign(pendulum):
    # (r, 0) instead of (r, 1), in the lecture's own frames: -1/2 M l g cos q.
    q = 0.4
    c, s = np.cos(q), np.sin(q)
    dA = np.array([[-s, -c, 0, -L * s], [c, -s, 0, L * c], [0] * 4, [0] * 4])
    gravity = np.array([0.0, -g, 0.0, 0.0])
    wrong = -M * gravity @ dA @ [-L / 2, 0, 0, 0]
    right = -M * gravity @ dA @ [-L / 2, 0, 0, 1]
    assert wrong == pytest.approx(-0.5 * M * L * g * c)
    assert right == pytest.approx(pendulum.gravity_torque([q])[0])


def test_the_potential_energy_is_highest_on_top(pendulum):
    height = L / 2 * np.sin(ANGLES[:, 0])
    np.testing.assert_allclose(pendulum.potential_energy(ANGLES), M * g * height, atol=1e-14)
