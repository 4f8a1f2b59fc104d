"""Limits of the joints' motion: impossible steps, runaway, positions outside."""

from collections.abc import Iterable, Sequence
import math

# Largest velocity of a possible step, relative to the velocity limit; a faster step is a wrong
# measurement.
JUMP_MARGIN = 2.0
# Smallest time of a step, s: messages may arrive closer together than their measurements.
SHORTEST_STEP = 0.01


class MotionLimits:
    """
    Position and velocity limits of the joints of one robot; unknown limits are infinite.

    Attributes
    ----------
    names : tuple of str
    small_steps : list of float
        Step of each joint that is possible between any two messages, rad or m.

    """

    def __init__(
        self,
        names: Sequence[str],
        velocity: Iterable[float],
        position: Iterable[tuple[float, float]],
        is_continuous: Iterable[bool],
        allowed_velocity: Iterable[float] | None = None,
    ) -> None:
        """
        Store the limits of n joints.

        Parameters
        ----------
        names : sequence of str
        velocity : numpy.ndarray, shape (n,)
            Largest possible velocity, rad/s or m/s; NaN if unknown.
        position : numpy.ndarray, shape (n, 2)
            Lowest and highest position, rad or m; infinite without limit.
        is_continuous : numpy.ndarray of bool, shape (n,)
            Joints that turn without end: positions a whole turn apart are the same.
        allowed_velocity : numpy.ndarray, shape (n,), optional
            Velocity above which a joint runs away, rad/s or m/s, NaN for none; by default
            `velocity`.

        """
        self.names = tuple(names)
        # Infinity instead of NaN: every value is within an infinite limit. Lists instead of
        # arrays: plain numbers are several times faster, and every joint state is checked.
        allowed = velocity if allowed_velocity is None else allowed_velocity
        self._allowed = [math.inf if math.isnan(limit) else float(limit) for limit in allowed]
        # An allowed velocity above the URDF's limit is also possible.
        self._velocity = [
            allowed
            if math.isnan(limit)
            else max(float(limit), allowed if allowed < math.inf else 0.0)
            for limit, allowed in zip(velocity, self._allowed, strict=True)
        ]
        self._fastest = [JUMP_MARGIN * limit for limit in self._velocity]
        self.small_steps = [limit * SHORTEST_STEP for limit in self._fastest]
        self._lower = [float(low) for low, _ in position]
        self._upper = [float(high) for _, high in position]
        self._is_continuous = [bool(is_endless) for is_endless in is_continuous]

    @classmethod
    def none(cls, names: Sequence[str]) -> 'MotionLimits':
        """Return infinite limits."""
        n = len(names)
        return cls(names, [math.nan] * n, [(-math.inf, math.inf)] * n, [False] * n)

    def is_impossible(self, joint: int, before: float, after: float, dt: float) -> bool:
        """
        Tell whether a step is beyond the largest velocity of a joint.

        Parameters
        ----------
        joint : int
            Index of the joint.
        before, after : float
            Positions, rad or m.
        dt : float
            Time between them, s.

        Returns
        -------
        bool

        """
        reach = self._fastest[joint] * max(dt, SHORTEST_STEP)
        step = after - before
        if -reach <= step <= reach:
            return False
        return not (
            self._is_continuous[joint]
            and math.isfinite(step)
            and abs(math.remainder(step, 2.0 * math.pi)) <= reach
        )

    def describe_jump(self, joint: int, before: float, after: float, dt: float) -> str:
        """Return an impossible step as text: positions (rad or m), time (s), velocity limit."""
        return (
            f'{self.names[joint]} from {before:.4g} to {after:.4g} within {dt:.3f} s, at a '
            f'velocity limit of {self._velocity[joint]:g}'
        )

    def runaway(self, joints: Iterable[int], velocity: Sequence[float]) -> str:
        """
        Return the joints above their allowed velocity.

        Parameters
        ----------
        joints : iterable of int
            Indices of the joints in question.
        velocity : sequence of float
            Velocities of all joints, rad/s or m/s; NaN where unknown.

        Returns
        -------
        str
            Names, velocities and limits; '' if there is none.

        """
        allowed = self._allowed
        fast = [i for i in joints if abs(velocity[i]) > allowed[i]]
        if not fast:
            return ''
        return ', '.join(
            f'{self.names[i]} at {velocity[i]:.4g} (limit {allowed[i]:g})' for i in fast
        )

    def outside(self, joints: Iterable[int], position: Sequence[float]) -> str:
        """
        Return the joints beyond their position limits.

        Parameters
        ----------
        joints : iterable of int
            Indices of the joints in question.
        position : sequence of float
            Positions of all joints, rad or m.

        Returns
        -------
        str
            Names, positions and limits; '' if there is none.

        """
        lower, upper = self._lower, self._upper
        beyond = [i for i in joints if not lower[i] <= position[i] <= upper[i]]
        if not beyond:
            return ''
        return ', '.join(
            f'{self.names[i]} at {position[i]:.6g} (limits {lower[i]:g} to {upper[i]:g})'
            for i in beyond
        )
