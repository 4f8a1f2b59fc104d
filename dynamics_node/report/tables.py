"""Table entries of links, bodies and joints, from the description and the kinematic tree."""

from __future__ import annotations

from collections.abc import Mapping
import math

import numpy as np

from .report import BodyEntry, JointEntry, LinkEntry
from ..inertia import consistency_report, mass_and_com
from ..model import KinematicTree
from ..model.build import resolve_mimic
from ..urdf import Joint, Link, PartialRead, RobotDescription


def link_entries(examination: PartialRead) -> tuple[LinkEntry, ...]:
    """
    Return the links as written in the URDF, in its order.

    Parameters
    ----------
    examination : PartialRead

    Returns
    -------
    tuple of LinkEntry

    """
    carriers = _carriers(examination.description)
    return tuple(
        _link(link, carriers.get(link.name), link.name in examination.unread)
        for link in examination.description.links
    )


def body_entries(tree: KinematicTree, description: RobotDescription) -> tuple[BodyEntry, ...]:
    """
    Return the bodies that the joints move, in the order of the tree.

    Parameters
    ----------
    tree : KinematicTree
    description : RobotDescription

    Returns
    -------
    tuple of BodyEntry

    """
    child = {joint.name: joint.child for joint in description.joints}
    members: list[list[str]] = [[] for _ in tree.moving_joint_names]
    for name, frame in tree.links.items():
        if frame.body >= 0 and name != child[tree.moving_joint_names[frame.body]]:
            members[frame.body].append(name)
    entries = []
    for body, joint in enumerate(tree.moving_joint_names):
        mass, com = mass_and_com(tree.inertia[body])
        consistency = consistency_report(tree.inertia[body])
        parent = tree.parent[body]
        entries.append(
            BodyEntry(
                joint=joint,
                link=child[joint],
                parent=None if parent < 0 else tree.moving_joint_names[parent],
                lumped=tuple(members[body]),
                mass=mass,
                com=tuple(com.tolist()) if mass else None,
                principal_moments=tuple(consistency.principal_moments.tolist()),
                is_physical=consistency.is_physical,
            )
        )
    return tuple(entries)


def joint_entries(description: RobotDescription) -> tuple[JointEntry, ...]:
    """
    Return the movable joints without gravity loads, in the order of the URDF.

    Parameters
    ----------
    description : RobotDescription
        Complete or partial.

    Returns
    -------
    tuple of JointEntry

    """
    movable = [joint for joint in description.joints if joint.is_movable]
    by_name = {joint.name: joint for joint in movable}
    leaders = {joint.name: _leader_as_written(joint) for joint in movable}
    if all(_has_leader(joint, by_name) for joint in movable):
        leaders = resolve_mimic(movable)
    return tuple(_joint(joint, *leaders[joint.name]) for joint in movable)


def _leader_as_written(joint: Joint) -> tuple[str, float, float]:
    mimic = joint.mimic
    return (
        (joint.name, 1.0, 0.0) if mimic is None else (mimic.leader, mimic.multiplier, mimic.offset)
    )


def _has_leader(joint: Joint, by_name: Mapping[str, Joint]) -> bool:
    # In a refused description joints may mimic each other in a circle, or an unknown joint.
    visited = set()
    while joint.mimic is not None:
        visited.add(joint.name)
        if joint.mimic.leader in visited or joint.mimic.leader not in by_name:
            return False
        joint = by_name[joint.mimic.leader]
    return True


def _link(link: Link, carrier: str | None, is_unread: bool) -> LinkEntry:
    inertial = link.inertial
    if inertial is None:
        return LinkEntry(
            name=link.name,
            has_inertial=is_unread,
            has_shape=link.has_shape,
            mass=math.nan if is_unread else 0.0,
            com=None,
            principal_moments=None,
            violations=(),
            carrier=carrier,
        )
    return LinkEntry(
        name=link.name,
        has_inertial=True,
        has_shape=link.has_shape,
        mass=inertial.mass,
        com=tuple(inertial.placement[:3, 3].tolist()) if inertial.mass else None,
        principal_moments=tuple(np.linalg.eigvalsh(inertial.tensor).tolist()),
        violations=consistency_report(inertial.pseudo_inertia).violations,
        carrier=carrier,
    )


def _carriers(description: RobotDescription) -> dict[str, str]:
    # The movable joint above each link, as far as the joints are known.
    above = {joint.child: joint for joint in description.joints}
    carriers = {}
    for link in description.links:
        name, visited = link.name, set()
        while name in above and not above[name].is_movable and name not in visited:
            visited.add(name)
            name = above[name].parent
        if name in above and above[name].is_movable:
            carriers[link.name] = above[name].name
    return carriers


def _joint(joint: Joint, leader: str, multiplier: float, offset: float) -> JointEntry:
    return JointEntry(
        name=joint.name,
        parent=joint.parent,
        child=joint.child,
        kind=joint.kind,
        mimics=leader if leader != joint.name else None,
        multiplier=float(multiplier),
        offset=float(offset),
        lower=joint.lower,
        upper=joint.upper,
        velocity=joint.velocity,
        effort=joint.effort,
        damping=joint.damping,
        friction=joint.friction,
    )
