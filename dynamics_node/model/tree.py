"""The tree of moving bodies: frozen arrays, one row per movable joint."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Values of `KinematicTree.joint_type`.
REVOLUTE = 0
PRISMATIC = 1


@dataclass(frozen=True)
class LinkFrame:
    """
    Place of a URDF link in the tree.

    Attributes
    ----------
    body : int
        Row of the body that carries the link, -1 for the base.
    placement : numpy.ndarray, shape (4, 4)
        Link frame → body frame (or base frame), m.

    """

    body: int
    placement: NDArray[np.float64]


@dataclass(frozen=True)
class KinematicTree:
    """
    N moving bodies and n independent joints (N > n if joints mimic others).

    Body k is the child link of movable joint k together with all links fixed to it. Its frame is
    the child link's frame. A parent comes before its children. The position of joint k is
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
        Index into q: the joint itself, or the leader of a mimic joint.
    multiplier, offset : numpy.ndarray, shape (N,)
        1 and 0, except for mimic joints; the offset in rad or m.
    joint_placement : numpy.ndarray, shape (N, 4, 4)
        Joint frame at position 0 → parent body frame, m.
    axis : numpy.ndarray, shape (N, 3)
        Unit vectors in the joint frame.
    inertia : numpy.ndarray, shape (N, 4, 4)
        Pseudo-inertia J of each body about its frame's origin: kg m², kg m, kg.
    base_inertia : numpy.ndarray, shape (4, 4)
        J of the root link and all links fixed to it, in the base frame; in no equation of motion.
    links : dict of str to LinkFrame
        Every link of the URDF.
    tip_link : str
        Link at the end of the arm, before the fingers of a hand; the root link without joints.
    limits : numpy.ndarray, shape (n, 4)
        Lower, upper (rad or m; infinite if none), velocity, effort (NaN if none) per joint.
    friction : numpy.ndarray, shape (n, 2)
        Viscous (N m s/rad, N s/m) and Coulomb friction (N m, N) per independent joint, including
        the joints that mimic it; 0 if the URDF states none.
    warnings : tuple of str
        Accepted but suspicious values, one sentence each.
    hardware_plugins : tuple of str
        Drivers named in the `<ros2_control>` elements of the URDF.

    """

    root: str
    joint_names: tuple[str, ...]
    moving_joint_names: tuple[str, ...]
    parent: NDArray[np.int64]
    joint_type: NDArray[np.int64]
    q_index: NDArray[np.int64]
    multiplier: NDArray[np.float64]
    offset: NDArray[np.float64]
    joint_placement: NDArray[np.float64]
    axis: NDArray[np.float64]
    inertia: NDArray[np.float64]
    base_inertia: NDArray[np.float64]
    links: dict[str, LinkFrame]
    tip_link: str
    limits: NDArray[np.float64]
    friction: NDArray[np.float64]
    warnings: tuple[str, ...]
    hardware_plugins: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False

    @property
    def is_independent(self) -> NDArray[np.bool_]:
        """False for the joints of bodies that mimic another joint, bool, shape (N,)."""
        independent = set(self.joint_names)
        return np.array([name in independent for name in self.moving_joint_names], dtype=bool)

    @property
    def is_prismatic(self) -> NDArray[np.bool_]:
        """True for bodies that slide along their axis, bool, shape (N,); the others turn."""
        return np.equal(self.joint_type, PRISMATIC)

    @property
    def mimic_matrix(self) -> NDArray[np.float64]:
        """
        B of q_bodies = B q + b, shape (N, n).

        References
        ----------
        docs/mathematics.md, equation (19).

        """
        matrix = np.zeros((len(self.moving_joint_names), len(self.joint_names)))
        matrix[np.arange(len(self.moving_joint_names)), self.q_index] = self.multiplier
        return matrix

    def supporting_joints(self, link: str) -> list[int]:
        """
        Return the joints that carry a link: those between the base and the link.

        Parameters
        ----------
        link : str
            A link of the URDF.

        Returns
        -------
        list of int
            Indices into q, ascending, each once; for a mimic joint that of its leader.

        Raises
        ------
        KeyError
            If the robot has no such link.

        """
        body, joints = self.links[link].body, set()
        while body >= 0:
            joints.add(int(self.q_index[body]))
            body = int(self.parent[body])
        return sorted(joints)
