"""Largest payload that the effort limits allow at rest."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .gravity_load import per_kilogram
from .report import PayloadEntry
from .workspace_analysis import WorkspaceAnalysis

# Newton steps down to the payload that is held everywhere; two to four are usual.
_MAX_STEPS = 20
# Relative excess over the effort limit at which the steps end.
_EXACT = 1e-9


def payload_entry(analysis: WorkspaceAnalysis, link: str, point: ArrayLike) -> PayloadEntry:
    """
    Return the payload that is held everywhere, and at the best sample.

    Parameters
    ----------
    analysis : WorkspaceAnalysis
    link : str
        A link of the robot.
    point : array_like, shape (3,)
        m, in the link's frame.

    Returns
    -------
    PayloadEntry

    """
    model, names = analysis.model, analysis.model.joint_names
    masses, joints = _at_samples(analysis, link, point)
    best, least = int(np.argmax(masses)), int(np.argmin(masses))
    everywhere, limiting, position = _everywhere(
        analysis, link, point, float(masses[least]), int(joints[least]), analysis.positions[least]
    )
    carriers = analysis.supporting_joints(link)
    return PayloadEntry(
        link=link,
        point=tuple(np.asarray(point, dtype=float).tolist()),
        is_moved=model.tree.links[link].body >= 0,
        everywhere=everywhere,
        limiting_joint=None if limiting < 0 else names[limiting],
        limiting_position=None if limiting < 0 else tuple(position.tolist()),
        best=float(masses[best]),
        best_position=tuple(analysis.positions[best].tolist()),
        best_joint=None if joints[best] < 0 else names[joints[best]],
        unlimited_joints=tuple(
            names[joint] for joint in sorted(carriers) if math.isnan(model.effort_limits[joint])
        ),
    )


def _at_samples(
    analysis: WorkspaceAnalysis, link: str, point: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    masses, joints = [], []
    for rows in analysis.batches(10 * len(analysis.model.joint_names)):
        mass, joint = analysis.model.max_payload(analysis.positions[rows], link, point)
        masses.append(mass)
        joints.append(joint)
    return np.concatenate(masses), np.concatenate(joints)


def _everywhere(
    analysis: WorkspaceAnalysis,
    link: str,
    point: ArrayLike,
    mass: float,
    joint: int,
    position: NDArray[np.float64],
) -> tuple[float, int, NDArray[np.float64]]:
    # The samples may miss the worst position, so the search runs for each joint with the payload
    # attached. A joint's largest torque over all positions is convex in the mass: a Newton step
    # along the tangent never falls below the largest mass that is held.
    model = analysis.model
    for other, (worst, torque) in enumerate(analysis.worst):
        if abs(torque) > model.effort_limits[other]:
            return 0.0, other, worst
    for other in analysis.supporting_joints(link):
        limit = float(model.effort_limits[other])
        if math.isnan(limit):
            continue
        trial = mass if math.isfinite(mass) else _above_limit(analysis, other, link, point, limit)
        for _ in range(_MAX_STEPS):
            if trial <= 0.0 or not math.isfinite(trial):
                break
            worst, torque = analysis.worst_with(model.with_payload(link, trial, point), other)
            if abs(torque) <= limit * (1.0 + _EXACT):
                break
            slope = abs(float(per_kilogram(model, worst, link, point)[other]))
            if slope == 0.0:
                break
            trial = max(0.0, trial - (abs(torque) - limit) / slope)
            mass, joint, position = trial, other, worst
    return mass, joint, position


def _above_limit(
    analysis: WorkspaceAnalysis, joint: int, link: str, point: ArrayLike, limit: float
) -> float:
    # A mass beyond the joint's limit at some position; infinite if the mass never loads it.
    slopes = per_kilogram(analysis.model, analysis.positions, link, point)[:, joint]
    largest = np.abs(slopes).max()
    return math.inf if largest == 0.0 else 3.0 * limit / float(largest)
