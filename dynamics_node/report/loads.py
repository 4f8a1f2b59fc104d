"""What gravity asks of each joint."""

import math

import numpy as np

from .report import GravityLoad

_LEVELS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
_BINS = 40
_CURVE = 121
# What one kilogram does is only rounding below this share of its weight at the robot's reach.
_ROUNDING = 1e-10


def gravity_load(study, joint, link, point):
    """
    Return the gravity torque of one joint over all positions.

    Parameters
    ----------
    study : Study
    joint : int
        Index into the n joints.
    link : str
        That carries the payload.
    point : array_like, shape (3,)
        m, in the link's frame.

    Returns
    -------
    GravityLoad

    """
    position, torque = study.worst[joint]
    limit = float(study.model.effort_limits[joint])
    magnitudes = np.abs(study.torques[:, joint])
    magnitudes[magnitudes <= study.rounding] = 0.0
    counts, edges = np.histogram(magnitudes, _BINS, range=(0.0, abs(torque) or 1.0))
    places = np.linspace(study.ranges[joint, 0], study.ranges[joint, 1], _CURVE)
    along = np.repeat(position[None], len(places), axis=0)
    along[:, joint] = places
    curve = study.model.gravity_torque(along)[:, joint]
    curve[np.abs(curve) <= study.rounding] = 0.0
    return GravityLoad(
        worst=torque,
        position=tuple(position.tolist()),
        share=abs(torque) / limit,
        payload_left=_payload_left(
            torque, limit, per_kilogram(study.model, position, link, point)[joint]
        ),
        sampled=float(magnitudes.max()),
        levels=_LEVELS,
        quantiles=tuple(np.quantile(magnitudes, _LEVELS).tolist()),
        edges=tuple(edges.tolist()),
        counts=tuple(counts.tolist()),
        curve_positions=tuple(places.tolist()),
        curve_torques=tuple(curve.tolist()),
    )


def per_kilogram(model, q, link, point):
    """
    Return the gravity torques that one kilogram at a point of a link adds.

    Parameters
    ----------
    model : RobotModel
    q : numpy.ndarray, shape (..., n)
    link : str
    point : array_like, shape (3,)

    Returns
    -------
    numpy.ndarray, shape (..., n)
        N m/kg or N/kg; what is only rounding is zero.

    References
    ----------
    docs/mathematics.md, equation (29): Jᵀ takes a force at the point to joint efforts.

    """
    linear = model.jacobian(q, link, point)[..., :3, :]
    torque = -np.einsum('...ij,i->...j', linear, model.gravity)
    scale = np.linalg.norm(model.gravity) * np.abs(linear).max(initial=0.0)
    torque[np.abs(torque) <= _ROUNDING * scale] = 0.0
    return torque


def _payload_left(torque, limit, of_one_kilogram):
    # (32) for one joint.
    if math.isnan(limit):
        return math.nan
    if abs(torque) > limit:
        return 0.0
    if of_one_kilogram == 0.0:
        return math.inf
    sign = math.copysign(1.0, of_one_kilogram)
    return (limit - sign * torque) / abs(of_one_kilogram)
