"""Limits of the rate at which gravity may change while an arm is driven."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Largest turn at once, rad: an inertial sensor on a tilting base stays below, a wrong sign or a
# broken sample does not.
MAX_TURN = math.radians(30.0)
# Largest turn over time, rad/s.
TURN_RATE = math.radians(30.0)
# Largest change of magnitude at once, m/s².
MAX_CHANGE = 2.0
# Largest change of magnitude over time, m/s² per s.
CHANGE_RATE = 1.0


class GravityChange:
    """
    Limits the change of gravity over time, for any number of calls.

    A reference follows the accepted gravity at limited rates; a gravity further from the
    reference than MAX_TURN or MAX_CHANGE is refused.

    """

    def __init__(self) -> None:
        self._reference = self._accepted = np.zeros(3)
        self._time = -math.inf

    def begin(self, now: float, gravity: ArrayLike) -> None:
        """
        Start from the gravity with which the output is enabled.

        Parameters
        ----------
        now : float
            Steady clock, s.
        gravity : array_like, shape (3,)
            m/s².

        """
        self._reference = self._accepted = np.array(gravity, dtype=float)
        self._time = now

    def refusal(self, now: float, gravity: ArrayLike) -> str:
        """
        Return the reason to refuse a change of gravity.

        Parameters
        ----------
        now : float
            Steady clock, s.
        gravity : array_like, shape (3,)
            The new gravity, m/s².

        Returns
        -------
        str
            Expected, got, what to do; '' if the change is accepted.

        """
        gravity = np.array(gravity, dtype=float)
        if not gravity.any() or not self._accepted.any():
            return (
                'expected a vector that is not zero while output is on, got '
                f'{self._accepted.tolist()} -> {gravity.tolist()}: disable it first, or '
                'leave gravity out of the command by compensate.gravity'
            )
        reference = self._reference_at(now)
        turn = _angle(reference, gravity)
        if turn > MAX_TURN:
            return (
                f'expected a turn of at most {math.degrees(MAX_TURN):.0f} degrees at once and '
                f'{math.degrees(TURN_RATE):.0f} degrees per second while output is on, got '
                f'{math.degrees(turn):.0f} degrees: it must point to the earth (an '
                'accelerometer at rest shows the opposite); turn it in steps, or disable the '
                'output first'
            )
        change = abs(np.linalg.norm(gravity) - np.linalg.norm(reference))
        if change > MAX_CHANGE:
            return (
                f'expected a size that changes by at most {MAX_CHANGE:g} m/s^2 at once and '
                f'{CHANGE_RATE:g} m/s^2 per second while output is on, got '
                f'{np.linalg.norm(reference):.4g} -> {np.linalg.norm(gravity):.4g} m/s^2: '
                'change it in steps, or disable the output first'
            )
        return ''

    def accept(self, now: float, gravity: ArrayLike) -> None:
        """Record a new gravity, m/s², that `refusal` accepts."""
        self._reference = self._reference_at(now)
        self._time, self._accepted = now, np.array(gravity, dtype=float)

    def _reference_at(self, now: float) -> NDArray[np.float64]:
        dt = max(now - self._time, 0.0)
        size, goal = np.linalg.norm(self._reference), np.linalg.norm(self._accepted)
        if not size or not goal or math.isinf(dt):
            return self._accepted
        size = size + np.clip(goal - size, -CHANGE_RATE * dt, CHANGE_RATE * dt)
        start, end = self._reference / np.linalg.norm(self._reference), self._accepted / goal
        turn = _angle(start, end)
        if turn <= TURN_RATE * dt:
            return size * end
        share = TURN_RATE * dt / turn  # along the great circle; turn is below MAX_TURN
        return (
            size
            * (math.sin((1.0 - share) * turn) * start + math.sin(share * turn) * end)
            / math.sin(turn)
        )


def _angle(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(np.dot(a, b)))
