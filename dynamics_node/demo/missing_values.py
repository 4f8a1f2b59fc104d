"""Viscous friction for joints whose URDF states practically none, as every real drive has it."""

import numpy as np

from .mujoco_arm import MujocoArm
from .poses import gravity_peak, random_poses

# A joint alone slows down as exp(-t d / D_ii).
OF_INERTIA = 2.0  # [1/s]: down to a third within half a second
# Wrists carry little but have gears too: at least 2 % of the arm's largest torque per rad/s.
OF_TORQUE = 0.02  # [s/rad]
NEGLIGIBLE = 0.1  # a joint with less than this share of it counts as one without damping
SAMPLES = 200


def add_missing_damping(arm: MujocoArm) -> list[str]:
    """Give joints without damping some, and return one text per joint that was changed."""
    turning = np.array([joint.turns for joint in arm.joints])
    usual = np.maximum(
        OF_INERTIA * np.abs(arm.mimic_matrix) @ largest_inertia(arm),
        np.where(turning, OF_TORQUE * _largest_torque(arm), 0.0),
    )
    before = arm.damping()
    arm.set_damping(np.where(before < NEGLIGIBLE * usual, usual, before))
    return [
        f'{joint.name} {old:.3g} -> {new:.3g} {"N m s/rad" if joint.turns else "N s/m"}'
        for joint, old, new in zip(arm.joints, before, arm.damping())
        if new != old
    ]


def largest_inertia(arm: MujocoArm) -> np.ndarray:
    """Return the largest sampled D_ii per driven joint, (n_driven,) [kg m^2 or kg]."""
    return np.max([np.diag(arm.mass_matrix(q)) for q in random_poses(arm, SAMPLES)], axis=0)


def _largest_torque(arm: MujocoArm) -> float:
    """Return the largest sampled gravity torque of any turning joint [N m]."""
    turning = np.array([joint.turns for joint in arm.driven])
    return float(np.max(gravity_peak(arm)[turning], initial=0.0))


HEADROOM = 2.0
LEAST = 1.0  # [N m or N]


def joints_without_limit(arm: MujocoArm) -> list[str]:
    """Return the driven joints whose URDF states no positive effort limit."""
    return [joint.name for joint in arm.driven if not joint.effort > 0.0]


def filled_in_limits(arm: MujocoArm) -> np.ndarray:
    """Return the URDF's limits, (n_driven,) [N m or N], and twice the gravity torque elsewhere."""
    stated = np.array([joint.effort for joint in arm.driven])
    return np.where(stated > 0.0, stated, np.maximum(HEADROOM * gravity_peak(arm), LEAST))
