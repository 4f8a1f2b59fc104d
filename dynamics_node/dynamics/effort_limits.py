"""Which points of a trajectory, and which joints, ask for more effort than they may have."""

from typing import NamedTuple

import numpy as np

from .arguments import check_link
from ..errors import ArgumentError
from ..kernels import recursive
from ..kernels.packing import pack
from ..model.tree import PRISMATIC


class OverLimit(NamedTuple):
    """
    Where efforts are over their limits.

    Attributes
    ----------
    points : numpy.ndarray of int
        The points at which some joint is, ascending, counted from 0; empty if all is well.
    joints : numpy.ndarray of int
        The joints that are at some point, ascending, counted from 0.
    peak_effort : numpy.ndarray, shape (n,)
        The largest absolute effort of each joint, N m or N.

    """

    points: np.ndarray
    joints: np.ndarray
    peak_effort: np.ndarray


def over_limit(efforts, limits):
    """
    Return which points and joints are over the effort limits.

    Parameters
    ----------
    efforts : array_like, shape (N, n)
        Of N points, N m or N. One that is NaN is not within any limit.
    limits : array_like, shape (n,)
        Largest absolute efforts; NaN: the joint has no limit.

    Returns
    -------
    OverLimit

    Raises
    ------
    ArgumentError
        If there is no point or shapes do not fit, or a limit is negative.

    """
    efforts = np.abs(np.asarray(efforts, dtype=float))
    if efforts.ndim != 2 or len(efforts) == 0:
        raise ArgumentError(
            f'efforts: expected shape (N, n) with at least one point, got {efforts.shape}'
        )
    limits = checked_limits(limits, efforts.shape[1])
    over = ~(efforts <= limits) & ~np.isnan(limits)
    return OverLimit(
        np.flatnonzero(over.any(axis=1)), np.flatnonzero(over.any(axis=0)), efforts.max(axis=0)
    )


def checked_limits(limits, count):
    """
    Return effort limits as an array.

    Parameters
    ----------
    limits : array_like, shape (n,)
        N m or N, not negative; NaN: none.
    count : int
        n.

    Returns
    -------
    numpy.ndarray, shape (n,)

    Raises
    ------
    ArgumentError
        If the shape is another one or a limit is negative.

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


# Rounding of an effort, in units of the force times the way from the base to the payload, per
# body in between. A lever this short would hold more than any arm: 1e12 kg and beyond.
_ROUNDING = 16 * 2.0**-52


class MaxPayload(NamedTuple):
    """
    The largest point masses, one per state.

    Attributes
    ----------
    mass : numpy.ndarray, shape (...)
        kg; 0 where the robot is over a limit already, infinite where no limit is in the way.
    joint : numpy.ndarray of int, shape (...)
        Index of the joint that allows no more, -1 where none is in the way.

    """

    mass: np.ndarray
    joint: np.ndarray

    def least(self):
        """
        Return the largest payload for all states together, say of a trajectory.

        Returns
        -------
        mass : float
            kg.
        joint : int
            Which allows no more, -1 for none.
        point : tuple of int
            The state at which it does: its place along the batch axes.

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


def max_payload(model, q, link, point, qd, qdd, effort_limits):
    """
    Return the largest point masses at a point of a link; see `RobotModel.max_payload`.

    Efforts are linear in the mass. Those of one kilogram come from the same formulas as all
    others, on a tree that has no other inertia.

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
        N m or N; NaN: none.

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
    with np.errstate(all='ignore'):  # a point beyond all robots: NaN, and so is the mass
        per_kg = _per_kilogram(
            model,
            body,
            position,
            [
                np.broadcast_to(np.asarray(value, dtype=float), effort.shape)
                for value in (q, qd, qdd)
            ],
        )
    with np.errstate(all='ignore'):  # no force or no limit: infinite, or not used
        mass = np.where(
            per_kg == 0.0, np.inf, (limits - np.sign(per_kg) * effort) / np.abs(per_kg)
        )
        excess = np.where(np.abs(effort) > limits, np.abs(effort) / limits, 0.0)
    mass[np.broadcast_to(np.isnan(limits), mass.shape)] = np.inf
    # Joints in the last axis; one more, always infinite, stands for "none".
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


def _in_body(tree, link, point):
    # The row of the body that carries the link (-1: the base), and the point in its frame.
    check_link(tree.links, link)
    point = np.asarray(point, dtype=float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ArgumentError(
            'point: expected three finite numbers in the frame of the link, m, '
            f'got {point.tolist()}'
        )
    frame = tree.links[link]
    return frame.body, frame.placement @ np.append(point, 1.0)


def _per_kilogram(model, body, position, states):
    # The efforts of 1 kg, shape (..., n); zero where they are nothing but rounding.
    tree, shape = model.tree, states[0].shape
    if body < 0 or states[0].size == 0:
        return np.zeros(shape)
    inertia = np.zeros_like(tree.inertia)
    inertia[body] = np.outer(position, position)  # (2) of a point mass of 1 kg
    q, qd, qdd = (_beside_carriage(value.reshape(-1, shape[-1])) for value in states)
    effort = np.empty_like(q)
    recursive.inverse_dynamics(
        *_on_carriage(*pack(tree, model.gravity, inertia)), q, qd, qdd, effort
    )
    # What pushes the carriage is the force that the kilogram needs, N.
    force = np.linalg.norm(effort[:, -3:], axis=1)
    effort = effort[:, :-3]
    rounding = _rounding(tree, body, position, q) * force[:, None]
    effort[np.abs(effort) <= rounding] = 0.0
    return effort.reshape(shape)


def _on_carriage(structure, numbers):
    # The whole tree on three prismatic joints along the axes of the base, which stand still:
    # their efforts are the force on it. They come first, and are the last three coordinates.
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
        array.flags.writeable = False  # a type that is compiled already
    return packed


def _beside_carriage(values):
    return np.concatenate((values, np.zeros((len(values), 3))), axis=1)


def _rounding(tree, body, position, q):
    # Per state and joint, what an effort of a force of 1 N may be by rounding alone.
    chain = []
    reach = np.full(len(q), np.linalg.norm(position[:3]))
    while body >= 0:
        chain.append(body)
        reach += np.linalg.norm(tree.joint_placement[body, :3, 3])
        if tree.is_prismatic[body]:
            reach += np.abs(tree.multiplier[body] * q[:, tree.q_index[body]] + tree.offset[body])
        body = tree.parent[body]
    result = np.zeros((len(q), len(tree.joint_names)))
    for k in chain:
        lever = 1.0 if tree.is_prismatic[k] else reach
        result[:, tree.q_index[k]] += abs(tree.multiplier[k]) * lever
    return _ROUNDING * len(chain) * result
