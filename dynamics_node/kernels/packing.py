"""How a kinematic tree is handed to the kernels: two arrays, so that a call costs little."""

import numpy as np

from .recursive import (
    AXIS,
    COORDINATE,
    INERTIA,
    KIND,
    MULTIPLIER,
    OFFSET,
    PARENT,
    ROTATION,
    ROTOR,
    TRANSLATION,
    WIDTH,
)


def pack(tree, gravity, inertia=None, rotor_inertia=0.0):
    """
    Pack a tree, the gravity acceleration and the rotors' inertia for the kernels.

    Parameters
    ----------
    tree : KinematicTree
        N bodies.
    gravity : numpy.ndarray, shape (3,)
        m/s², base frame, points down.
    inertia : numpy.ndarray, shape (N, 4, 4), optional
        Pseudo-inertia of each body; by default the tree's own.
    rotor_inertia : numpy.ndarray, shape (n,), or float
        Of each independent joint, as its own side of the gear feels it, kg m² or kg.

    Returns
    -------
    structure : numpy.ndarray of int64, shape (N, 3)
        Columns PARENT, KIND, COORDINATE.
    numbers : numpy.ndarray of float64, shape (N + 1, WIDTH)
        One row per body; the last row holds gravity in its first three columns.

    """
    count = len(tree.moving_joint_names)
    structure = np.empty((count, 3), dtype=np.int64)
    structure[:, PARENT] = tree.parent
    structure[:, KIND] = tree.joint_type
    structure[:, COORDINATE] = tree.q_index
    numbers = np.zeros((count + 1, WIDTH))
    body = numbers[:count]
    rotation = tree.joint_placement[:, :3, :3].reshape(count, 9)
    # What is lost beside 1 by rounding is zero: rpy="1.5707963267948966 0 0" means a right angle,
    # though the cosine of that number is 6e-17.
    body[:, ROTATION:TRANSLATION] = np.where(np.abs(rotation) < 2.0**-53, 0.0, rotation)
    body[:, TRANSLATION:AXIS] = tree.joint_placement[:, :3, 3]
    body[:, AXIS:INERTIA] = tree.axis
    body[:, INERTIA:MULTIPLIER] = ten_numbers(tree.inertia if inertia is None else inertia)
    body[:, MULTIPLIER] = tree.multiplier
    body[:, OFFSET] = tree.offset
    rotors = np.broadcast_to(rotor_inertia, (len(tree.joint_names),))
    body[:, ROTOR] = np.where(tree.is_independent, rotors[tree.q_index], 0.0)
    numbers[count, :3] = gravity
    structure.flags.writeable = numbers.flags.writeable = False
    return structure, numbers


def ten_numbers(inertia):
    """
    Return the ten different numbers of pseudo-inertia matrices.

    Parameters
    ----------
    inertia : numpy.ndarray, shape (N, 4, 4)

    Returns
    -------
    numpy.ndarray, shape (N, 10)
        m, hx, hy, hz, xx, xy, xz, yy, yz, zz.

    """
    rows = [3, 0, 1, 2, 0, 0, 0, 1, 1, 2]
    columns = [3, 3, 3, 3, 0, 1, 2, 1, 2, 2]
    return inertia[:, rows, columns]
