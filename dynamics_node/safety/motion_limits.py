"""How far and how fast joints can have moved."""

import math

# A step that needs more than this many times the velocity limit is a wrong measurement.
JUMP_MARGIN = 2.0
# Two messages may come closer together than their measurements were made, s.
SHORTEST_STEP = 0.01


class MotionLimits:
    """
    What the joints of one robot can do; unknown limits are infinite.

    Attributes
    ----------
    names : tuple of str
    small_steps : list of float
        How far each joint can move between any two messages, rad or m.

    """

    def __init__(self, names, velocity, position, is_continuous, allowed_velocity=None):
        """
        Keep the limits of n joints.

        Parameters
        ----------
        names : sequence of str
        velocity : numpy.ndarray, shape (n,)
            Largest speed that the joint can reach, rad/s or m/s; NaN if not known.
        position : numpy.ndarray, shape (n, 2)
            Lowest and highest, rad or m; infinite if there is none.
        is_continuous : numpy.ndarray of bool, shape (n,)
            Joints that turn without end: a whole turn more or less is the same position.
        allowed_velocity : numpy.ndarray, shape (n,), optional
            Speed above which a joint runs away, rad/s or m/s, NaN for none; by default
            `velocity`.

        """
        self.names = tuple(names)
        # Infinity instead of NaN: every comparison with it says that the limit is kept. Lists,
        # not arrays: plain numbers are several times as fast, and every state asks.
        allowed = velocity if allowed_velocity is None else allowed_velocity
        self._allowed = [math.inf if math.isnan(limit) else float(limit) for limit in allowed]
        # A limit that is allowed above the URDF's says that the joint can be that fast.
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
    def none(cls, names):
        """Return limits that let everything pass."""
        n = len(names)
        return cls(names, [math.nan] * n, [(-math.inf, math.inf)] * n, [False] * n)

    def is_impossible(self, joint, before, after, dt):
        """
        Tell whether a joint cannot have moved like this.

        Parameters
        ----------
        joint : int
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

    def describe_jump(self, joint, before, after, dt):
        """Return in words how far a joint has jumped, and how far it can have moved."""
        return (
            f'{self.names[joint]} from {before:.4g} to {after:.4g} within {dt:.3f} s, at a '
            f'velocity limit of {self._velocity[joint]:g}'
        )

    def runaway(self, joints, velocity):
        """
        Return which joints are above their allowed velocity.

        Parameters
        ----------
        joints : sequence of int
            Those to look at.
        velocity : sequence of float
            Of all joints, rad/s or m/s; NaN where not known.

        Returns
        -------
        str
            '' if there is none; otherwise names, velocities and limits.

        """
        allowed = self._allowed
        fast = [i for i in joints if abs(velocity[i]) > allowed[i]]
        if not fast:
            return ''
        return ', '.join(
            f'{self.names[i]} at {velocity[i]:.4g} (limit {allowed[i]:g})' for i in fast
        )

    def outside(self, joints, position):
        """
        Return which joints stand beyond their position limits.

        Parameters
        ----------
        joints : sequence of int
            Those to look at.
        position : sequence of float
            Of all joints, rad or m.

        Returns
        -------
        str
            '' if there is none; otherwise names, positions and limits.

        """
        lower, upper = self._lower, self._upper
        beyond = [i for i in joints if not lower[i] <= position[i] <= upper[i]]
        if not beyond:
            return ''
        return ', '.join(
            f'{self.names[i]} at {position[i]:.6g} (limits {lower[i]:g} to {upper[i]:g})'
            for i in beyond
        )
