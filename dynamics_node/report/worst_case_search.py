"""Search for the largest gravity torque of a joint, starting from sampled positions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..dynamics import RobotModel
from ..model import KinematicTree
from ..model.tree import PRISMATIC

# Sweeps over all coordinates before the search gives up.
_MAX_SWEEPS = 400
# Relative gain of one sweep below which the search ends.
_GAIN = 1e-11
# Number of positions that remain in the search after the first, second and third sweep.
_SURVIVORS = (64, 24, 12)
# Torques closer to each other than this share are the same maximum.
_SAME_MAXIMUM = 1e-9
# Offsets along a rotating coordinate at which the sine is measured, rad.
_THIRDS = np.array([0.0, math.tau / 3.0, 2.0 * math.tau / 3.0])
# Multiples of the step of a whole sweep that are tried after it.
_STRIDES = np.array([1.0, 3.0, 10.0, 30.0, 100.0])
# Grid points along a coordinate with mimic joints, where G is not a plain sine.
_GRID = 9
# Refinements of the grid interval around the best point.
_ZOOMS = 6


class CoordinateAscent:
    """
    Maximizes the gravity torque of one joint over the positions, one coordinate at a time.

    Along one rotating coordinate, all others fixed, the torque of every joint is
    a + b cos q + c sin q, because only the direction of gravity rotates; along a prismatic one it
    is a + b q. The maximum over that coordinate within its limits therefore follows from three
    (two) values. Coordinate after coordinate is set to its maximum until a sweep gains nothing.

    Parameters
    ----------
    model : RobotModel
    ranges : numpy.ndarray, shape (n, 2)
        rad or m; a coordinate with equal ends stays fixed.

    """

    def __init__(self, model: RobotModel, ranges: NDArray[np.float64]) -> None:
        self._model = model
        self._ranges = ranges
        self._is_prismatic, self._is_plain = _coordinate_properties(model.tree)
        self._related = _related(model.tree)

    def with_model(self, model: RobotModel) -> CoordinateAscent:
        """Return the search for the same robot with another inertia."""
        return type(self)(model, self._ranges)

    def maximize(
        self, joint: int, starts: NDArray[np.float64], sign: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], float]:
        """
        Return the largest torque of a joint by magnitude.

        Parameters
        ----------
        joint : int
            Index into the n joints.
        starts : numpy.ndarray, shape (B, n)
            Start positions, rad or m.
        sign : numpy.ndarray, shape (B,)
            1 to search for the largest torque, -1 for the smallest.

        Returns
        -------
        position : numpy.ndarray, shape (n,)
            rad or m.
        torque : float
            Signed, N m or N.

        """
        coordinates = [c for c in self._related[joint] if self._ranges[c, 0] < self._ranges[c, 1]]
        q = starts.copy()
        value = sign * self._torque(joint, q)
        for sweep in range(_MAX_SWEEPS):
            before, start = np.max(value), q.copy()
            for coordinate in coordinates:
                self._set_to_best(joint, coordinate, q, sign, value)
            value = sign * self._torque(joint, q)
            self._stride(joint, coordinates, start, q, sign, value)
            if np.max(value) - before <= _GAIN * max(abs(before), 1e-300) and sweep > 1:
                break
            if sweep < len(_SURVIVORS):
                best = _best_distinct(value, _SURVIVORS[sweep])
                q, sign, value = q[best], sign[best], value[best]
        top = int(np.argmax(value))
        return q[top], float(sign[top] * value[top])

    def _torque(self, joint: int, q: NDArray[np.float64]) -> NDArray[np.float64]:
        return self._model.gravity_torque(q)[:, joint]

    def _set_to_best(
        self,
        joint: int,
        coordinate: int,
        q: NDArray[np.float64],
        sign: NDArray[np.float64],
        value: NDArray[np.float64],
    ) -> None:
        # Changes q and value in place.
        if not self._is_plain[coordinate]:
            best, new = self._by_grid(joint, coordinate, q, sign)
        elif self._is_prismatic[coordinate]:
            best, new = self._better_end(joint, coordinate, q, sign)
        else:
            best, new = self._by_sine(joint, coordinate, q, sign, value)
        better = new > value
        q[better, coordinate] = best[better]
        value[better] = new[better]

    def _by_sine(
        self,
        joint: int,
        coordinate: int,
        q: NDArray[np.float64],
        sign: NDArray[np.float64],
        value: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        # A discrete Fourier transform of the values here, one third and two thirds of a turn on.
        angles = q[:, coordinate] + _THIRDS[:, None]
        at = np.concatenate((value[None], self._along(joint, coordinate, q, angles[1:]) * sign))
        mean = at.mean(axis=0)
        cosine = (2.0 / 3.0) * (at * np.cos(angles)).sum(axis=0)
        sine = (2.0 / 3.0) * (at * np.sin(angles)).sum(axis=0)
        lower, upper = self._ranges[coordinate]
        top = np.arctan2(sine, cosine)
        # Of all equivalent angles the one nearest to the middle of the range.
        middle = 0.5 * (lower + upper)
        top += math.tau * np.round((middle - top) / math.tau)
        ends = np.where(
            cosine * math.cos(lower) + sine * math.sin(lower)
            > cosine * math.cos(upper) + sine * math.sin(upper),
            lower,
            upper,
        )
        best = np.where((top >= lower) & (top <= upper), top, ends)
        return best, mean + cosine * np.cos(best) + sine * np.sin(best)

    def _better_end(
        self, joint: int, coordinate: int, q: NDArray[np.float64], sign: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        ends = self._ranges[coordinate]
        at = self._along(joint, coordinate, q, ends) * sign
        return np.where(at[0] > at[1], *ends), at.max(axis=0)

    def _by_grid(
        self, joint: int, coordinate: int, q: NDArray[np.float64], sign: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        lower, upper = (np.full(len(q), end) for end in self._ranges[coordinate])
        steps = np.linspace(0.0, 1.0, _GRID)[:, None]
        for _ in range(_ZOOMS):
            places = lower + steps * (upper - lower)
            at = self._along(joint, coordinate, q, places) * sign
            best = at.argmax(axis=0)
            columns = np.arange(len(q))
            lower = places[np.maximum(best - 1, 0), columns]
            upper = places[np.minimum(best + 1, _GRID - 1), columns]
        return places[best, columns], at[best, columns]

    def _along(
        self, joint: int, coordinate: int, q: NDArray[np.float64], places: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        # The joint's torque with one coordinate at each of the places, shape (places, B).
        moved = np.repeat(q[None], len(places), axis=0)
        moved[:, :, coordinate] = places if np.ndim(places) == 2 else places[:, None]
        return self._torque(joint, moved.reshape(-1, q.shape[1])).reshape(len(places), len(q))

    def _stride(
        self,
        joint: int,
        coordinates: list[int],
        start: NDArray[np.float64],
        q: NDArray[np.float64],
        sign: NDArray[np.float64],
        value: NDArray[np.float64],
    ) -> None:
        # Coupled coordinates advance by small steps in each sweep: extrapolate the sweep.
        step = np.zeros_like(q)
        step[:, coordinates] = (q - start)[:, coordinates]
        moved = q + _STRIDES[:, None, None] * step
        moved = np.clip(moved, self._ranges[:, 0], self._ranges[:, 1])
        new = sign * self._torque(joint, moved.reshape(-1, q.shape[1])).reshape(len(_STRIDES), -1)
        best = new.argmax(axis=0)
        columns = np.arange(len(q))
        better = new[best, columns] > value
        q[better] = moved[best, columns][better]
        value[better] = new[best, columns][better]


def _coordinate_properties(tree: KinematicTree) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    # Whether each coordinate is prismatic, and whether it has no mimic joints.
    is_prismatic = np.zeros(len(tree.joint_names), dtype=bool)
    for body in np.flatnonzero(tree.is_independent):
        is_prismatic[tree.q_index[body]] = tree.joint_type[body] == PRISMATIC
    followers = np.bincount(tree.q_index, minlength=len(tree.joint_names))
    return is_prismatic, followers == 1


def _related(tree: KinematicTree) -> list[list[int]]:
    # The coordinates that change the torque of each coordinate: before and behind it in the tree.
    count = len(tree.parent)
    chains: list[set[int]] = []
    for body in range(count):
        parent = tree.parent[body]
        chains.append({body} | (chains[parent] if parent >= 0 else set()))
    related: list[set[int]] = [set() for _ in tree.joint_names]
    for body, chain in enumerate(chains):
        for ancestor in chain:
            here, there = int(tree.q_index[body]), int(tree.q_index[ancestor])
            related[here].add(there)
            related[there].add(here)
    return [sorted(coordinates) for coordinates in related]


def _best_distinct(value: NDArray[np.float64], most: int) -> NDArray[np.intp]:
    # Indices of the largest values, one index per group of equal values.
    order = np.argsort(-value, kind='stable')
    ranked = value[order]
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = ranked[:-1] - ranked[1:] > _SAME_MAXIMUM * abs(ranked[0])
    return order[is_new][:most]
