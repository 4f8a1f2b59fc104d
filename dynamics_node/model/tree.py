"""The tree of moving bodies: frozen arrays, one row per movable joint."""

from dataclasses import dataclass

import numpy as np

REVOLUTE = 0
PRISMATIC = 1


@dataclass(frozen=True)
class LinkFrame:
    """
    Where a link of the URDF is in the tree.

    Attributes
    ----------
    body : int
        Row of the body that carries the link, -1 for the base.
    placement : numpy.ndarray, shape (4, 4)
        Link frame → body frame (or base frame), m.

    """

    body: int
    placement: np.ndarray


@dataclass(frozen=True)
class KinematicTree:
    """
    N moving bodies and n independent joints (N > n if joints mimic others).

    Body k is the child link of movable joint k with everything that fixed joints attach to it.
    Its frame is the child link's frame. A parent comes before its children. Body k stands at
    q_k = multiplier[k] * q[q_index[k]] + offset[k].

    Attributes
    ----------
    root : str
        Name of the root link; its frame is the base frame.
    joint_names : tuple of str
        The n independent joints in the order of the URDF: the order of q.
    moving_joint_names : tuple of str
        The N movable joints in the order of the rows below.
    parent : numpy.ndarray of int, shape (N,)
        Row of the parent body, -1 for the base.
    joint_type : numpy.ndarray of int, shape (N,)
        REVOLUTE or PRISMATIC.
    q_index : numpy.ndarray of int, shape (N,)
        Index into q of the joint that this one is, or follows.
    multiplier, offset : numpy.ndarray, shape (N,)
        1 and 0 but for mimic joints; rad or m.
    joint_placement : numpy.ndarray, shape (N, 4, 4)
        Joint frame at position 0 → parent body frame, m.
    axis : numpy.ndarray, shape (N, 3)
        Unit vectors in the joint frame.
    inertia : numpy.ndarray, shape (N, 4, 4)
        Pseudo-inertia J of each body about its frame's origin: kg m², kg m, kg.
    base_inertia : numpy.ndarray, shape (4, 4)
        J of what is fixed to the root link, in the base frame; no joint feels it.
    links : dict of str to LinkFrame
        Every link of the URDF.
    tip_link : str
        The link at the end of the arm, before the fingers of a hand; the root link if nothing
        moves.
    limits : numpy.ndarray, shape (n, 4)
        Lower, upper (rad or m; infinite if none), velocity, effort (NaN if none) per joint.
    friction : numpy.ndarray, shape (n, 2)
        Viscous (N m s/rad, N s/m) and Coulomb friction (N m, N) per independent joint, with that
        of the joints that mimic it; 0 if the URDF states none.
    warnings : tuple of str
        What was accepted but looks wrong.
    hardware_plugins : tuple of str
        Drivers that the `<ros2_control>` tags of the URDF name.

    """

    root: str
    joint_names: tuple
    moving_joint_names: tuple
    parent: np.ndarray
    joint_type: np.ndarray
    q_index: np.ndarray
    multiplier: np.ndarray
    offset: np.ndarray
    joint_placement: np.ndarray
    axis: np.ndarray
    inertia: np.ndarray
    base_inertia: np.ndarray
    links: dict
    tip_link: str
    limits: np.ndarray
    friction: np.ndarray
    warnings: tuple
    hardware_plugins: tuple = ()

    def __post_init__(self):
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False

    @property
    def is_independent(self):
        """Which bodies' joints are independent, bool, shape (N,); the others mimic one."""
        independent = set(self.joint_names)
        return np.array([name in independent for name in self.moving_joint_names], dtype=bool)

    @property
    def mimic_matrix(self):
        """
        B of q_bodies = B q + b, shape (N, n).

        References
        ----------
        docs/mathematics.md, equation (19).

        """
        matrix = np.zeros((len(self.moving_joint_names), len(self.joint_names)))
        matrix[np.arange(len(self.moving_joint_names)), self.q_index] = self.multiplier
        return matrix
