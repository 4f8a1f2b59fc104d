"""Friction in the joints: viscous and dry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import per_joint
from ..errors import ArgumentError

# Default speed below which dry friction fades through zero, rad/s or m/s.
SMOOTHING_VELOCITY = 0.05


@dataclass(frozen=True)
class Friction:
    """
    Friction of n joints; that of a joint depends on its own velocity only.

    Attributes
    ----------
    viscous : numpy.ndarray, shape (n,)
        N m s/rad or N s/m; read-only.
    coulomb : numpy.ndarray, shape (n,)
        Dry friction, N m or N; read-only.
    smoothing_velocity : numpy.ndarray, shape (n,)
        rad/s or m/s, > 0: at this speed dry friction reaches 76 % of its value; read-only.

    """

    viscous: NDArray[np.float64]
    coulomb: NDArray[np.float64]
    smoothing_velocity: NDArray[np.float64]

    def torque(self, qd: NDArray[np.float64]) -> NDArray[np.float64]:
        """
        Return the efforts that overcome friction, viscous q̇ + coulomb tanh(q̇ / smoothing).

        Parameters
        ----------
        qd : numpy.ndarray, shape (..., n)
            rad/s or m/s.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N, with the sign of q̇; to be added to the other efforts of the motors.

        References
        ----------
        docs/mathematics.md, equation (27).

        """
        with np.errstate(over='ignore'):  # at any speed: tanh of infinity is 1
            return self.viscous * qd + self.coulomb * np.tanh(qd / self.smoothing_velocity)


def make_friction(
    joint_names: Sequence[str],
    viscous: ArrayLike,
    coulomb: ArrayLike,
    smoothing_velocity: ArrayLike,
) -> Friction:
    """
    Check friction coefficients, and return a `Friction`.

    Parameters
    ----------
    joint_names : tuple of str
        The n joints.
    viscous, coulomb, smoothing_velocity : array_like, shape (n,), or float
        See `Friction`.

    Returns
    -------
    Friction

    Raises
    ------
    ArgumentError
        If a length is wrong, or a number not finite or negative, or a smoothing velocity zero.

    """
    smoothing = per_joint('smoothing_velocity', joint_names, smoothing_velocity)
    if not (smoothing > 0.0).all():
        raise ArgumentError(
            f'smoothing_velocity: expected numbers > 0, rad/s or m/s, got {smoothing.tolist()}'
        )
    return Friction(
        per_joint('viscous', joint_names, viscous),
        per_joint('coulomb', joint_names, coulomb),
        smoothing,
    )
