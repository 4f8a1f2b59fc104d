"""From a checked description to the tree of moving bodies: lumping, order, mimic joints."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .tip_link import tip_link
from .tree import KinematicTree, LinkFrame, PRISMATIC, REVOLUTE
from ..errors import RobotDescriptionError
from ..inertia import combine
from ..urdf import Joint, RobotDescription
from ..urdf.validation import LARGEST

# Leader, multiplier, offset (rad or m): q = multiplier * q_leader + offset.
_Leader = tuple[str, float, float]


def build_tree(description: RobotDescription) -> KinematicTree:
    """
    Lump fixed links into the bodies that move and number the joints.

    Parameters
    ----------
    description : RobotDescription

    Returns
    -------
    KinematicTree
        Its warnings are those of the description and one that lists moving bodies without mass.

    Raises
    ------
    RobotDescriptionError
        If the multipliers or offsets of a chain of mimic joints exceed 1e30.

    References
    ----------
    docs/mathematics.md, equations (5) and (19).

    """
    moving, links = _walk(description)
    inertia = _lumped(description, links, len(moving))
    leaders = resolve_mimic(moving)
    free = [joint for joint in description.joints if joint.is_movable and joint.mimic is None]
    index = {joint.name: i for i, joint in enumerate(free)}
    resolved = [leaders[joint.name] for joint in moving]
    tree = KinematicTree(
        root=description.root,
        joint_names=tuple(index),
        moving_joint_names=tuple(joint.name for joint in moving),
        parent=np.array([links[joint.parent].body for joint in moving], dtype=np.int64),
        joint_type=np.array(
            [PRISMATIC if joint.kind == 'prismatic' else REVOLUTE for joint in moving],
            dtype=np.int64,
        ),
        q_index=np.array([index[leader] for leader, _, _ in resolved], dtype=np.int64),
        multiplier=np.array([multiplier for _, multiplier, _ in resolved], dtype=float),
        offset=np.array([offset for _, _, offset in resolved], dtype=float),
        joint_placement=_stack(
            [links[joint.parent].placement @ joint.placement for joint in moving], (4, 4)
        ),
        axis=_stack([joint.axis for joint in moving], (3,)),
        inertia=inertia[:-1],
        base_inertia=inertia[-1],
        links=links,
        tip_link=description.root,
        limits=_stack(
            [(joint.lower, joint.upper, joint.velocity, joint.effort) for joint in free], (4,)
        ),
        friction=_friction(moving, resolved, index),
        warnings=description.warnings + _massless(moving, inertia),
        hardware_plugins=description.hardware_plugins,
    )
    _refuse_overflow(tree)
    return replace(tree, tip_link=tip_link(tree, description))


def _walk(description: RobotDescription) -> tuple[list[Joint], dict[str, LinkFrame]]:
    # Depth first in the order of the URDF; with a stack, because a chain may be longer than the
    # recursion limit. The placement of a link is relative to the body that carries it.
    children: dict[str, list[Joint]] = {}
    for joint in description.joints:
        children.setdefault(joint.parent, []).append(joint)
    moving: list[Joint] = []
    links = {description.root: LinkFrame(-1, np.eye(4))}
    stack = children.get(description.root, [])[::-1]
    while stack:
        joint = stack.pop()
        if joint.is_movable:
            links[joint.child] = LinkFrame(len(moving), np.eye(4))
            moving.append(joint)
        else:
            parent = links[joint.parent]
            links[joint.child] = LinkFrame(parent.body, parent.placement @ joint.placement)
        stack += children.get(joint.child, [])[::-1]
    return moving, links


def _lumped(
    description: RobotDescription, links: dict[str, LinkFrame], count: int
) -> NDArray[np.float64]:
    # Row -1 is the base.
    parts: list[list[tuple[NDArray[np.float64], NDArray[np.float64]]]] = [
        [] for _ in range(count + 1)
    ]
    for link in description.links:
        if link.inertial is None:
            continue
        frame = links[link.name]
        parts[frame.body].append((link.inertial.pseudo_inertia, frame.placement))
    return np.array([combine(bodies) for bodies in parts])


def _friction(
    moving: Sequence[Joint], resolved: Sequence[_Leader], index: dict[str, int]
) -> NDArray[np.float64]:
    # (27): a mimic joint moves faster than its leader by the multiplier, and its effort acts on
    # the leader multiplied once more.
    friction = np.zeros((len(index), 2))
    for joint, (leader, multiplier, _) in zip(moving, resolved, strict=True):
        friction[index[leader]] += (
            multiplier * multiplier * joint.damping,
            abs(multiplier) * joint.friction,
        )
    return friction


def _refuse_overflow(tree: KinematicTree) -> None:
    # Single numbers of a description are bounded, but a chain of mimic joints multiplies them;
    # beyond the bound the dynamics are not finite.
    problems = [
        f'joint {name}: {attribute} of all joints that it mimics in turn: expected at most '
        f'{LARGEST:g}, got {value:g}'
        for attribute in ('multiplier', 'offset')
        for name, value in zip(tree.moving_joint_names, getattr(tree, attribute), strict=True)
        if not abs(value) <= LARGEST
    ]
    if problems:
        raise RobotDescriptionError(problems)


def _massless(moving: Sequence[Joint], inertia: NDArray[np.float64]) -> tuple[str, ...]:
    names = [
        joint.child
        for joint, matrix in zip(moving, inertia, strict=False)
        if not matrix[3, 3] > 0.0
    ]
    if not names:
        return ()
    return (
        'moving links without mass (add an <inertial>, their weight is not compensated): '
        + ', '.join(names),
    )


def _stack(rows: Sequence[object], shape: tuple[int, ...]) -> NDArray[np.float64]:
    return np.array(rows, dtype=float).reshape(len(rows), *shape)


def resolve_mimic(joints: Iterable[Joint]) -> dict[str, _Leader]:
    """
    Follow every chain of mimic joints to its leader.

    Parameters
    ----------
    joints : iterable of Joint
        The movable joints of a checked description: no chain of mimic joints is a cycle.

    Returns
    -------
    dict of str to (str, float, float)
        Joint name → leader, multiplier, offset with q = multiplier * q_leader + offset;
        an independent joint is its own leader with 1 and 0.

    References
    ----------
    docs/mathematics.md, equation (19).

    """
    by_name = {joint.name: joint for joint in joints}
    return {name: _resolve(name, by_name) for name in by_name}


def _resolve(name: str, by_name: dict[str, Joint]) -> _Leader:
    multiplier, offset = 1.0, 0.0
    while (mimic := by_name[name].mimic) is not None:
        # q = m (m' q'' + o') + o, one link of the chain at a time.
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        name = mimic.leader
    return name, multiplier, offset
