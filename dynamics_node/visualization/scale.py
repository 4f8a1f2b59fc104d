"""Sizes of shapes, proportional to the robot: pictures of small and large robots look alike."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.tree import KinematicTree

# Relative to the reach: radius of the heaviest body's sphere, radius of the largest arc around a
# joint, length of the arrow of 9.81 m/s², height of a text, least thickness of a solid.
HEAVIEST, ARC, GRAVITY, TEXT, THINNEST = 0.032, 0.09, 0.2, 0.02, 5e-4
# Relative to the reach: joints closer than this count as coincident.
_COINCIDENT = 0.01
# Largest radius of an arc, relative to the distance to the nearest joint.
_ARC_PER_DISTANCE = 0.6
# Smallest radius of an arc, relative to ARC.
_MIN_ARC = 0.5
# A travel this long stands in descriptions for "no limit", m.
_UNLIMITED_TRAVEL = 1e3


@dataclass(frozen=True)
class Scale:
    """
    The sizes of one robot's picture.

    Attributes
    ----------
    reach : float
        Length of the robot, m, > 0.
    heaviest : float
        Mass of its heaviest body, kg; 1 for a robot without mass.
    arcs : numpy.ndarray, shape (N,)
        Radius of the arc around each joint, m.

    """

    reach: float
    heaviest: float
    arcs: NDArray[np.float64]

    @property
    def sphere(self) -> float:
        """Radius of the sphere of the heaviest body, m."""
        return HEAVIEST * self.reach

    @property
    def text(self) -> float:
        """Height of a text, m."""
        return TEXT * self.reach

    @property
    def text_size(self) -> tuple[float, float, float]:
        """Size of a text shape, m."""
        return (0.35 * self.text, self.text, self.text)

    @property
    def thinnest(self) -> float:
        """Least thickness of a solid, m."""
        return THINNEST * self.reach


def make_scale(tree: KinematicTree) -> Scale:
    """
    Return the sizes of a robot's picture.

    Parameters
    ----------
    tree : KinematicTree

    Returns
    -------
    Scale

    """
    longest = reach(tree)
    heaviest = float(max(tree.inertia[:, 3, 3], default=0.0))
    return Scale(longest, heaviest if heaviest > 0.0 else 1.0, arc_radii(tree, longest))


def reach(tree: KinematicTree) -> float:
    """
    Return the approximate reach of a robot: the length of its longest chain.

    Parameters
    ----------
    tree : KinematicTree

    Returns
    -------
    float
        m, > 0; 1 for a robot without length.

    """
    length = np.zeros(len(tree.parent) + 1)  # the last one is the base
    for k, parent in enumerate(tree.parent):
        length[k] = (
            length[parent] + np.linalg.norm(tree.joint_placement[k, :3, 3]) + _travel(tree, k)
        )
    to_masses = [
        length[k] + np.linalg.norm(J[:3, 3]) / J[3, 3]
        for k, J in enumerate(tree.inertia)
        if J[3, 3] > 0.0
    ]
    longest = max([*length, *to_masses])
    return float(longest) if 0.0 < longest < np.inf else 1.0


def _travel(tree: KinematicTree, k: int) -> float:
    # A prismatic joint adds its travel: rails are long, with the joint frame at one end.
    low, high = tree.limits[tree.q_index[k], :2]
    travel = high - low if tree.is_prismatic[k] else 0.0
    return travel * abs(tree.multiplier[k]) if travel < _UNLIMITED_TRAVEL else 0.0


def arc_radii(tree: KinematicTree, longest: float) -> NDArray[np.float64]:
    """
    Return the radius of the arc around each joint: smaller where joints are close together.

    Parameters
    ----------
    tree : KinematicTree
    longest : float
        The reach, m.

    Returns
    -------
    numpy.ndarray, shape (N,)
        m, for the joint of each of the N bodies.

    """
    room = np.full(len(tree.parent), np.inf)
    for k, parent in enumerate(tree.parent):
        distance = np.linalg.norm(tree.joint_placement[k, :3, 3])
        if parent >= 0 and distance > _COINCIDENT * longest:
            room[[k, parent]] = np.minimum(room[[k, parent]], distance)
    return np.clip(_ARC_PER_DISTANCE * room, _MIN_ARC * ARC * longest, ARC * longest)
