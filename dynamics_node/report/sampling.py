"""Positions to look at: seeded, evenly over what the limits allow."""

import math

import numpy as np

from ..model.tree import PRISMATIC


def sampling_ranges(model):
    """
    Return between which positions each joint is looked at.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    ranges : numpy.ndarray, shape (n, 2)
        rad or m. Where there is no limit: a whole turn for a joint that turns, and the neutral
        position alone for one that slides.
    notes : tuple of n str
        What was put in the place of missing limits; '' where nothing was.

    """
    ranges, notes = np.array(model.position_limits), []
    kinds = dict(zip(model.tree.moving_joint_names, model.tree.joint_type, strict=True))
    for i, name in enumerate(model.joint_names):
        lower, upper = ranges[i]
        if np.isfinite([lower, upper]).all():
            notes.append('')
        elif kinds[name] == PRISMATIC:
            ranges[i] = model.neutral_position[i]
            notes.append(f'without limits: looked at where it stands at {ranges[i, 0]:g} m')
        else:
            if np.isfinite(lower):
                ranges[i] = lower, lower + math.tau
            elif np.isfinite(upper):
                ranges[i] = upper - math.tau, upper
            else:
                ranges[i] = -math.pi, math.pi
            notes.append('without limits: looked at over one turn')
    return ranges, tuple(notes)


def sample_positions(ranges, count, seed):
    """
    Draw positions.

    Parameters
    ----------
    ranges : numpy.ndarray, shape (n, 2)
        See `sampling_ranges`.
    count, seed : int

    Returns
    -------
    numpy.ndarray, shape (count, n)
        Uniform and independent; the same for the same seed.

    """
    rng = np.random.default_rng(seed)
    lower, upper = ranges.T
    return lower + rng.random((count, len(ranges))) * (upper - lower)
