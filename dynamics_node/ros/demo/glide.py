"""The way back to the start pose, as a robot travels it: without a jump."""

import numpy as np

from .robot_text import MovableJoint

SHARE_OF_LIMIT = 0.7  # of the velocity limit: a watchdog on the joint states must not trip
FALLBACK_VELOCITY = 1.0  # [rad/s or m/s] where the URDF states no limit
SHORTEST = 0.2  # [s]


class Glide:
    """
    A smooth motion between two positions: half a cosine wave, at rest at both ends.

    Its peak velocity is pi/2 * distance / duration.

    """

    def __init__(
        self, start: np.ndarray, goal: np.ndarray, joints: list[MovableJoint], now: float
    ) -> None:
        """Plan from `start` to `goal` [rad or m] within the velocity limits, from `now` [s]."""
        limits = np.array([joint.velocity or FALLBACK_VELOCITY for joint in joints])
        slowest = np.max(np.pi / 2 * np.abs(goal - start) / (SHARE_OF_LIMIT * limits))
        self.duration = max(float(slowest), SHORTEST)
        self.end = now + self.duration
        self._start, self._way = start, goal - start

    def at(self, now: float) -> tuple[np.ndarray, np.ndarray]:
        """Return position and velocity at a time [s]; the goal at rest from the end on."""
        phase = np.pi * min(max(1 - (self.end - now) / self.duration, 0.0), 1.0)
        position = self._start + self._way * (1 - np.cos(phase)) / 2
        return position, self._way * np.sin(phase) * np.pi / (2 * self.duration)
