"""The effort that compensates gravity, Coriolis and friction, each on or off."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .robot_model import RobotModel


@dataclass(frozen=True)
class Compensation:
    """
    The sum of the enabled terms of the manipulator equation, for the selected joints.

    Attributes
    ----------
    model : RobotModel
    index : numpy.ndarray of int, shape (m,), or None
        Places of the selected joints in the model's q; None for all in the model's order.
    gravity, coriolis, friction : bool
        Terms that are part of the effort.

    """

    model: RobotModel
    index: NDArray[np.intp] | None = None
    gravity: bool = True
    coriolis: bool = False
    friction: bool = False

    @property
    def needs_velocity(self) -> bool:
        """Whether a term depends on the velocity."""
        return self.coriolis or self.friction

    def torques(
        self, position: NDArray[np.float64], velocity: NDArray[np.float64] | None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        Return the gravity torque and the compensating effort at a state.

        Parameters
        ----------
        position : numpy.ndarray, shape (n,)
            Of all joints of the model, rad or m.
        velocity : numpy.ndarray, shape (n,), or None
            rad/s or m/s; required if `needs_velocity`. NaN counts as zero, and so does the
            velocity of a joint that is not selected.

        Returns
        -------
        gravity_torque, effort : numpy.ndarray, shape (m,)
            G(q), and the sum of the terms, N m or N.

        """
        G = self._select(self.model.gravity_torque(position))
        effort = G if self.gravity else np.zeros(len(G))
        if self.needs_velocity:
            assert velocity is not None
            effort = effort + self._of_motion(position, velocity)
        return G, effort

    def _of_motion(
        self, position: NDArray[np.float64], velocity: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        qd = np.zeros(len(velocity))
        selected = slice(None) if self.index is None else self.index
        qd[selected] = np.nan_to_num(velocity[selected], nan=0.0)
        effort = np.zeros(len(qd))
        if self.coriolis:
            effort += self.model.coriolis_matrix(position, qd) @ qd
        if self.friction:
            effort += self.model.friction_torque(qd)
        return self._select(effort)

    def _select(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        return values if self.index is None else values[self.index]
