"""The tables of links, bodies and joints, from the description and the tree."""

import math

import numpy as np

from .report import BodyEntry, JointEntry, LinkEntry
from ..inertia import consistency_report, mass_and_com
from ..model.build import resolve_mimic
from ..urdf.inertial import link_pseudo_inertia


def link_entries(examination):
    """
    Return what the URDF says about each link, `LinkEntry` in its order.

    Parameters
    ----------
    examination : Examination

    Returns
    -------
    tuple of LinkEntry

    """
    carriers = _carriers(examination.description)
    return tuple(
        _link(link, carriers.get(link.name), link.name in examination.unread)
        for link in examination.description.links
    )


def body_entries(tree, description):
    """
    Return what each joint moves, `BodyEntry` in the order of the tree.

    Parameters
    ----------
    tree : KinematicTree
    description : RobotDescription

    Returns
    -------
    tuple of BodyEntry

    """
    child = {joint.name: joint.child for joint in description.joints}
    members: list[list] = [[] for _ in tree.moving_joint_names]
    for name, frame in tree.links.items():
        if frame.body >= 0 and name != child[tree.moving_joint_names[frame.body]]:
            members[frame.body].append(name)
    entries = []
    for body, joint in enumerate(tree.moving_joint_names):
        mass, com = mass_and_com(tree.inertia[body])
        found = consistency_report(tree.inertia[body])
        parent = tree.parent[body]
        entries.append(
            BodyEntry(
                joint,
                child[joint],
                None if parent < 0 else tree.moving_joint_names[parent],
                tuple(members[body]),
                mass,
                tuple(com.tolist()) if mass else None,
                tuple(found.principal_moments.tolist()),
                found.is_physical,
            )
        )
    return tuple(entries)


def joint_entries(description):
    """
    Return the movable joints, `JointEntry` without gravity, in the order of the URDF.

    Parameters
    ----------
    description : RobotDescription
        Complete or in parts.

    Returns
    -------
    tuple of JointEntry

    """
    movable = [joint for joint in description.joints if joint.is_movable]
    by_name = {joint.name: joint for joint in movable}
    leaders = {joint.name: _as_written(joint) for joint in movable}
    if all(_mimic_ends(joint, by_name) for joint in movable):
        leaders = resolve_mimic(movable)
    return tuple(_joint(joint, *leaders[joint.name]) for joint in movable)


def _as_written(joint):
    mimic = joint.mimic
    return (
        (joint.name, 1.0, 0.0) if mimic is None else (mimic.leader, mimic.multiplier, mimic.offset)
    )


def _mimic_ends(joint, by_name):
    # In a refused description joints may mimic each other in a circle, or one that is unknown.
    seen = set()
    while joint.mimic is not None:
        seen.add(joint.name)
        if joint.mimic.leader in seen or joint.mimic.leader not in by_name:
            return False
        joint = by_name[joint.mimic.leader]
    return True


def _link(link, carrier, is_unread):
    inertial = link.inertial
    if inertial is None:
        return LinkEntry(
            link.name,
            is_unread,
            link.has_shape,
            math.nan if is_unread else 0.0,
            None,
            None,
            (),
            carrier,
        )
    found = consistency_report(link_pseudo_inertia(inertial))
    return LinkEntry(
        link.name,
        True,
        link.has_shape,
        inertial.mass,
        tuple(inertial.placement[:3, 3].tolist()) if inertial.mass else None,
        tuple(np.linalg.eigvalsh(inertial.tensor).tolist()),
        found.violations,
        carrier,
    )


def _carriers(description):
    # Link → the movable joint above it, as far as the joints are known.
    above = {joint.child: joint for joint in description.joints}
    carriers = {}
    for link in description.links:
        name, seen = link.name, set()
        while name in above and not above[name].is_movable and name not in seen:
            seen.add(name)
            name = above[name].parent
        if name in above and above[name].is_movable:
            carriers[link.name] = above[name].name
    return carriers


def _joint(joint, leader, multiplier, offset):
    mimics = leader if leader != joint.name else None
    return JointEntry(
        joint.name,
        joint.parent,
        joint.child,
        joint.kind,
        mimics,
        float(multiplier),
        float(offset),
        joint.lower,
        joint.upper,
        joint.velocity,
        joint.effort,
        joint.damping,
        joint.friction,
    )
