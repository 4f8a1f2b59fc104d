"""Kinematics, masses and poses of the robot for the page's 3D view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .plots import gravity_of
from ..formatting import number, percent, quantity
from ..report import JointEntry, Report
from ..workspace_analysis import prismatic_joints
from ...dynamics import RobotModel
from ...model import KinematicTree
from ...model.tree import PRISMATIC

# Density of the balls that stand for the masses, that of aluminum, kg/m³.
BALL_DENSITY = 2700.0
# Position limit above which there is none, rad or m; 1e16 is a common way to write "no limit".
_FAR = 100.0
# Range of a slider without limits, from the neutral position, rad and m.
_HALF_TURN, _HALF_METER = np.pi, 0.5
# Semi-axis of the ellipsoid of a homogeneous rod, in units of its length.
_ROD = (5.0 / 12.0) ** 0.5


def scene(model: RobotModel) -> dict[str, Any]:
    """
    Return the robot as plain lists for JSON.

    The page computes poses and gravity torques itself with the formulas of docs/mathematics.md,
    so that the sliders work without a server; a test compares both with `RobotModel`.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    dict
        `joints`, `neutral` (n,), `lower` and `upper` (n,) (ends of the sliders), `continuous`,
        `prismatic`, `limit` (n,) (N m or N, None if none); per body k: `body`, `parent`,
        `slides`, `coordinate`, `multiplier`, `offset`, `placement` (3, 4), `axis`, `mass`,
        `com`, `ball` (radius, m), `ellipsoid` (3, 3) (columns: semi-axes, m, at most the length
        of the robot); `sticks`: pairs of
        (body, point); `gravity` (3,).

    """
    tree = model.tree
    lower, upper = slider_ends(model)
    bodies = range(len(tree.moving_joint_names))
    extent = _extent(tree)
    efforts = [None if np.isnan(limit) else float(limit) for limit in model.effort_limits]
    return {
        'joints': list(model.joint_names),
        'neutral': model.neutral_position.tolist(),
        'lower': lower.tolist(),
        'upper': upper.tolist(),
        'continuous': model.is_continuous.tolist(),
        'prismatic': prismatic_joints(model),
        'limit': efforts,
        'body': list(tree.moving_joint_names),
        'parent': tree.parent.tolist(),
        'slides': [int(value) == PRISMATIC for value in tree.joint_type],
        'coordinate': tree.q_index.tolist(),
        'multiplier': tree.multiplier.tolist(),
        'offset': tree.offset.tolist(),
        'placement': tree.joint_placement[:, :3, :].tolist(),
        'axis': tree.axis.tolist(),
        'mass': [float(tree.inertia[k, 3, 3]) for k in bodies],
        'com': [_com(tree.inertia[k]).tolist() for k in bodies],
        'ball': [ball_radius(tree.inertia[k, 3, 3]) for k in bodies],
        'ellipsoid': [_capped(ellipsoid(tree.inertia[k]), extent).tolist() for k in bodies],
        'sticks': _sticks(tree),
        'gravity': model.gravity.tolist(),
    }


def slider_ends(model: RobotModel) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """
    Return the ends of the joints' sliders.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    lower, upper : numpy.ndarray, shape (n,)
        The limits, rad or m; half a turn or half a meter from the neutral position without a
        limit, or with a limit that is too far away to mean anything.

    """
    neutral, limits = model.neutral_position, model.position_limits
    way = np.where(prismatic_joints(model), _HALF_METER, _HALF_TURN)
    is_near = np.abs(limits) < _FAR
    lower = np.where(is_near[:, 0], limits[:, 0], neutral - way)
    upper = np.where(is_near[:, 1], limits[:, 1], neutral + way)
    return lower, upper


def ball_radius(mass: float) -> float:
    """Return the radius of an aluminum ball with a mass (kg), m."""
    return float(np.cbrt(3.0 * max(float(mass), 0.0) / (4.0 * np.pi * BALL_DENSITY)))


def ellipsoid(J: NDArray[np.float64]) -> NDArray[np.float64]:
    """
    Return the solid ellipsoid that has this pseudo-inertia.

    A solid ellipsoid of mass m with semi-axes a has the second moments m a² / 5 about the planes
    through its center.

    Parameters
    ----------
    J : numpy.ndarray, shape (4, 4)
        kg m², kg m, kg; in any frame.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        The semi-axes as columns, m, in that frame; zero without mass.

    References
    ----------
    docs/mathematics.md, equations (2) and (4).

    """
    mass = float(J[3, 3])
    if mass <= 0.0:
        return np.zeros((3, 3))
    com = _com(J)
    moments, directions = np.linalg.eigh(J[:3, :3] - mass * np.outer(com, com))
    # Moments slightly below zero are rounding errors of a flat body.
    return directions * np.sqrt(5.0 * np.maximum(moments, 0.0) / mass)


def _extent(tree: KinematicTree) -> float:
    # Length of the longest chain, m, each body up to its farthest link or twice its center of
    # mass; infinite without any length.
    lengths = [2.0 * float(np.linalg.norm(_com(J))) for J in tree.inertia]
    for link in tree.links.values():
        if link.body >= 0:
            tip = float(np.linalg.norm(link.placement[:3, 3]))
            lengths[link.body] = max(lengths[link.body], tip)
    to_joint: list[float] = []
    for k, parent in enumerate(tree.parent):
        step = float(np.linalg.norm(tree.joint_placement[k][:3, 3]))
        to_joint.append(step + (to_joint[parent] if parent >= 0 else 0.0))
    return max((a + b for a, b in zip(to_joint, lengths, strict=True)), default=0.0) or np.inf


def _capped(axes: NDArray[np.float64], extent: float) -> NDArray[np.float64]:
    # The ellipsoid of a wrong tensor must not hide the robot: none is longer than that of a rod
    # as long as the robot.
    longest = _ROD * extent
    lengths = np.linalg.norm(axes, axis=0)
    return axes * np.minimum(1.0, longest / np.maximum(lengths, longest))


def _com(J: NDArray[np.float64]) -> NDArray[np.float64]:
    return J[:3, 3] / J[3, 3] if J[3, 3] > 0.0 else np.zeros(3)


def _sticks(tree: KinematicTree) -> list[list[list[Any]]]:
    # The lines of the stick figure: pairs of (body, point in its frame); -1 is the base.
    sticks: list[list[list[Any]]] = []
    for k, parent in enumerate(tree.parent):
        sticks.append([[int(parent), [0.0, 0.0, 0.0]], [k, [0.0, 0.0, 0.0]]])
    carriers = {int(parent) for parent in tree.parent}
    for k in range(len(tree.moving_joint_names)):
        # The last body of a chain extends to the farthest of its links, a tool for example.
        if k not in carriers:
            tips = [link.placement[:3, 3] for link in tree.links.values() if link.body == k]
            far = max(tips, key=np.linalg.norm)
            if far.any():
                sticks.append([[k, [0.0, 0.0, 0.0]], [k, far.tolist()]])
    return sticks


def poses(report: Report) -> list[dict[str, Any]]:
    """
    Return the poses that the 3D view offers.

    Parameters
    ----------
    report : Report
        Of a usable robot.

    Returns
    -------
    list of dict
        `label`, `caption` (a sentence), `q` (n,) in rad or m, and `joint`: the index of the joint
        whose worst pose it is, None for the others.

    """
    return [*_robot_poses(report), *_worst_poses(report)]


def _robot_poses(report: Report) -> list[dict[str, Any]]:
    assert report.model is not None
    entries = [
        _pose(
            'neutral',
            'The neutral pose: zero, or the nearest position within the limits.',
            report.model.neutral_position.tolist(),
        )
    ]
    payload, D = report.payload, report.conditioning
    if payload is not None and payload.limiting_position is not None:
        entries.append(
            _pose(
                'least payload',
                f'Here {payload.limiting_joint} is at its limit with '
                f'{quantity(payload.everywhere, "kg", 3)} at {payload.link}: that can be held at '
                'every pose.',
                payload.limiting_position,
            )
        )
    if payload is not None and payload.best_position and payload.best_joint is not None:
        entries.append(
            _pose(
                'most payload',
                f'The best of the sampled poses: {quantity(payload.best, "kg", 3)} at '
                f'{payload.link}, limited by {payload.best_joint}.',
                payload.best_position,
            )
        )
    if D is not None:
        entries.append(
            _pose(
                'worst conditioning',
                f'The condition number of D is {number(D.worst, 3)} here; '
                f'{D.weakest_joint} has the least inertia.',
                D.position,
            )
        )
    return entries


def _worst_poses(report: Report) -> list[dict[str, Any]]:
    by_name = {joint.name: joint for joint in report.joints if joint.gravity is not None}
    return [
        _pose(name, _worst_caption(by_name[name]), gravity_of(by_name[name]).position, index)
        for index, name in enumerate(report.joint_names)
        if name in by_name
    ]


def _worst_caption(joint: JointEntry) -> str:
    load = gravity_of(joint)
    of_limit = ''
    if not np.isnan(load.share):
        limit = quantity(joint.effort, joint.effort_unit)
        of_limit = f', {percent(load.share)} of its limit of {limit}'
    return (
        f'The worst pose of {joint.name}: gravity requires '
        f'{quantity(load.worst, joint.effort_unit)}{of_limit}.'
    )


def _pose(
    label: str, caption: str, q: Sequence[float], joint: int | None = None
) -> dict[str, Any]:
    return {'label': label, 'caption': caption, 'q': [float(value) for value in q], 'joint': joint}
