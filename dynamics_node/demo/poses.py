"""Start poses (high, loaded by gravity, within the limits), and the push that moves the arm."""

from collections.abc import Iterator

import numpy as np

from .mujoco_arm import MujocoArm
from .robot_text import RobotRefusedError

SAMPLES = 2000
MARGIN = 0.15  # share of a joint's range kept free at both ends, to fall and to be pushed
MAX_LOAD = 0.8  # gravity torque of a start pose, relative to the effort limits

# The demo's arm: stretched forward, 30 degrees above the horizontal.
KNOWN: dict[str, dict[str, float]] = {
    'arm7': {
        'shoulder_pitch': 0.95,
        'elbow_pitch': 0.35,
        'wrist_pitch': 0.25,
        'left_finger_slide': 0.02,
    }
}


def start_pose(arm: MujocoArm, name: str) -> np.ndarray:
    """Return the start pose, shape (n_driven,) [rad or m]: the known or a chosen one."""
    if name in KNOWN and set(KNOWN[name]) <= set(arm.driven_names):
        return np.array([KNOWN[name].get(joint, 0.0) for joint in arm.driven_names])
    return choose_pose(arm)


def choose_pose(arm: MujocoArm) -> np.ndarray:
    """Return the best of SAMPLES random poses, (n_driven,) [rad or m]; the seed is fixed."""
    best: np.ndarray | None = None
    best_score = 0.0
    for pose in random_poses(arm, SAMPLES):
        score = _score(arm, pose)
        if score > best_score:
            best, best_score = pose, score
    if best is None:
        raise RobotRefusedError(
            'found no pose that gravity pulls down and that the effort limits can hold; give the '
            'parameter start_pose, one value per driven joint'
        )
    return best


def random_poses(arm: MujocoArm, count: int) -> Iterator[np.ndarray]:
    """Yield the same random poses on every call, shape (n_driven,) each, within the limits."""
    lower = np.array([max(joint.lower, -np.pi) for joint in arm.driven])
    upper = np.array([min(joint.upper, np.pi) for joint in arm.driven])
    # A range entirely beyond one turn, such as 4 to 6 rad, is used as it is.
    beyond = upper <= lower
    lower[beyond] = [joint.lower for joint, b in zip(arm.driven, beyond) if b]
    upper[beyond] = [joint.upper for joint, b in zip(arm.driven, beyond) if b]
    margin = MARGIN * (upper - lower)
    rng = np.random.default_rng(7)
    for _ in range(count):
        yield rng.uniform(lower + margin, upper - margin)


def gravity_peak(arm: MujocoArm) -> np.ndarray:
    """Return the largest sampled gravity torque per driven joint, (n_driven,) [N m or N]."""
    return np.max([np.abs(arm.gravity_torque(q)) for q in random_poses(arm, SAMPLES)], axis=0)


def _score(arm: MujocoArm, pose: np.ndarray) -> float:
    """Return how clearly a pose shows a fall (no unit); 0 where the robot cannot hold it."""
    torque = arm.gravity_torque(pose)
    limit = np.array([joint.effort or np.inf for joint in arm.driven])
    if np.any(np.abs(torque) > MAX_LOAD * limit):
        return 0.0
    turning = np.array([joint.turns for joint in arm.driven])
    fall = np.abs(torque) / np.diag(arm.mass_matrix(pose))
    # Weighted by the torque: a light distal link that swings fast is not a fall.
    return _room_below(arm.skeleton(pose)) * float(
        np.max(np.where(turning, fall * np.abs(torque), 0.0))
    )


def _room_below(points: np.ndarray) -> float:
    """Return a weight for a stick figure (k, 3) [m]: large for high, small below the base."""
    if points[:, 2].min() < 0.0:
        return 1e-3  # not 0: on some robots the arm hangs below its base in every pose
    return float(points[-1, 2] + 0.3 * np.linalg.norm(points[-1]))


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
