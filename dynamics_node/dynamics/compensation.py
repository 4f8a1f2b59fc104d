"""The effort that compensates gravity, Coriolis and friction, each on or off."""

from dataclasses import dataclass

import numpy as np

from .robot_model import RobotModel


@dataclass(frozen=True)
class Compensation:
    """
    The sum of the wanted terms of the manipulator equation, for the chosen joints.

    Attributes
    ----------
    model : RobotModel
    index : numpy.ndarray of int, shape (m,), or None
        Places of the chosen joints among the model's; None if they are the model's in its order.
    gravity, coriolis, friction : bool
        Which terms are part of the effort.

    """

    model: RobotModel
    index: np.ndarray | None = None
    gravity: bool = True
    coriolis: bool = False
    friction: bool = False

    @property
    def needs_velocity(self):
        """Whether a term depends on the velocity."""
        return self.coriolis or self.friction

    def torques(self, position, velocity):
        """
        Return the gravity torque and the compensating effort at a state.

        Parameters
        ----------
        position : numpy.ndarray, shape (n,)
            Of all joints of the model, rad or m.
        velocity : numpy.ndarray, shape (n,), or None
            rad/s or m/s; only read if `needs_velocity`. NaN counts as zero, and so does the
            velocity of a joint that is not chosen.

        Returns
        -------
        gravity_torque, effort : numpy.ndarray, shape (m,)
            G(q), and the sum of the terms, N m or N.

        """
        G = self._chosen(self.model.gravity_torque(position))
        effort = G if self.gravity else np.zeros(len(G))
        if self.needs_velocity:
            effort = effort + self._of_motion(position, velocity)
        return G, effort

    def _of_motion(self, position, velocity):
        qd = np.zeros(len(velocity))
        chosen = slice(None) if self.index is None else self.index
        qd[chosen] = np.nan_to_num(velocity[chosen], nan=0.0)
        effort = np.zeros(len(qd))
        if self.coriolis:
            effort += self.model.coriolis_matrix(position, qd) @ qd
        if self.friction:
            effort += self.model.friction_torque(qd)
        return self._chosen(effort)

    def _chosen(self, values):
        return values if self.index is None else values[self.index]
