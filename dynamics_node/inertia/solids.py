"""Closed forms of the pseudo-inertia matrices of homogeneous solids."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pseudo_inertia import transform_pseudo_inertia
from ..errors import ArgumentError


def cylinder(
    mass: float, radius: float, length: float, transform: ArrayLike | None = None
) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of a homogeneous cylinder along the z axis.

    Parameters
    ----------
    mass : float
        kg, > 0.
    radius, length : float
        m, > 0.
    transform : array_like, shape (4, 4), optional
        Frame of the cylinder (origin in its center, axis z) → frame of the result, m.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J; in its own frame diag(m r²/4, m r²/4, m l²/12, m).

    Raises
    ------
    ArgumentError
        If a value is not finite and > 0.

    References
    ----------
    docs/mathematics.md, equation (2), integrated by hand.

    """
    _positive(mass=mass, radius=radius, length=length)
    across = radius**2 / 4.0
    return _placed(mass, (across, across, length**2 / 12.0), transform)


def box(mass: float, size: ArrayLike, transform: ArrayLike | None = None) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of a homogeneous box.

    Parameters
    ----------
    mass : float
        kg, > 0.
    size : array_like, shape (3,)
        Edge lengths along x, y, z, m, > 0.
    transform : array_like, shape (4, 4), optional
        Frame of the box (origin in its center) → frame of the result, m.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J; in its own frame diag(m a²/12, m b²/12, m c²/12, m).

    Raises
    ------
    ArgumentError
        If a value is not finite and > 0, or the shape of size is not (3,).

    References
    ----------
    docs/mathematics.md, equation (2), integrated by hand.

    """
    edges = np.asarray(size, dtype=float)
    if edges.shape != (3,):
        raise ArgumentError(f'size: expected shape (3,), got {edges.shape}')
    _positive(mass=mass, size_x=edges[0], size_y=edges[1], size_z=edges[2])
    return _placed(mass, edges**2 / 12.0, transform)


def sphere(mass: float, radius: float, transform: ArrayLike | None = None) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of a homogeneous sphere.

    Parameters
    ----------
    mass : float
        kg, > 0.
    radius : float
        m, > 0.
    transform : array_like, shape (4, 4), optional
        Frame of the sphere (origin in its center) → frame of the result, m.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J; in its own frame diag(m r²/5, m r²/5, m r²/5, m).

    Raises
    ------
    ArgumentError
        If a value is not finite and > 0.

    References
    ----------
    docs/mathematics.md, equation (2), integrated by hand.

    """
    _positive(mass=mass, radius=radius)
    return _placed(mass, np.full(3, radius**2 / 5.0), transform)


def _placed(
    mass: float, second_moments_per_mass: Iterable[float], transform: ArrayLike | None
) -> NDArray[np.float64]:
    matrix = mass * np.diag([*second_moments_per_mass, 1.0])
    return matrix if transform is None else transform_pseudo_inertia(matrix, transform)


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (np.isfinite(value) and value > 0.0):
            raise ArgumentError(f'{name}: expected a finite number > 0, got {value}')
