"""Gravity torque of each joint over all positions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .report import GravityLoad
from .workspace_analysis import WorkspaceAnalysis
from ..dynamics import RobotModel

# Quantiles of the magnitude that are reported.
_LEVELS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
# Bins of the histogram.
_BINS = 40
# Points of the curve over the joint's own position.
_CURVE_POINTS = 121
# The effect of one kilogram is rounding error below this share of its weight at full reach.
_ROUNDING = 1e-10


def gravity_load(
    analysis: WorkspaceAnalysis, joint: int, link: str, point: ArrayLike
) -> GravityLoad:
    """
    Return the gravity torque of one joint over all positions.

    Parameters
    ----------
    analysis : WorkspaceAnalysis
    joint : int
        Index into the n joints.
    link : str
        Link that carries the payload.
    point : array_like, shape (3,)
        Position of the payload in the link's frame, m.

    Returns
    -------
    GravityLoad

    """
    position, torque = analysis.worst[joint]
    limit = float(analysis.model.effort_limits[joint])
    magnitudes = np.abs(analysis.torques[:, joint])
    magnitudes[magnitudes <= analysis.rounding] = 0.0
    counts, edges = np.histogram(magnitudes, _BINS, range=(0.0, abs(torque) or 1.0))
    curve_positions, curve_torques = _curve(analysis, joint, position)
    return GravityLoad(
        worst=torque,
        position=tuple(position.tolist()),
        share=abs(torque) / limit,
        payload_left=_payload_left(
            torque, limit, per_kilogram(analysis.model, position, link, point)[joint]
        ),
        sampled=float(magnitudes.max()),
        levels=_LEVELS,
        quantiles=tuple(np.quantile(magnitudes, _LEVELS).tolist()),
        edges=tuple(edges.tolist()),
        counts=tuple(counts.tolist()),
        curve_positions=tuple(curve_positions.tolist()),
        curve_torques=tuple(curve_torques.tolist()),
    )


def _curve(
    analysis: WorkspaceAnalysis, joint: int, position: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # The joint's torque over its own position, all others as in `position`.
    lower, upper = analysis.ranges[joint]
    places = np.linspace(lower, upper, _CURVE_POINTS)
    along = np.repeat(position[None], len(places), axis=0)
    along[:, joint] = places
    torques = analysis.model.gravity_torque(along)[:, joint]
    torques[np.abs(torques) <= analysis.rounding] = 0.0
    return places, torques


def per_kilogram(
    model: RobotModel, q: NDArray[np.float64], link: str, point: ArrayLike
) -> NDArray[np.float64]:
    """
    Return the gravity torques that one kilogram at a point of a link adds.

    Parameters
    ----------
    model : RobotModel
    q : numpy.ndarray, shape (..., n)
        rad or m.
    link : str
    point : array_like, shape (3,)
        m, in the link's frame.

    Returns
    -------
    numpy.ndarray, shape (..., n)
        N m/kg or N/kg; rounding errors are set to zero.

    References
    ----------
    docs/mathematics.md, equation (29): Jᵀ maps a force at the point to joint efforts.

    """
    linear = model.jacobian(q, link, point)[..., :3, :]
    torque = -np.einsum('...ij,i->...j', linear, model.gravity)
    scale = np.linalg.norm(model.gravity) * np.abs(linear).max(initial=0.0)
    torque[np.abs(torque) <= _ROUNDING * scale] = 0.0
    return torque


def _payload_left(torque: float, limit: float, torque_per_kilogram: float) -> float:
    # docs/mathematics.md, equation (32) for one joint.
    if math.isnan(limit):
        return math.nan
    if abs(torque) > limit:
        return 0.0
    if torque_per_kilogram == 0.0:
        return math.inf
    sign = math.copysign(1.0, torque_per_kilogram)
    return (limit - sign * torque) / abs(torque_per_kilogram)
