"""How much the effort limits allow the robot to carry."""

import math

import numpy as np

from .loads import per_kilogram
from .report import PayloadEntry

# Steps down to the payload that is held everywhere; it takes two to four.
_MOST_STEPS = 20
_EXACT = 1e-9


def payload_entry(study, link, point):
    """
    Return what may be carried at a point, everywhere and at best.

    Parameters
    ----------
    study : Study
    link : str
        A link of the robot.
    point : array_like, shape (3,)
        m, in the link's frame.

    Returns
    -------
    PayloadEntry

    """
    model, names = study.model, study.model.joint_names
    masses, joints = _at_samples(study, link, point)
    best, least = int(np.argmax(masses)), int(np.argmin(masses))
    everywhere, limiting, where = _everywhere(
        study, link, point, float(masses[least]), int(joints[least]), study.positions[least]
    )
    under = study.joints_under(link)
    return PayloadEntry(
        link=link,
        point=tuple(float(value) for value in point),
        is_moved=model.tree.links[link].body >= 0,
        everywhere=everywhere,
        limiting_joint=None if limiting < 0 else names[limiting],
        limiting_position=None if limiting < 0 else tuple(where.tolist()),
        best=float(masses[best]),
        best_position=tuple(study.positions[best].tolist()),
        best_joint=None if joints[best] < 0 else names[joints[best]],
        unlimited_joints=tuple(
            names[joint] for joint in sorted(under) if math.isnan(model.effort_limits[joint])
        ),
    )


def _at_samples(study, link, point):
    masses, joints = [], []
    for rows in study.batches(10 * len(study.model.joint_names)):
        mass, joint = study.model.max_payload(study.positions[rows], link, point)
        masses.append(mass)
        joints.append(joint)
    return np.concatenate(masses), np.concatenate(joints)


def _everywhere(study, link, point, mass, joint, position):
    # The samples may have missed the worst position, so each joint is asked for its own, with
    # the payload on. A joint's largest torque over all positions is convex in the mass, so the
    # tangent there never goes below the mass that is sought.
    model = study.model
    for other, (at, torque) in enumerate(study.worst):
        if abs(torque) > model.effort_limits[other]:
            return 0.0, other, at
    for other in study.joints_under(link):
        limit = float(model.effort_limits[other])
        if math.isnan(limit):
            continue
        trial = mass if math.isfinite(mass) else _too_much(study, other, link, point, limit)
        for _ in range(_MOST_STEPS):
            if trial <= 0.0 or not math.isfinite(trial):
                break
            at, torque = study.worst_with(model.with_payload(link, trial, point), other)
            if abs(torque) <= limit * (1.0 + _EXACT):
                break
            slope = abs(float(per_kilogram(model, at, link, point)[other]))
            if slope == 0.0:
                break
            trial = max(0.0, trial - (abs(torque) - limit) / slope)
            mass, joint, position = trial, other, at
    return mass, joint, position


def _too_much(study, joint, link, point, limit):
    # A mass beyond the joint's limit at some position, infinite if there is none.
    most = np.abs(per_kilogram(study.model, study.positions, link, point)[:, joint]).max()
    return math.inf if most == 0.0 else 3.0 * limit / float(most)
