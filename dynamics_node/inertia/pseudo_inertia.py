"""Pseudo-inertia matrices: build, decompose, transform, add."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ArgumentError


def planar_moments(tensor: ArrayLike) -> NDArray[np.float64]:
    """
    Return the second moments about planes from the inertia tensor about axes.

    Both are taken about the same point, in the same frame.

    Parameters
    ----------
    tensor : array_like, shape (3, 3)
        Inertia tensor I, kg m², off-diagonal entries -∫xy dm as in URDF.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        Sigma = ∫ r rᵀ dm, kg m², off-diagonal entries +∫xy dm.

    Raises
    ------
    ArgumentError
        If the shape is not (3, 3).

    References
    ----------
    docs/mathematics.md, equation (3): Sigma = ½ tr(I) 1 - I.

    """
    tensor = _shaped('inertia tensor', tensor, (3, 3))
    trace: float = np.trace(tensor)
    return 0.5 * trace * np.eye(3) - tensor


def axial_moments(sigma: ArrayLike) -> NDArray[np.float64]:
    """
    Return the inertia tensor about axes from the second moments about planes.

    Parameters
    ----------
    sigma : array_like, shape (3, 3)
        Sigma = ∫ r rᵀ dm, kg m².

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        Inertia tensor I, kg m², about the same point, in the same frame.

    Raises
    ------
    ArgumentError
        If the shape is not (3, 3).

    References
    ----------
    docs/mathematics.md, equation (3): I = tr(Sigma) 1 - Sigma.

    """
    sigma = _shaped('matrix of planar moments', sigma, (3, 3))
    trace: float = np.trace(sigma)
    return trace * np.eye(3) - sigma


def steiner(tensor_at_com: ArrayLike, mass: float, com: ArrayLike) -> NDArray[np.float64]:
    """
    Return the inertia tensor about the frame's origin from the one about the center of mass.

    Parameters
    ----------
    tensor_at_com : array_like, shape (3, 3)
        Inertia tensor about the center of mass, kg m².
    mass : float
        Mass, kg.
    com : array_like, shape (3,)
        Center of mass r in the frame, m.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        Inertia tensor about the frame's origin, kg m², same axes.

    Raises
    ------
    ArgumentError
        If a shape is wrong.

    References
    ----------
    docs/mathematics.md, equation (4): I_o = I_c + m (rᵀr 1 - r rᵀ), Steiner's theorem.

    """
    tensor_at_com = _shaped('inertia tensor', tensor_at_com, (3, 3))
    r = _shaped('center of mass', com, (3,))
    return tensor_at_com + mass * (r @ r * np.eye(3) - np.outer(r, r))


def pseudo_inertia(
    mass: float, com: ArrayLike, tensor_at_com: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)
) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of a body from the values of a URDF <inertial>.

    The values are not checked; see `check_physical`.

    Parameters
    ----------
    mass : float
        Mass m, kg.
    com : array_like, shape (3,)
        Center of mass in the link frame, m.
    tensor_at_com : array_like, shape (3, 3)
        Inertia tensor about the center of mass, in the inertial frame, kg m².
    rpy : array_like, shape (3,)
        Roll, pitch and yaw of the inertial frame in the link frame, rad, fixed axes.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        J = [[Sigma, h], [hᵀ, m]] about the link frame's origin: kg m², kg m, kg.

    Raises
    ------
    ArgumentError
        If a shape is wrong.

    References
    ----------
    docs/mathematics.md, equations (2) to (4).

    """
    r = _shaped('center of mass', com, (3,))
    rotation = rotation_from_rpy(rpy)
    tensor = rotation @ _shaped('inertia tensor', tensor_at_com, (3, 3)) @ rotation.T
    matrix = np.empty((4, 4))
    matrix[:3, :3] = planar_moments(tensor) + mass * np.outer(r, r)
    matrix[:3, 3] = matrix[3, :3] = mass * r
    matrix[3, 3] = mass
    return matrix


def mass_and_com(matrix: ArrayLike) -> tuple[float, NDArray[np.float64]]:
    """
    Return mass and center of mass from a pseudo-inertia matrix.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        Pseudo-inertia J in some frame.

    Returns
    -------
    mass : float
        kg.
    com : numpy.ndarray, shape (3,)
        In the same frame, m; zeros for a body without mass.

    Raises
    ------
    ArgumentError
        If the shape is not (4, 4).

    """
    matrix = _shaped('pseudo-inertia', matrix, (4, 4))
    mass = float(matrix[3, 3])
    return mass, matrix[:3, 3] / mass if mass != 0.0 else np.zeros(3)


def inertia_tensor_at_com(matrix: ArrayLike) -> NDArray[np.float64]:
    """
    Return the inertia tensor about the center of mass from a pseudo-inertia matrix.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        Pseudo-inertia J in some frame.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        I_c, kg m², in the axes of that frame.

    Raises
    ------
    ArgumentError
        If the shape is not (4, 4).

    References
    ----------
    docs/mathematics.md, equations (3) and (4), solved for I_c.

    """
    matrix = _shaped('pseudo-inertia', matrix, (4, 4))
    mass, com = mass_and_com(matrix)
    return axial_moments(matrix[:3, :3] - mass * np.outer(com, com))


def transform_pseudo_inertia(matrix: ArrayLike, transform: ArrayLike) -> NDArray[np.float64]:
    """
    Return a pseudo-inertia matrix in another frame.

    Parameters
    ----------
    matrix : array_like, shape (4, 4)
        J of the body in its own frame.
    transform : array_like, shape (4, 4)
        Homogeneous transform T, body frame → new frame, m.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        T J Tᵀ, exactly symmetric.

    Raises
    ------
    ArgumentError
        If a shape is wrong.

    References
    ----------
    docs/mathematics.md, equation (5).

    """
    matrix = _shaped('pseudo-inertia', matrix, (4, 4))
    transform = _shaped('transform', transform, (4, 4))
    return symmetric(transform @ matrix @ transform.T)


def combine(bodies: Iterable[tuple[ArrayLike, ArrayLike]]) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia matrix of rigidly joined bodies.

    Parameters
    ----------
    bodies : iterable of (matrix, transform)
        J of each body, shape (4, 4), and its transform to the common frame, shape (4, 4), m.

    Returns
    -------
    numpy.ndarray, shape (4, 4)
        Sum of T J Tᵀ; zeros without bodies.

    Raises
    ------
    ArgumentError
        If a shape is wrong.

    References
    ----------
    docs/mathematics.md, equation (5).

    """
    total = np.zeros((4, 4))
    for matrix, transform in bodies:
        total += transform_pseudo_inertia(matrix, transform)
    return total


def rotation_from_rpy(rpy: ArrayLike) -> NDArray[np.float64]:
    """
    Return the rotation of URDF's roll, pitch, yaw (about the fixed x, then y, then z axis).

    Parameters
    ----------
    rpy : array_like, shape (3,)
        rad.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        R = Rz(yaw) Ry(pitch) Rx(roll).

    Raises
    ------
    ArgumentError
        If the shape is not (3,).

    """
    roll, pitch, yaw = _shaped('rpy', rpy, (3,))
    cr, sr = np.cos(roll), np.sin(roll)
    cp, sp = np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def symmetric(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the symmetric part of a square matrix: removes an asymmetry by rounding."""
    result: NDArray[np.float64] = 0.5 * (matrix + matrix.T)
    return result


def _shaped(name: str, value: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
    array = np.asarray(value, dtype=float)
    if array.shape != shape:
        raise ArgumentError(f'{name}: expected shape {shape}, got {array.shape}')
    return array
