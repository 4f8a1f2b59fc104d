"""Physical consistency: whether a real body exists for a pseudo-inertia matrix."""

from dataclasses import dataclass

import numpy as np

from .pseudo_inertia import inertia_tensor_at_com
from ..errors import ArgumentError, InertiaError

# Rounding moves eigenvalues by this much, relative to the trace of J.
RELATIVE_TOLERANCE = 10.0 * np.finfo(float).eps


@dataclass(frozen=True)
class ConsistencyReport:
    """
    What was found about one pseudo-inertia matrix.

    Attributes
    ----------
    violations : tuple of str
        One sentence per violated condition: expected, got. Empty for a real body.
    smallest_eigenvalue : float
        Of J; NaN if J has entries that are not finite. A real body exists exactly when it
        is >= 0 (to rounding).
    principal_moments : numpy.ndarray, shape (3,)
        Principal moments of inertia about the center of mass, kg m², ascending.

    """

    violations: tuple
    smallest_eigenvalue: float
    principal_moments: np.ndarray

    @property
    def is_physical(self):
        """True if no condition is violated."""
        return not self.violations


def consistency_report(matrix):
    """
    Judge a pseudo-inertia matrix and name every condition that it violates.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J in any frame: the verdict does not depend on the frame.

    Returns
    -------
    ConsistencyReport
        Never raises for wrong values: NaN, asymmetry and negative mass are violations.

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
    principal = np.linalg.eigvalsh(_symmetric(inertia_tensor_at_com(matrix)))
    violations.extend(tensor_violations(principal, rounding_of(matrix)))
    smallest = float(np.linalg.eigvalsh(_symmetric(matrix))[0])
    if smallest < -rounding_of(matrix):
        violations.append(f'smallest eigenvalue of J is {smallest:.3g}, must be >= 0')
    return ConsistencyReport(tuple(violations), smallest, principal)


def rounding_of(matrix):
    """Return how far rounding may move an eigenvalue of a pseudo-inertia matrix below 0."""
    return RELATIVE_TOLERANCE * float(np.abs(np.trace(matrix)))


def tensor_violations(principal, tolerance):
    """
    Name the conditions that the principal moments of inertia violate.

    Parameters
    ----------
    principal : array_like, shape (3,)
        Principal moments about the center of mass, kg m², ascending.
    tolerance : float
        kg m²; see `rounding_of`.

    Returns
    -------
    list of str
        Empty if they are those of a real body.

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


def check_physical(matrix):
    """
    Raise if no real body exists for a pseudo-inertia matrix.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J in any frame.

    Raises
    ------
    InertiaError
        With every violated condition.
    ArgumentError
        If the shape is not (4, 4).

    """
    report = consistency_report(matrix)
    if not report.is_physical:
        raise InertiaError(report.violations)


def _symmetric(matrix):
    return 0.5 * (matrix + matrix.T)
