"""Effort limits for robots whose URDF states none: the node rightly refuses to drive those."""

import numpy as np

from .mujoco_arm import MujocoArm
from .poses import gravity_peak

HEADROOM = 2.0
LEAST = 1.0  # [N m or N]


def joints_without_limit(arm: MujocoArm) -> list[str]:
    """Return the driven joints whose URDF states no positive effort limit."""
    return [joint.name for joint in arm.driven if not joint.effort > 0.0]


def filled_in_limits(arm: MujocoArm) -> np.ndarray:
    """Return the URDF's limits, (n_driven,) [N m or N], and twice the gravity torque elsewhere."""
    stated = np.array([joint.effort for joint in arm.driven])
    return np.where(stated > 0.0, stated, np.maximum(HEADROOM * gravity_peak(arm), LEAST))
