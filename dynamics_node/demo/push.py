"""The push: a force at the last link that moves the arm by a planned angle."""

import numpy as np

from .mujoco_arm import MujocoArm

WANTED = 0.5  # [rad] planned displacement of the joint that moves most


def plan_push(arm: MujocoArm, driven: np.ndarray, duration: float) -> np.ndarray:
    """
    Return a force [N] in the base frame, shape (3,), for a push of `duration` seconds.

    A gravity-compensated arm with viscous friction d, pushed by the joint torque
    t_i = (J^T F)_i, moves until friction has consumed the impulse:
    displacement_i = t_i * duration / d_i, independent of its inertia. The returned force moves
    the softest joint by WANTED.

    """
    directions = _directions(arm.skeleton(driven)[-1])
    displacements = [_displacement(arm, driven, direction, duration) for direction in directions]
    clearance = [_clearance(arm, driven, displacement) for displacement in displacements]
    # The first direction that keeps 0.05 rad from the limits, else the one with most clearance.
    best = int(np.argmax(np.minimum(clearance, 0.05)))
    turning = [joint.turns for joint in arm.driven]
    friction = _dry_friction(arm, driven, directions[best])
    return directions[best] * (_force(displacements[best][turning]) + friction)


def _directions(tip: np.ndarray) -> list[np.ndarray]:
    """Return unit vectors to try, shape (3,) each: sideways and up first, then the others."""
    radius = np.hypot(tip[0], tip[1])
    side = np.array([-tip[1], tip[0], 0.0]) / radius if radius > 0.05 else np.array([0.0, 1, 0])
    up = np.array([0.0, 0.0, 1.0])
    pairs = [(0.5, 1.0), (-0.5, 1.0), (1.0, 0.0), (-1.0, 0.0), (0.5, -1.0), (-0.5, -1.0)]
    return [(s * side + u * up) / np.hypot(s, u) for s, u in pairs]


def _displacement(
    arm: MujocoArm, driven: np.ndarray, direction: np.ndarray, duration: float
) -> np.ndarray:
    """Return the displacement by a force of 1 N, shape (n_driven,) [rad or m]."""
    torque = arm.last_link_jacobian(driven).T @ direction
    return torque * duration / _effective_damping(arm)


def _effective_damping(arm: MujocoArm) -> np.ndarray:
    """Return the damping of the driven joints, with that of their mimic joints."""
    return np.diag(arm.mimic_matrix.T @ np.diag(arm.damping()) @ arm.mimic_matrix)


def _force(displacement: np.ndarray) -> float:
    """Return the force [N] that moves the softest joint by WANTED."""
    return WANTED / max(float(np.max(np.abs(displacement))), 1e-9)


def _clearance(arm: MujocoArm, driven: np.ndarray, displacement: np.ndarray) -> float:
    """Return the least distance [rad] of a revolute joint from its limits after the push."""
    turning = np.array([joint.turns for joint in arm.driven])
    goal = driven + displacement * _force(displacement[turning])
    lower = np.array([joint.lower for joint in arm.driven])
    upper = np.array([joint.upper for joint in arm.driven])
    return float(np.min(np.minimum(goal - lower, upper - goal)[turning]))


def _dry_friction(arm: MujocoArm, driven: np.ndarray, direction: np.ndarray) -> float:
    """Return the force [N] that overcomes dry friction at the joint with the longest lever."""
    torque = np.abs(arm.last_link_jacobian(driven).T @ direction)
    friction = np.abs(arm.mimic_matrix).T @ arm.friction()
    best = int(np.argmax(torque))
    return float(friction[best] / max(torque[best], 1e-9))
