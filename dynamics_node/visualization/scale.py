"""How large things are drawn: as the robot is, so that a small one looks like a large one."""

from dataclasses import dataclass

import numpy as np

# Of the reach: the sphere of the heaviest body, the largest arc around a joint, the arrow of
# 9.81 m/s², the height of a text, and the thinnest that a solid is drawn.
HEAVIEST, ARC, GRAVITY, TEXT, THINNEST = 0.032, 0.09, 0.2, 0.02, 5e-4
# A joint nearer than this part of the reach shares its place with its neighbor.
_SAME_PLACE = 0.01
# Of the distance to the nearest neighbor: as large an arc may be. And of ARC: it is never
# smaller.
_ROOM, _LEAST = 0.6, 0.5
# m: what a description says in place of "without limit".
_FAR = 1e3


@dataclass(frozen=True)
class Sizes:
    """
    The sizes of one robot's picture.

    Attributes
    ----------
    reach : float
        Length of the robot, m, > 0.
    heaviest : float
        Mass of its heaviest body, kg; 1 if none has any.
    arcs : numpy.ndarray, shape (N,)
        Radius of the arc around every joint, m.

    """

    reach: float
    heaviest: float
    arcs: np.ndarray

    @property
    def sphere(self):
        """Radius of the sphere of the heaviest body, m."""
        return HEAVIEST * self.reach

    @property
    def text(self):
        """Height of a text, m."""
        return TEXT * self.reach

    @property
    def text_size(self):
        """The size of a text as a shape has it, m."""
        return (0.35 * self.text, self.text, self.text)

    @property
    def thinnest(self):
        """The thinnest that a solid is drawn, m."""
        return THINNEST * self.reach


def make_sizes(tree):
    """
    Return the sizes of a robot's picture.

    Parameters
    ----------
    tree : KinematicTree

    Returns
    -------
    Sizes

    """
    longest = reach(tree)
    heaviest = float(max(tree.inertia[:, 3, 3], default=0.0))
    return Sizes(longest, heaviest if heaviest > 0.0 else 1.0, arc_radii(tree, longest))


def reach(tree):
    """
    Return how far the robot can be from end to end, roughly: the length of its longest chain.

    Parameters
    ----------
    tree : KinematicTree

    Returns
    -------
    float
        m, > 0: 1 for a robot without any length.

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


def _travel(tree, k):
    # Of a prismatic joint with limits; rails are long, and their joints are at one end.
    low, high = tree.limits[tree.q_index[k], :2]
    travel = high - low if tree.is_prismatic[k] else 0.0
    return travel * abs(tree.multiplier[k]) if travel < _FAR else 0.0


def arc_radii(tree, longest):
    """
    Return the radius of the arc around every joint: smaller where joints are close together.

    Parameters
    ----------
    tree : KinematicTree
    longest : float
        See `reach`, m.

    Returns
    -------
    numpy.ndarray, shape (N,)
        m, of the N bodies' joints.

    """
    room = np.full(len(tree.parent), np.inf)
    for k, parent in enumerate(tree.parent):
        distance = np.linalg.norm(tree.joint_placement[k, :3, 3])
        if parent >= 0 and distance > _SAME_PLACE * longest:
            room[[k, parent]] = np.minimum(room[[k, parent]], distance)
    return np.clip(_ROOM * room, _LEAST * ARC * longest, ARC * longest)
