"""`MomentumObserver`: the external joint torque, from what the joints measure."""

import math

import numpy as np

from .joint_selection import JointSelection
from ..errors import ArgumentError

# The momentum of a longer time says too little about what happened within it, s.
LONGEST_STEP = 0.1


class MomentumObserver:
    """
    Estimates the joint efforts that something outside the robot causes, without accelerations.

    The generalized momentum p = D q̇ changes by the measured efforts, by what the model knows, and
    by the rest, which is external:

        ṗ = τ + Cᵀ q̇ - G - friction + τ_ext

    The estimate follows τ_ext with a first-order lag, 1 - exp(-K t) after a step: 95 % of it
    after 3 / K. It is as good as model and measured efforts are: a payload or a friction that the
    model does not know counts as external.

    Not for several threads at once: it remembers the last state.

    Attributes
    ----------
    joint_names : tuple of str
        The m chosen joints, in the order of the estimate.
    gain : float
        K, 1/s.
    estimate : numpy.ndarray, shape (m,)
        The newest estimate, N m or N, read-only; zero at the beginning.
    observed : float
        For how long it has been observing without a break, s. While it is 0 the estimate says
        nothing.

    References
    ----------
    docs/mathematics.md, equations (33) and (34).

    """

    def __init__(self, robot, gain, joints=(), longest_step=LONGEST_STEP):
        """
        Observe a robot; nothing is known yet.

        Parameters
        ----------
        robot : RobotModel
            With its payload, friction and rotor inertia.
        gain : float
            K, 1/s, positive. Larger is faster, and passes on more of the noise: an error of the
            measured momentum appears multiplied by it.
        joints : sequence of str
            The joints to estimate, in any order; empty for all. Each counts for itself: the
            efforts of the others need not be known.
        longest_step : float
            A longer time between two states begins anew, s.

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

    def reset(self):
        """Forget the last state and the estimate; the next state begins anew."""
        self._time = math.nan
        self._state = self._momentum = self._rate = None
        self._start_from_zero()

    def follow(self, robot):
        """
        Go on with another payload, gravity, friction or rotor inertia; the estimate stays.

        What the models say differently goes into the estimate or out of it with its lag, and not
        at once: on a base that tilts gravity may change with every state.

        Parameters
        ----------
        robot : RobotModel
            With the same joints in the same order.

        Raises
        ------
        ArgumentError
            If it has other joints.

        """
        if tuple(robot.joint_names) != self._joint_names:
            raise ArgumentError(
                f'robot: expected the joints {", ".join(self._joint_names)}, got '
                f'{", ".join(robot.joint_names)}: make another observer'
            )
        self._robot = robot
        if self._state is not None:
            # What the other model makes of the last state: a momentum that only the models tell
            # apart is no push.
            self._momentum, self._rate = self._balance(*self._state)

    def update(self, time, q, qd, effort):
        """
        Take a measured state, and return the new estimate.

        Parameters
        ----------
        time : float
            When it was measured, s. Not newer than the last one, or much newer: begins anew.
        q, qd : array_like, shape (n,)
            Positions (rad or m) and velocities of all joints of the robot. A velocity that is
            not known, NaN, of a joint that is not chosen, counts as standing still.
        effort : array_like, shape (m,)
            Measured efforts of the chosen joints, N m or N.

        Returns
        -------
        numpy.ndarray, shape (m,)
            Estimated external efforts, N m or N: positive where something outside pushes the
            joint in its positive direction. Zero for the state that it begins with; NaN, and the
            next one begins anew, where an argument or what follows from it is not finite.

        Raises
        ------
        ArgumentError
            If an array does not have the shape that is expected.

        References
        ----------
        docs/mathematics.md, equations (33) and (34).

        """
        q, qd, effort = self._checked(q, qd, effort)
        time = float(time)
        is_known = all(np.isfinite(value).all() for value in (time, q, qd, effort))
        if is_known:
            momentum, rate = self._balance(q, qd, effort)
            is_known = np.isfinite(momentum).all() and np.isfinite(rate).all()
        if not is_known:
            return self._unknown()
        dt = time - self._time
        if 0.0 < dt <= self._longest_step:
            with np.errstate(over='ignore', invalid='ignore'):
                external = (momentum - self._momentum) / dt - 0.5 * (rate + self._rate)  # (34)
                # What a filter of the gain K makes of a constant input, whatever K dt is.
                estimate = self.estimate - math.expm1(-self.gain * dt) * (external - self.estimate)
            if not np.isfinite(estimate).all():
                return self._unknown()
            estimate.flags.writeable = False
            self.estimate = estimate
            self.observed += dt
        else:
            self._start_from_zero()
        self._time, self._state = time, (q, qd, effort)
        self._momentum, self._rate = momentum, rate
        return self.estimate

    def _unknown(self):
        self.reset()
        return np.full(len(self._index), math.nan)

    def _start_from_zero(self):
        self.observed = 0.0
        self.estimate = np.zeros(len(self._index))
        self.estimate.flags.writeable = False

    def _checked(self, q, qd, effort):
        n, m = len(self._is_other), len(self._index)
        # Copies, because the last state is remembered.
        q, qd, effort = (np.array(value, dtype=float) for value in (q, qd, effort))
        for name, value, count in (('q', q, n), ('qd', qd, n), ('effort', effort, m)):
            if value.shape != (count,):
                raise ArgumentError(
                    f'{name}: expected shape ({count},), one state of '
                    f'{"all" if name != "effort" else "the chosen"} joints, got '
                    f'{value.shape}'
                )
        return q, np.where(self._is_other & np.isnan(qd), 0.0, qd), effort

    def _balance(self, q, qd, effort):
        # Rows of the whole robot, not its sub-blocks: (33) holds row by row, also where joints
        # that were not chosen move.
        rows = self._index
        with np.errstate(over='ignore', invalid='ignore'):  # however large the numbers are
            terms = self._robot.dynamics(q, qd)
            momentum = terms.mass_matrix[rows] @ qd
            known = qd @ terms.coriolis_matrix[:, rows] - terms.gravity_torque[rows]  # (33)
            return momentum, effort + known - self._robot.friction_torque(qd)[rows]


def _positive(name, value, unit):
    if not (isinstance(value, (int, float, np.number)) and math.isfinite(value) and value > 0.0):
        raise ArgumentError(f'{name}: expected a positive finite number, {unit}, got {value!r}')
    return float(value)
