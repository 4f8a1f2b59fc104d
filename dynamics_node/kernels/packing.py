"""A kinematic tree as the kernels take it: two arrays, so that a call costs little."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .recursive import (
    AXIS,
    INERTIA,
    JOINT_TYPE,
    MULTIPLIER,
    OFFSET,
    PARENT,
    Q_INDEX,
    ROTATION,
    ROTOR,
    TRANSLATION,
    WIDTH,
)
from ..model.tree import KinematicTree


@dataclass(frozen=True, eq=False)
class PackedModel:
    """
    One robot under one gravity, as the kernels and the code generator take it.

    Attributes
    ----------
    structure : numpy.ndarray of int64, shape (N, 3)
        Columns PARENT, JOINT_TYPE, Q_INDEX; read-only.
    numbers : numpy.ndarray of float64, shape (N + 1, WIDTH)
        One row per body; the last row holds gravity in its first three columns; read-only.
    payload_variant : bool
        Whether machine code for it reads the inertia of bodies and rotors when it runs, and so
        serves every payload, instead of containing it. The kernels ignore this.

    """

    structure: NDArray[np.int64]
    numbers: NDArray[np.float64]
    payload_variant: bool = False

    @property
    def body_count(self) -> int:
        """Number of moving bodies, N."""
        return len(self.structure)

    def with_payload_code(self) -> 'PackedModel':
        """Return the same numbers, marked for machine code that serves every payload."""
        return replace(self, payload_variant=True)


def pack(
    tree: KinematicTree,
    gravity: NDArray[np.float64],
    inertia: NDArray[np.float64] | None = None,
    rotor_inertia: NDArray[np.float64] | float = 0.0,
) -> PackedModel:
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
        Of each independent joint, reflected to its side of the gear, kg m² or kg.

    Returns
    -------
    PackedModel
        The payload variant if the inertia is not the tree's own or there are rotors.

    """
    count = len(tree.moving_joint_names)
    structure = np.empty((count, 3), dtype=np.int64)
    structure[:, PARENT] = tree.parent
    structure[:, JOINT_TYPE] = tree.joint_type
    structure[:, Q_INDEX] = tree.q_index
    numbers = np.zeros((count + 1, WIDTH))
    body = numbers[:count]
    rotation = tree.joint_placement[:, :3, :3].reshape(count, 9)
    # Numbers below the rounding of 1 are zero: rpy="1.5707963267948966 0 0" means a right angle,
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
    is_loaded = inertia is not None and inertia is not tree.inertia
    return PackedModel(structure, numbers, bool(is_loaded or rotors.any()))


def ten_numbers(inertia: NDArray[np.float64]) -> NDArray[np.float64]:
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
