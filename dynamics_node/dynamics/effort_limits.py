"""Effort limits: the points and joints of a trajectory above them, and the largest payload."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import check_link
from ..errors import ArgumentError
from ..kernels import recursive
from ..kernels.packing import pack
from ..model.tree import KinematicTree, PRISMATIC

if TYPE_CHECKING:
    from .robot_model import RobotModel

# Rounding of an effort per body between base and payload, in units of force times distance. A
# payload at a shorter lever would have to exceed 1e12 kg to reach a limit.
_ROUNDING = 16 * 2.0**-52


class OverLimit(NamedTuple):
    """
    Points and joints with efforts over the limits.

    Attributes
    ----------
    points : numpy.ndarray of int
        Points with a joint over its limit, ascending, counted from 0; empty if there is none.
    joints : numpy.ndarray of int
        Joints over their limit at some point, ascending, counted from 0.
    peak_effort : numpy.ndarray, shape (n,)
        The largest absolute effort of each joint, N m or N.

    """

    points: NDArray[np.intp]
    joints: NDArray[np.intp]
    peak_effort: NDArray[np.float64]


def over_limit(efforts: ArrayLike, limits: ArrayLike) -> OverLimit:
    """
    Return the points and joints over the effort limits.

    Parameters
    ----------
    efforts : array_like, shape (N, n)
        Of N points, N m or N. NaN counts as over every limit.
    limits : array_like, shape (n,)
        Largest absolute efforts; NaN: the joint has no limit.

    Returns
    -------
    OverLimit

    Raises
    ------
    ArgumentError
        If there is no point, shapes do not fit, or a limit is negative.

    """
    efforts = np.abs(np.asarray(efforts, dtype=float))
    if efforts.ndim != 2 or len(efforts) == 0:
        raise ArgumentError(
            f'efforts: expected shape (N, n) with at least one point, got {efforts.shape}'
        )
    checked = checked_limits(limits, efforts.shape[1])
    over = ~(efforts <= checked) & ~np.isnan(checked)
    return OverLimit(
        np.flatnonzero(over.any(axis=1)), np.flatnonzero(over.any(axis=0)), efforts.max(axis=0)
    )


def checked_limits(limits: ArrayLike, count: int) -> NDArray[np.float64]:
    """
    Return effort limits as an array.

    Parameters
    ----------
    limits : array_like, shape (n,)
        N m or N, not negative; NaN: the joint has no limit.
    count : int
        n.

    Returns
    -------
    numpy.ndarray, shape (n,)

    Raises
    ------
    ArgumentError
        If the shape is wrong or a limit is negative.

    """
    limits = np.asarray(limits, dtype=float)
    if limits.shape != (count,):
        raise ArgumentError(
            f'effort limits: expected shape ({count},), one per joint, got {limits.shape}'
        )
    if (limits < 0.0).any():
        joint = int(np.argmax(limits < 0.0))
        raise ArgumentError(
            f'effort limits: joint {joint}: expected at least 0, or NaN for '
            f'none, got {float(limits[joint])}'
        )
    return limits


class MaxPayload(NamedTuple):
    """
    The largest point masses, one per state.

    Attributes
    ----------
    mass : numpy.ndarray, shape (...)
        kg; 0 where the robot is over a limit already, infinite where no joint limits the mass.
    joint : numpy.ndarray of int, shape (...)
        Index of the limiting joint, -1 where there is none.

    """

    mass: NDArray[np.float64]
    joint: NDArray[np.intp]

    def least(self) -> tuple[float, int, tuple[int, ...]]:
        """
        Return the largest payload within the limits at all states, for example of a trajectory.

        Returns
        -------
        mass : float
            kg.
        joint : int
            The limiting joint, -1 for none.
        point : tuple of int
            The limiting state: its index along the batch axes.

        Raises
        ------
        ArgumentError
            If there is no state.

        """
        if self.mass.size == 0:
            raise ArgumentError('largest payload: expected at least one state, got none')
        point = np.unravel_index(np.argmin(self.mass), self.mass.shape)
        return (
            float(self.mass[point]),
            int(self.joint[point]),
            tuple(int(index) for index in point),
        )


def max_payload(
    model: RobotModel,
    q: ArrayLike,
    link: str,
    point: ArrayLike,
    qd: ArrayLike,
    qdd: ArrayLike,
    effort_limits: ArrayLike,
) -> MaxPayload:
    """
    Return the largest point masses at a point of a link; see `RobotModel.max_payload`.

    Efforts are linear in the mass. The efforts of one kilogram come from the same recursion, on a
    tree without other inertia.

    Parameters
    ----------
    model : RobotModel
        Without payload.
    q, qd, qdd : numpy.ndarray, shape (..., n)
        Joint positions (rad or m), velocities, accelerations; batch axes broadcast.
    link : str
        A link of the URDF.
    point : array_like, shape (3,)
        In the link's frame, m.
    effort_limits : array_like, shape (n,)
        N m or N; NaN: the joint has no limit.

    Returns
    -------
    MaxPayload

    Raises
    ------
    ArgumentError
        If shapes do not fit, the link is unknown, the point is not finite or a limit is negative.

    References
    ----------
    docs/mathematics.md, equation (32).

    """
    n = len(model.joint_names)
    limits = checked_limits(effort_limits, n)
    body, position = _in_body(model.tree, link, point)
    effort = model.inverse_dynamics(q, qd, qdd)
    with np.errstate(all='ignore'):  # overflow of an extreme point: the mass is NaN
        per_kg = _per_kilogram(
            model,
            body,
            position,
            [
                np.broadcast_to(np.asarray(value, dtype=float), effort.shape)
                for value in (q, qd, qdd)
            ],
        )
    with np.errstate(all='ignore'):  # zero force or no limit: infinite or unused
        mass = np.where(
            per_kg == 0.0, np.inf, (limits - np.sign(per_kg) * effort) / np.abs(per_kg)
        )
        excess = np.where(np.abs(effort) > limits, np.abs(effort) / limits, 0.0)
    mass[np.broadcast_to(np.isnan(limits), mass.shape)] = np.inf
    # Joints along the last axis; an additional one, always infinite, stands for "none".
    mass, excess = (
        np.concatenate((values, np.full((*effort.shape[:-1], 1), fill)), axis=-1)
        for values, fill in ((mass, np.inf), (excess, 0.0))
    )
    least, over = mass.min(axis=-1), (excess > 0.0).any(axis=-1)
    joint = np.where(np.isinf(least), n, mass.argmin(axis=-1))
    joint, least = np.where(over, excess.argmax(axis=-1), joint), np.where(over, 0.0, least)
    unknown = np.isnan(effort).any(axis=-1) | np.isnan(per_kg).any(axis=-1)
    return MaxPayload(
        np.where(unknown, np.nan, least), np.where(unknown | (joint == n), -1, joint)
    )


def _in_body(tree: KinematicTree, link: str, value: ArrayLike) -> tuple[int, NDArray[np.float64]]:
    # The row of the body that carries the link (-1: the base), and the point in its frame, (4,).
    check_link(tree.links, link)
    point = np.asarray(value, dtype=float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ArgumentError(
            'point: expected three finite numbers in the frame of the link, m, '
            f'got {point.tolist()}'
        )
    frame = tree.links[link]
    return frame.body, frame.placement @ np.append(point, 1.0)


def _per_kilogram(
    model: RobotModel,
    body: int,
    position: NDArray[np.float64],
    states: Sequence[NDArray[np.float64]],
) -> NDArray[np.float64]:
    # The efforts of 1 kg, shape (..., n); exactly zero where they are mere rounding.
    tree, shape = model.tree, states[0].shape
    if body < 0 or states[0].size == 0:
        return np.zeros(shape)
    inertia = np.zeros_like(tree.inertia)
    inertia[body] = np.outer(position, position)  # (2) of a point mass of 1 kg
    q, qd, qdd = (_with_carriage_at_rest(value.reshape(-1, shape[-1])) for value in states)
    effort = np.empty_like(q)
    packed = pack(tree, model.gravity, inertia)
    recursive.inverse_dynamics(*_on_carriage(packed.structure, packed.numbers), q, qd, qdd, effort)
    # The efforts of the carriage are the force on the kilogram, N.
    force = np.linalg.norm(effort[:, -3:], axis=1)
    effort = effort[:, :-3]
    rounding = _rounding(tree, body, position, q) * force[:, None]
    effort[np.abs(effort) <= rounding] = 0.0
    return effort.reshape(shape)


def _on_carriage(
    structure: NDArray[np.int64], numbers: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    # The tree on three prismatic joints at rest along the axes of the base: their efforts are the
    # total force. They are the first three bodies and the last three coordinates.
    count = recursive.joint_count(structure)
    rails = np.array(
        [(-1, PRISMATIC, count), (0, PRISMATIC, count + 1), (1, PRISMATIC, count + 2)],
        dtype=np.int64,
    )
    structure = structure.copy()
    structure[:, recursive.PARENT] += 3  # the base, -1, becomes the last rail
    rows = np.zeros((3, recursive.WIDTH))
    rows[:, recursive.ROTATION : recursive.TRANSLATION] = np.eye(3).ravel()
    rows[:, recursive.AXIS : recursive.INERTIA] = np.eye(3)
    rows[:, recursive.MULTIPLIER] = 1.0
    packed = np.concatenate((rails, structure)), np.concatenate((rows, numbers))
    for array in packed:
        array.flags.writeable = False  # the array type for which the kernels are compiled
    return packed


def _with_carriage_at_rest(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.concatenate((values, np.zeros((len(values), 3))), axis=1)


def _rounding(
    tree: KinematicTree, body: int, position: NDArray[np.float64], q: NDArray[np.float64]
) -> NDArray[np.float64]:
    # Bound on the rounding of the efforts of a force of 1 N, shape (B, n).
    chain = []
    reach = np.full(len(q), np.linalg.norm(position[:3]))
    while body >= 0:
        chain.append(body)
        reach += np.linalg.norm(tree.joint_placement[body, :3, 3])
        if tree.is_prismatic[body]:
            reach += np.abs(tree.multiplier[body] * q[:, tree.q_index[body]] + tree.offset[body])
        body = int(tree.parent[body])
    result = np.zeros((len(q), len(tree.joint_names)))
    for k in chain:
        lever = 1.0 if tree.is_prismatic[k] else reach
        result[:, tree.q_index[k]] += abs(tree.multiplier[k]) * lever
    return _ROUNDING * len(chain) * result
