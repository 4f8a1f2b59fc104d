"""The three terms of the equation of motion, together."""

from typing import NamedTuple

import numpy as np


class DynamicsTerms(NamedTuple):
    """
    The three terms of D(q) q̈ + C(q, q̇) q̇ + G(q) = τ.

    Attributes
    ----------
    mass_matrix : numpy.ndarray, shape (..., n, n)
        D, kg m² / kg m / kg.
    coriolis_matrix : numpy.ndarray, shape (..., n, n)
        C of Christoffel symbols, effort unit per velocity unit.
    gravity_torque : numpy.ndarray, shape (..., n)
        G, N m or N.

    """

    mass_matrix: np.ndarray
    coriolis_matrix: np.ndarray
    gravity_torque: np.ndarray
