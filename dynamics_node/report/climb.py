"""From sampled positions up to where a joint's gravity torque is truly largest."""

import math

import numpy as np

from ..model.tree import PRISMATIC

# Sweeps over all coordinates, and the gain, relative to the torque, at which one is the last.
_MOST_SWEEPS = 400
_GAIN = 1e-11
# So many of the climbing positions go on after the first, the second and the third sweep.
_SURVIVORS = (64, 24, 12)
# Torques that are equal to this share of them are taken for the same top.
_SAME_TOP = 1e-9
# Where to look beside the place itself, along a coordinate that turns, rad.
_THIRDS = np.array([0.0, math.tau / 3.0, 2.0 * math.tau / 3.0])
# How much further to go in the direction in which a whole sweep went.
_STRIDES = np.array([1.0, 3.0, 10.0, 30.0, 100.0])
# Positions along a coordinate that other joints mimic, where G is no plain sine; and how often
# the interval around the best is divided anew.
_GRID, _ZOOMS = 9, 6


class Climber:
    """
    Finds the largest gravity torque of one joint, from positions that are given.

    Along one coordinate that turns, all others at rest, the torque of every joint is
    a + b cos q + c sin q, for only the direction of gravity turns; along one that slides it is
    a + b q. So its maximum over that coordinate, within the limits, follows from three (two)
    values, and coordinate after coordinate can be set to its best until nothing is gained.

    """

    def __init__(self, model, ranges):
        """
        Look at a robot.

        Parameters
        ----------
        model : RobotModel
        ranges : numpy.ndarray, shape (n, 2)
            rad or m; a coordinate whose ends are equal stays where it is.

        """
        self._model = model
        self._ranges = ranges
        self._slides, self._is_plain = _kinds(model.tree)
        self._related = _related(model.tree)

    def with_model(self, model):
        """Return the same for another inertia of the same robot."""
        return type(self)(model, self._ranges)

    def climb(self, joint, starts, sign):
        """
        Return where the torque of a joint is largest in magnitude.

        Parameters
        ----------
        joint : int
            Index into the n joints.
        starts : numpy.ndarray, shape (B, n)
            Where to begin.
        sign : numpy.ndarray, shape (B,)
            1 where to go for the largest torque, -1 for the smallest.

        Returns
        -------
        position : numpy.ndarray, shape (n,)
        torque : float
            With its sign, N m or N.

        """
        coordinates = [c for c in self._related[joint] if self._ranges[c, 0] < self._ranges[c, 1]]
        q = starts.copy()
        value = sign * self._torque(joint, q)
        for sweep in range(_MOST_SWEEPS):
            before, start = value.max(), q.copy()
            for coordinate in coordinates:
                self._set_to_best(joint, coordinate, q, sign, value)
            value = sign * self._torque(joint, q)
            self._stride(joint, coordinates, start, q, sign, value)
            if value.max() - before <= _GAIN * max(abs(before), 1e-300) and sweep > 1:
                break
            if sweep < len(_SURVIVORS):
                best = _best_apart(value, _SURVIVORS[sweep])
                q, sign, value = q[best], sign[best], value[best]
        top = int(np.argmax(value))
        return q[top], float(sign[top] * value[top])

    def _torque(self, joint, q):
        return self._model.gravity_torque(q)[:, joint]

    def _set_to_best(self, joint, coordinate, q, sign, value):
        # In place.
        if not self._is_plain[coordinate]:
            best, new = self._by_search(joint, coordinate, q, sign)
        elif self._slides[coordinate]:
            best, new = self._better_end(joint, coordinate, q, sign)
        else:
            best, new = self._by_sine(joint, coordinate, q, sign, value)
        better = new > value
        q[better, coordinate] = best[better]
        value[better] = new[better]

    def _by_sine(self, joint, coordinate, q, sign, value):
        # One third and two thirds of a turn from here: with the value here, a discrete Fourier
        # transform.
        angles = q[:, coordinate] + _THIRDS[:, None]
        at = np.concatenate((value[None], self._along(joint, coordinate, q, angles[1:]) * sign))
        mean = at.mean(axis=0)
        cosine = (2.0 / 3.0) * (at * np.cos(angles)).sum(axis=0)
        sine = (2.0 / 3.0) * (at * np.sin(angles)).sum(axis=0)
        lower, upper = self._ranges[coordinate]
        top = np.arctan2(sine, cosine)
        # Of all turns the one nearest to the middle.
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

    def _better_end(self, joint, coordinate, q, sign):
        ends = self._ranges[coordinate]
        at = self._along(joint, coordinate, q, ends) * sign
        return np.where(at[0] > at[1], *ends), at.max(axis=0)

    def _by_search(self, joint, coordinate, q, sign):
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

    def _along(self, joint, coordinate, q, places):
        # The joint's torque with one coordinate set: shape (places, B).
        moved = np.repeat(q[None], len(places), axis=0)
        moved[:, :, coordinate] = places if np.ndim(places) == 2 else places[:, None]
        return self._torque(joint, moved.reshape(-1, q.shape[1])).reshape(len(places), len(q))

    def _stride(self, joint, coordinates, start, q, sign, value):
        # Where coordinates depend on each other, each sweep goes a small step of a long way.
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


def _kinds(tree):
    # Of each coordinate: whether it slides, and whether no other joint mimics it.
    slides = np.zeros(len(tree.joint_names), dtype=bool)
    for body in np.flatnonzero(tree.is_independent):
        slides[tree.q_index[body]] = tree.joint_type[body] == PRISMATIC
    followers = np.bincount(tree.q_index, minlength=len(tree.joint_names))
    return slides, followers == 1


def _related(tree):
    # Of each coordinate, those that change its torque: before and behind it in the tree.
    count = len(tree.parent)
    chains: list[set] = []
    for body in range(count):
        parent = tree.parent[body]
        chains.append({body} | (chains[parent] if parent >= 0 else set()))
    related: list[set] = [set() for _ in tree.joint_names]
    for body, chain in enumerate(chains):
        for ancestor in chain:
            here, there = int(tree.q_index[body]), int(tree.q_index[ancestor])
            related[here].add(there)
            related[there].add(here)
    return [sorted(coordinates) for coordinates in related]


def _best_apart(value, most):
    # Indices of the largest values, of equal ones one.
    order = np.argsort(-value, kind='stable')
    ranked = value[order]
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = ranked[:-1] - ranked[1:] > _SAME_TOP * abs(ranked[0])
    return order[is_new][:most]
