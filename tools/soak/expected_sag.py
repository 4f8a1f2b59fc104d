"""The sag of an arm while its effort fades to zero, by MuJoCo."""

from dynamics_node.demo.mujoco_arm import MujocoArm
from dynamics_node.demo.mujoco_model import TIME_STEP
import numpy as np


def expected_sag(urdf_text, position, effort, ramp, duration):
    """
    Simulate an arm at rest while its effort fades to zero.

    Parameters
    ----------
    urdf_text : str
    position : numpy.ndarray, shape (n_driven,)
        Start position, rad or m.
    effort : numpy.ndarray, shape (n_driven,)
        Initial effort, N m or N.
    ramp : float
        Duration from that effort to zero, s.
    duration : float
        s.

    Returns
    -------
    time, position, speed : numpy.ndarray, shape (k,), (k, n) and (k,)
        s; rad or m, of all n joints; the largest of any joint's, rad/s or m/s.

    """
    arm = MujocoArm(urdf_text)
    arm.place(position)
    arm.set_brakes(False)
    times = TIME_STEP * np.arange(1, round(duration / TIME_STEP) + 1)
    positions, speeds = [], []
    for time in times:
        arm.set_effort(effort * max(1.0 - time / ramp, 0.0))
        arm.step()
        positions.append(arm.position.copy())
        speeds.append(np.abs(arm.velocity).max())
    return times, np.array(positions), np.array(speeds)
