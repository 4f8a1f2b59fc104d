"""The links whose <inertial> takes the change of a moving body."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..inertia import combine, transform_pseudo_inertia
from ..model import KinematicTree
from ..urdf import RobotDescription

Array = NDArray[np.float64]

# Smallest share of the body's mass with which its own link takes the change: some URDFs have an
# almost massless link there, and the mass in a link that is fixed to it.
MIN_SHARE = 0.2


@dataclass(frozen=True, eq=False)
class Carrier:
    """
    The link that takes the change of one moving body; the other links of the body keep theirs.

    Attributes
    ----------
    link : str
    rest : numpy.ndarray, shape (4, 4)
        J of the other links of the body, in the body's frame: kg m², kg m, kg.
    placement : numpy.ndarray, shape (4, 4)
        Link frame → body frame, m.

    """

    link: str
    rest: Array
    placement: Array

    def link_inertia(self, body: Array) -> Array:
        """
        Return J of the link alone with which the body has a given J.

        Parameters
        ----------
        body : numpy.ndarray, shape (4, 4)
            J of the whole body in its frame. If it is not larger than `rest`, no real link has
            the result.

        Returns
        -------
        numpy.ndarray, shape (4, 4)
            J about the link frame's origin, for `write_urdf`.

        """
        return transform_pseudo_inertia(body - self.rest, _inverse(self.placement))


def carrier_links(tree: KinematicTree, description: RobotDescription) -> tuple[Carrier, ...]:
    """
    Choose the link of each moving body whose <inertial> takes a change of the body's J.

    It is the child link of the body's joint, unless this has less than MIN_SHARE of the body's
    mass: then the heaviest link of the body.

    Parameters
    ----------
    tree : KinematicTree
        With N moving bodies.
    description : RobotDescription
        Description of the same robot.

    Returns
    -------
    tuple of Carrier
        N carriers, in the order of the bodies.

    """
    inertia = {
        link.name: link.inertial.pseudo_inertia
        for link in description.links
        if link.inertial is not None
    }
    child = {joint.name: joint.child for joint in description.joints}
    members: list[list[str]] = [[] for _ in tree.moving_joint_names]
    for link in description.links:
        frame = tree.links[link.name]
        if frame.body >= 0 and link.name in inertia:
            members[frame.body].append(link.name)
    return tuple(
        _carrier(tree, inertia, child[joint], links)
        for joint, links in zip(tree.moving_joint_names, members, strict=True)
    )


def _carrier(
    tree: KinematicTree, inertia: dict[str, Array], own: str, links: list[str]
) -> Carrier:
    mass = {link: float(inertia[link][3, 3]) for link in links}
    is_light = mass.get(own, 0.0) < MIN_SHARE * sum(mass.values())
    link = max(links, key=mass.__getitem__) if is_light else own
    # Summed, not subtracted: what is left of a heavy body would be its rounding.
    rest = combine(
        (inertia[other], tree.links[other].placement) for other in links if other != link
    )
    return Carrier(link, rest, tree.links[link].placement)


def _inverse(placement: Array) -> Array:
    result = np.eye(4)
    result[:3, :3] = placement[:3, :3].T
    result[:3, 3] = -placement[:3, :3].T @ placement[:3, 3]
    return result
