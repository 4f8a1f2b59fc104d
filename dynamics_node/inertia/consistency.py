"""Physical consistency: whether a real body exists for a pseudo-inertia matrix."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pseudo_inertia import inertia_tensor_at_com, symmetric
from ..errors import ArgumentError, InertiaError

# Largest change of an eigenvalue by rounding, relative to the trace of J.
RELATIVE_TOLERANCE = 10.0 * np.finfo(float).eps


@dataclass(frozen=True)
class ConsistencyReport:
    """
    Physical consistency of one pseudo-inertia matrix.

    Attributes
    ----------
    violations : tuple of str
        One sentence per violated condition: expected, got. Empty for a real body.
    smallest_eigenvalue : float
        Smallest eigenvalue of J; NaN if J has entries that are not finite. A real body exists
        exactly when it is >= 0 (to rounding).
    principal_moments : numpy.ndarray, shape (3,)
        Principal moments of inertia about the center of mass, kg m², ascending.

    """

    violations: tuple[str, ...]
    smallest_eigenvalue: float
    principal_moments: NDArray[np.float64]

    @property
    def is_physical(self) -> bool:
        """True if no condition is violated."""
        return not self.violations


def consistency_report(matrix: ArrayLike) -> ConsistencyReport:
    """
    Check a pseudo-inertia matrix and list every violated condition.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J in any frame; the result does not depend on the frame.

    Returns
    -------
    ConsistencyReport
        NaN, asymmetry and negative mass are violations, no exceptions.

    Raises
    ------
    ArgumentError
        If the shape is not (4, 4).

    References
    ----------
    docs/mathematics.md, section 2: a real body exists exactly when J is positive semidefinite.

    """
    matrix = np.asarray(matrix, dtype=float)
    if matrix.shape != (4, 4):
        raise ArgumentError(f'pseudo-inertia: expected shape (4, 4), got {matrix.shape}')
    if not np.all(np.isfinite(matrix)):
        return ConsistencyReport(
            ('J has entries that are not finite',), np.nan, np.full(3, np.nan)
        )
    scale = np.abs(matrix).max()
    violations = []
    if np.abs(matrix - matrix.T).max() > RELATIVE_TOLERANCE * scale:
        violations.append(
            'J is not symmetric: J and its transpose differ by '
            f'{np.abs(matrix - matrix.T).max():.3g}'
        )
    if matrix[3, 3] < 0.0:
        violations.append(f'mass is {matrix[3, 3]:.6g} kg, must be >= 0')
    tensor = symmetric(inertia_tensor_at_com(matrix))
    principal = np.asarray(np.linalg.eigvalsh(tensor), dtype=float)
    violations.extend(tensor_violations(principal, rounding_of(matrix)))
    smallest = float(np.linalg.eigvalsh(symmetric(matrix))[0])
    if smallest < -rounding_of(matrix):
        violations.append(f'smallest eigenvalue of J is {smallest:.3g}, must be >= 0')
    return ConsistencyReport(tuple(violations), smallest, principal)


def rounding_of(matrix: NDArray[np.float64]) -> float:
    """Return the largest rounding error of an eigenvalue of J, shape (4, 4), kg m²."""
    return RELATIVE_TOLERANCE * float(np.abs(np.trace(matrix)))


def tensor_violations(principal: NDArray[np.float64], tolerance: float) -> list[str]:
    """
    Return the conditions that principal moments of inertia violate.

    Parameters
    ----------
    principal : numpy.ndarray, shape (3,)
        Principal moments about the center of mass, kg m², ascending.
    tolerance : float
        kg m²; see `rounding_of`.

    Returns
    -------
    list of str
        One sentence each; empty for a real body.

    """
    smallest, middle, largest = principal
    if smallest < -tolerance:
        return [f'smallest principal moment of inertia is {smallest:.3g} kg m^2, must be >= 0']
    if largest > smallest + middle + tolerance:
        return [
            'principal moments of inertia violate the triangle inequality: '
            f'{largest:.6g} > {smallest:.6g} + {middle:.6g} kg m^2'
        ]
    return []


def check_physical(matrix: ArrayLike) -> None:
    """
    Raise if no real body exists for a pseudo-inertia matrix.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J in any frame.

    Raises
    ------
    InertiaError
        With all violated conditions.
    ArgumentError
        If the shape is not (4, 4).

    """
    report = consistency_report(matrix)
    if not report.is_physical:
        raise InertiaError(report.violations)
