"""`MomentumObserver`: the external joint torque, from measured positions, velocities, efforts."""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .joint_selection import JointSelection
from ..errors import ArgumentError

if TYPE_CHECKING:
    from .robot_model import RobotModel

# Longest time between two states over which the momentum is a useful average, s.
LONGEST_STEP = 0.1


class MomentumObserver:
    """
    Estimate of the joint efforts caused by contact with the environment, without accelerations.

    The generalized momentum p = D q̇ changes by the measured efforts, the modeled efforts, and the
    remainder, which is external:

        ṗ = τ + Cᵀ q̇ - G - friction + τ_ext

    The estimate follows τ_ext with a first-order lag, 1 - exp(-K t) after a step: 95 % of it
    after 3 / K. It is as good as model and measured efforts: payload and friction missing from the
    model count as external.

    Not thread-safe: it stores the last state.

    Attributes
    ----------
    joint_names : tuple of str
        The m selected joints, in the order of the estimate.
    gain : float
        K, 1/s.
    estimate : numpy.ndarray, shape (m,)
        The newest estimate, N m or N, read-only; zero at the beginning.
    observed : float
        Duration of observation without interruption, s. While it is 0 the estimate is
        meaningless.

    References
    ----------
    docs/mathematics.md, equations (33) and (34).

    """

    def __init__(
        self,
        robot: RobotModel,
        gain: float,
        joints: Sequence[str] = (),
        longest_step: float = LONGEST_STEP,
    ):
        """
        Observe a robot, from its first state on.

        Parameters
        ----------
        robot : RobotModel
            With its payload, friction and rotor inertia.
        gain : float
            K, 1/s, positive. A larger gain is faster and noisier: an error of the measured
            momentum appears multiplied by it.
        joints : sequence of str
            The joints to estimate, in any order; empty for all. The efforts of the other joints
            are not needed.
        longest_step : float
            After a longer time between two states the observer starts again, s.

        Raises
        ------
        ArgumentError
            If a joint is unknown, fixed, a mimic joint or named twice, or a number is not
            positive and finite.

        """
        selection = JointSelection(robot, joints)
        self.joint_names = selection.names
        self.gain = _positive('gain', gain, '1/s')
        self._longest_step = _positive('longest_step', longest_step, 's')
        self._robot, self._joint_names = robot, tuple(robot.joint_names)
        self.estimate = np.zeros(len(selection.names))
        self._index = selection.index
        self._is_other = np.ones(len(robot.joint_names), dtype=bool)
        self._is_other[self._index] = False
        self.reset()

    def reset(self) -> None:
        """Discard the last state and the estimate; the observer starts again at the next state."""
        self._time = math.nan
        self._state: tuple[NDArray[np.float64], ...] | None = None
        self._momentum = self._rate = np.empty(0)
        self._start_from_zero()

    def follow(self, robot: RobotModel) -> None:
        """
        Continue with another payload, gravity, friction or rotor inertia; the estimate stays.

        The difference between the models enters the estimate with its lag, not as a step: on a
        tilting base gravity may change with every state.

        Parameters
        ----------
        robot : RobotModel
            With the same joints in the same order.

        Raises
        ------
        ArgumentError
            If its joints differ.

        """
        if tuple(robot.joint_names) != self._joint_names:
            raise ArgumentError(
                f'robot: expected the joints {", ".join(self._joint_names)}, got '
                f'{", ".join(robot.joint_names)}: make another observer'
            )
        self._robot = robot
        if self._state is not None:
            # The last state by the new model: a difference of momentum between the models is not
            # an external effort.
            self._momentum, self._rate = self._balance(*self._state)

    def update(
        self, time: float, q: ArrayLike, qd: ArrayLike, effort: ArrayLike
    ) -> NDArray[np.float64]:
        """
        Add a measured state, and return the new estimate.

        Parameters
        ----------
        time : float
            Time of measurement, s. If it does not increase, or by more than the longest step,
            the observer starts again.
        q, qd : array_like, shape (n,)
            Positions (rad or m) and velocities of all joints of the robot. An unknown velocity,
            NaN, of a joint that is not selected counts as zero.
        effort : array_like, shape (m,)
            Measured efforts of the selected joints, N m or N.

        Returns
        -------
        numpy.ndarray, shape (m,)
            Estimated external efforts, N m or N: positive where the environment pushes the joint
            in its positive direction. Zero at the first state; NaN, and a new start at the next
            state, if an argument or a result is not finite.

        Raises
        ------
        ArgumentError
            If an array has a wrong shape.

        References
        ----------
        docs/mathematics.md, equations (33) and (34).

        """
        state = self._checked(q, qd, effort)
        time = float(time)
        if not all(np.isfinite(value).all() for value in (time, *state)):
            return self._unknown()
        momentum, rate = self._balance(*state)
        if not (np.isfinite(momentum).all() and np.isfinite(rate).all()):
            return self._unknown()
        dt = time - self._time
        if 0.0 < dt <= self._longest_step:
            with np.errstate(over='ignore', invalid='ignore'):
                external = (momentum - self._momentum) / dt - 0.5 * (rate + self._rate)  # (34)
                # Exact response of a first-order filter to a constant input, for any K dt.
                estimate = self.estimate - math.expm1(-self.gain * dt) * (external - self.estimate)
            if not np.isfinite(estimate).all():
                return self._unknown()
            estimate.flags.writeable = False
            self.estimate = estimate
            self.observed += dt
        else:
            self._start_from_zero()
        self._time, self._state = time, state
        self._momentum, self._rate = momentum, rate
        return self.estimate

    def _unknown(self) -> NDArray[np.float64]:
        self.reset()
        return np.full(len(self._index), math.nan)

    def _start_from_zero(self) -> None:
        self.observed = 0.0
        self.estimate = np.zeros(len(self._index))
        self.estimate.flags.writeable = False

    def _checked(self, *arguments: ArrayLike) -> tuple[NDArray[np.float64], ...]:
        n, m = len(self._is_other), len(self._index)
        # Copies, because the last state is stored.
        q, qd, effort = (np.array(value, dtype=float) for value in arguments)
        for name, value, count in (('q', q, n), ('qd', qd, n), ('effort', effort, m)):
            if value.shape != (count,):
                raise ArgumentError(
                    f'{name}: expected shape ({count},), one state of '
                    f'{"all" if name != "effort" else "the chosen"} joints, got '
                    f'{value.shape}'
                )
        return q, np.where(self._is_other & np.isnan(qd), 0.0, qd), effort

    def _balance(
        self, q: NDArray[np.float64], qd: NDArray[np.float64], effort: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        # Rows of the whole robot, not sub-blocks: (33) holds row by row, also while the other
        # joints move.
        rows = self._index
        with np.errstate(over='ignore', invalid='ignore'):  # overflow gives NaN, see `update`
            terms = self._robot.dynamics(q, qd)
            momentum = terms.mass_matrix[rows] @ qd
            known = qd @ terms.coriolis_matrix[:, rows] - terms.gravity_torque[rows]  # (33)
            return momentum, effort + known - self._robot.friction_torque(qd)[rows]


def _positive(name: str, value: float, unit: str) -> float:
    if not (isinstance(value, (int, float, np.number)) and math.isfinite(value) and value > 0.0):
        raise ArgumentError(f'{name}: expected a positive finite number, {unit}, got {value!r}')
    return float(value)
