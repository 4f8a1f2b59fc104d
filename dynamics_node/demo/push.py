"""The push: a force at the last link that moves the arm some way and then lets it come to rest."""

import numpy as np

from .mujoco_arm import MujocoArm

WANTED = 0.5  # [rad] how far the joint that gives way most is to move


def plan_push(arm: MujocoArm, driven: np.ndarray, duration: float) -> np.ndarray:
    """
    Return a force [N] in the base frame, shape (3,), for a push of `duration` seconds.

    A weightless arm with viscous friction d that is pushed by the joint torque t_i = (J^T F)_i
    moves on until friction has eaten the impulse: way_i = t_i * duration / d_i, whatever its
    inertia. The force is the one that moves the softest joint by WANTED radians.

    """
    directions = _directions(arm.skeleton(driven)[-1])
    ways = [_way(arm, driven, direction, duration) for direction in directions]
    clearance = [_clearance(arm, driven, way) for way in ways]
    # All is well with the first one that stays within the limits; else the least bad one.
    best = int(np.argmax(np.minimum(clearance, 0.05)))
    turning = [joint.turns for joint in arm.driven]
    friction = _dry_friction(arm, driven, directions[best])
    return directions[best] * (_force(ways[best][turning]) + friction)


def _directions(tip: np.ndarray) -> list[np.ndarray]:
    """Return unit vectors to try, shape (3,) each: sideways and up first, then the others."""
    radius = np.hypot(tip[0], tip[1])
    side = np.array([-tip[1], tip[0], 0.0]) / radius if radius > 0.05 else np.array([0.0, 1, 0])
    up = np.array([0.0, 0.0, 1.0])
    pairs = [(0.5, 1.0), (-0.5, 1.0), (1.0, 0.0), (-1.0, 0.0), (0.5, -1.0), (-0.5, -1.0)]
    return [(s * side + u * up) / np.hypot(s, u) for s, u in pairs]


def _way(arm: MujocoArm, driven: np.ndarray, direction: np.ndarray, duration: float) -> np.ndarray:
    """Return how far a force of 1 N moves every driven joint, shape (n_driven,) [rad or m]."""
    torque = arm.last_link_jacobian(driven).T @ direction
    return torque * duration / _effective_damping(arm)


def _effective_damping(arm: MujocoArm) -> np.ndarray:
    """Return the damping seen by the driven joints: theirs and that of joints that mimic."""
    return np.diag(arm.mimic_matrix.T @ np.diag(arm.damping()) @ arm.mimic_matrix)


def _force(way: np.ndarray) -> float:
    """Return the force [N] that moves the softest joint by WANTED."""
    return WANTED / max(float(np.max(np.abs(way))), 1e-9)


def _clearance(arm: MujocoArm, driven: np.ndarray, way: np.ndarray) -> float:
    """Return the distance [rad] that the turning joints would keep from their limits."""
    turning = np.array([joint.turns for joint in arm.driven])
    goal = driven + way * _force(way[turning])
    lower = np.array([joint.lower for joint in arm.driven])
    upper = np.array([joint.upper for joint in arm.driven])
    return float(np.min(np.minimum(goal - lower, upper - goal)[turning]))


def _dry_friction(arm: MujocoArm, driven: np.ndarray, direction: np.ndarray) -> float:
    """Return the force [N] that it takes to overcome dry friction at the best lever."""
    torque = np.abs(arm.last_link_jacobian(driven).T @ direction)
    friction = np.abs(arm.mimic_matrix).T @ arm.friction()
    best = int(np.argmax(torque))
    return float(friction[best] / max(torque[best], 1e-9))
