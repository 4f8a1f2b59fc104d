"""Damping and effort limits for joints whose URDF states none."""

import numpy as np

from .mujoco_arm import MujocoArm
from .poses import gravity_peak, random_poses

# Damping per inertia [1/s]: velocities fall as exp(-t d / D_ii), to a third in half a second.
DAMPING_PER_INERTIA = 2.0
# Damping per largest gravity torque of the arm [s/rad]: wrists carry little but have gears, too.
DAMPING_PER_TORQUE = 0.02
# Relative to these values: less counts as no damping.
NEGLIGIBLE = 0.1
SAMPLES = 200  # poses
EFFORT_PER_GRAVITY = 2.0  # a filled-in effort limit, relative to the largest gravity torque
MIN_EFFORT_LIMIT = 1.0  # [N m or N]


def add_missing_damping(arm: MujocoArm) -> list[str]:
    """Add viscous friction to joints without damping; return one text per changed joint."""
    turning = np.array([joint.turns for joint in arm.joints])
    usual = np.maximum(
        DAMPING_PER_INERTIA * np.abs(arm.mimic_matrix) @ largest_inertia(arm),
        np.where(turning, DAMPING_PER_TORQUE * _largest_torque(arm), 0.0),
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


def joints_without_limit(arm: MujocoArm) -> list[str]:
    """Return the driven joints whose URDF states no positive effort limit."""
    return [joint.name for joint in arm.driven if not joint.effort > 0.0]


def filled_in_limits(arm: MujocoArm) -> np.ndarray:
    """Return effort limits, (n_driven,) [N m or N]: the URDF's, else twice the gravity torque."""
    stated = np.array([joint.effort for joint in arm.driven])
    return np.where(
        stated > 0.0, stated, np.maximum(EFFORT_PER_GRAVITY * gravity_peak(arm), MIN_EFFORT_LIMIT)
    )
