"""Pseudo-inertia matrices by their definition: numerical integration over the body."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

_Limits = tuple[float, float]


def pseudo_inertia_by_integration(
    density: float | Callable[[float, float, float], float],
    x_range: _Limits,
    y_range: _Limits | Callable[[float], _Limits],
    z_range: _Limits | Callable[[float, float], _Limits],
    order: int = 16,
) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of a body from its density, by a triple integral.

    Independent of the closed forms, to check them, and for bodies without closed form.

    Parameters
    ----------
    density : float or callable(x, y, z)
        Density in kg/m³, constant or at a point of the frame.
    x_range : (float, float)
        Outer limits of x, m.
    y_range : (float, float) or callable(x)
        Limits of y, m; a callable returns the pair at x.
    z_range : (float, float) or callable(x, y)
        Limits of z, m; a callable returns the pair at x, y.
    order : int
        Nodes per direction; 16 reaches machine precision if density and limits are smooth inside
        the ranges (limits may start and end with a vertical tangent, as those of a circle).

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J about the frame's origin: kg m², kg m, kg.

    References
    ----------
    docs/mathematics.md, equation (2): J = ∫ [x y z 1]ᵀ [x y z 1] dm.

    """
    rho = density if callable(density) else lambda x, y, z: density
    y_limits = y_range if callable(y_range) else lambda x: y_range
    z_limits = z_range if callable(z_range) else lambda x, y: z_range
    unit_nodes, unit_weights = _nodes(order)

    def on(limits: _Limits) -> Iterator[tuple[float, float]]:
        center, half = 0.5 * (limits[1] + limits[0]), 0.5 * (limits[1] - limits[0])
        return zip(center + half * unit_nodes, half * unit_weights, strict=True)

    matrix = np.zeros((4, 4))
    for x, weight_x in on(x_range):
        for y, weight_y in on(y_limits(x)):
            for z, weight_z in on(z_limits(x, y)):
                r = np.array([x, y, z, 1.0])
                matrix += weight_x * weight_y * weight_z * rho(x, y, z) * np.outer(r, r)
    return matrix


def _nodes(order: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # Gauss-Legendre in the angle of t = sin(angle): a boundary like sqrt(r² - y²), without
    # derivative at its ends, becomes a cosine and converges as fast as a smooth one.
    t, weights = np.polynomial.legendre.leggauss(order)
    angle = 0.5 * np.pi * t
    return np.sin(angle), weights * 0.5 * np.pi * np.cos(angle)
