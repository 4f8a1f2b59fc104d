"""The definition by numerical integration."""

from dynamics_node.inertia import pseudo_inertia_by_integration
import numpy as np


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
