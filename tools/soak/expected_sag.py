"""What an arm does whose effort goes to zero by a ramp: MuJoCo's word for it."""

from dynamics_node.demo.mujoco_arm import MujocoArm
from dynamics_node.demo.mujoco_model import TIME_STEP
import numpy as np


def sink(urdf_text, position, effort, ramp, duration):
    """
    Let an arm at rest sink.

    Parameters
    ----------
    urdf_text : str
    position : numpy.ndarray, shape (n_driven,)
        Where it stands, rad or m.
    effort : numpy.ndarray, shape (n_driven,)
        What holds it at first, N m or N.
    ramp : float
        From that effort to zero, s.
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
