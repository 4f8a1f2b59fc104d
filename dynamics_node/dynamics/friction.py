"""Friction in the joints: viscous and dry."""

from dataclasses import dataclass

import numpy as np

from .arguments import per_joint
from ..errors import ArgumentError

# Below this speed dry friction fades through zero unless somebody says otherwise, rad/s or m/s.
SMOOTHING_VELOCITY = 0.05


@dataclass(frozen=True)
class Friction:
    """
    Friction of n joints, each of its own speed alone.

    Attributes
    ----------
    viscous : numpy.ndarray, shape (n,)
        N m s/rad or N s/m; read-only.
    coulomb : numpy.ndarray, shape (n,)
        Dry friction, N m or N; read-only.
    smoothing_velocity : numpy.ndarray, shape (n,)
        rad/s or m/s, > 0: at this speed dry friction has 76 % of its size; read-only.

    """

    viscous: np.ndarray
    coulomb: np.ndarray
    smoothing_velocity: np.ndarray

    def torque(self, qd):
        """
        Return the efforts that friction takes, viscous q̇ + coulomb tanh(q̇ / smoothing).

        Parameters
        ----------
        qd : numpy.ndarray, shape (..., n)
            rad/s or m/s.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N, of the sign of q̇: what a motor has to add.

        References
        ----------
        docs/mathematics.md, equation (27).

        """
        with np.errstate(over='ignore'):  # however fast: tanh of infinity is 1
            return self.viscous * qd + self.coulomb * np.tanh(qd / self.smoothing_velocity)


def make_friction(joint_names, viscous, coulomb, smoothing_velocity):
    """
    Check the numbers of friction.

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
