"""The homogeneous box with the same mass and inertia as a body."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .consistency import check_physical
from .pseudo_inertia import mass_and_com, symmetric
from ..errors import InertiaError


@dataclass(frozen=True)
class EquivalentBox:
    """
    A homogeneous box with the mass and inertia of a body.

    Attributes
    ----------
    mass : float
        kg, > 0.
    size : numpy.ndarray, shape (3,)
        Edges, m, ascending; 0 across a flat, thin or point-like body.
    pose : numpy.ndarray, shape (4, 4)
        Frame of the box (origin in its center, axes along its edges) → frame of the body, m.

    """

    mass: float
    size: NDArray[np.float64]
    pose: NDArray[np.float64]


def equivalent_box(matrix: ArrayLike) -> EquivalentBox:
    """
    Return the homogeneous box with the pseudo-inertia matrix of a body.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J of the body in its own frame.

    Returns
    -------
    EquivalentBox

    Raises
    ------
    InertiaError
        If J is physically impossible, with all violated conditions, or the mass is 0.
    ArgumentError
        If the shape is not (4, 4).

    References
    ----------
    docs/mathematics.md, equation (35): edges sqrt(12 sigma_i / m) along the principal axes.

    """
    matrix = np.asarray(matrix, dtype=float)
    check_physical(matrix)
    mass, com = mass_and_com(matrix)
    if mass == 0.0:
        raise InertiaError(('mass is 0 kg, expected > 0: a body without mass has no box',))
    sigma = matrix[:3, :3] - mass * np.outer(com, com)
    moments, axes = np.linalg.eigh(symmetric(sigma))
    pose = np.eye(4)
    pose[:3, :3] = axes * np.linalg.det(axes)  # right-handed, as frames are
    pose[:3, 3] = com
    # Rounding may give a flat body a negative second moment.
    return EquivalentBox(mass, np.sqrt(12.0 * np.maximum(moments, 0.0) / mass), pose)
