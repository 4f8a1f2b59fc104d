"""Arms that end in a flange: the mass of the tool is missing."""

from __future__ import annotations

import re

import numpy as np

from .context import FindingContext
from .effects import added_torque, unit_of
from .kinds import NOTE, WARNING
from ..formatting import plain_number, quoted_names
from ..report import Finding, JointEntry, LinkEntry

_TOOL = re.compile(
    r'gripper|(^|_)hand|finger|jaw|claw|suction|vacuum|pinch|robotiq|2f_?85|'
    r'effector|eef|tool|tcp|flange|attach|palm|(^|_)ee($|_)',
    re.IGNORECASE,
)
# Names of links that are no tools, whatever else the name contains.
_NO_TOOL = re.compile(
    r'foot|sole|ankle|toe|leg|wheel|head|neck|camera|imu|laser|contact', re.IGNORECASE
)
# Number of joints from which a chain is an arm.
_ARM = 4
# Mass of the assumed tool, kg.
_KILOGRAM = 1.0


def find_missing_tools(context: FindingContext) -> list[Finding]:
    """Return arms whose last joint carries no tool with a mass."""
    if context.analysis is None or not context.moved_with_mass:
        return []
    findings = []
    for joint in _last_joints(context):
        entries = [entry for entry in context.report.links if entry.carrier == joint.name]
        if any(_NO_TOOL.search(entry.name) for entry in entries):
            continue
        if any(entry.mass > 0.0 and _TOOL.search(entry.name) for entry in entries):
            continue
        frames = [entry for entry in entries if entry.name != joint.child]
        tools = [entry for entry in frames if _TOOL.search(entry.name)]
        if not tools and (_has_massless_shape(context, frames) or len(_leaves(context)) > 1):
            continue  # a massless shape has a finding of its own
        findings.append(_finding(context, joint, entries, tools))
    return findings


def _has_massless_shape(context: FindingContext, frames: list[LinkEntry]) -> bool:
    return any(context.links[entry.name].has_visual and not entry.mass for entry in frames)


def _leaves(context: FindingContext) -> list[JointEntry]:
    return [joint for joint in context.report.joints if not context.body_children[joint.name]]


def _last_joints(context: FindingContext) -> list[JointEntry]:
    # Joints of fingers are mimic or prismatic joints, or side by side on one body: such an arm
    # has a gripper.
    return [
        joint
        for joint in _leaves(context)
        if _is_last_of_arm(context, joint)
        and joint.mimics is None
        and joint.kind != 'prismatic'
        and not _TOOL.search(joint.name + joint.child)
    ]


def _is_last_of_arm(context: FindingContext, joint: JointEntry) -> bool:
    parent = context.body_parent[joint.name]
    siblings = context.body_children[parent] if parent else []
    depth, above = 1, parent
    while above is not None:
        depth, above = depth + 1, context.body_parent[above]
    return depth >= _ARM and len(siblings) == 1


def _finding(
    context: FindingContext, joint: JointEntry, entries: list[LinkEntry], tools: list[LinkEntry]
) -> Finding:
    visible = [entry for entry in tools if context.links[entry.name].has_visual]
    place = (visible or tools or entries)[-1]
    if visible:
        what = (
            f"behind the last joint '{joint.name}' {quoted_names(e.name for e in visible)} "
            'is visible but massless: the mass of the gripper is missing'
        )
    else:
        what = (
            f"behind the last joint '{joint.name}' there is no tool with a mass: "
            f'the arm ends in {quoted_names([e.name for e in tools] or [place.name])}'
        )
    return Finding(
        WARNING if visible else NOTE,
        'missing_gripper',
        (place.name, *(other.name for other in tools if other is not place)),
        what,
        f"a gripper of 1 kg at '{place.name}' adds up to {_added(context, place.name)}; without "
        'its mass that is missing in the gravity torque',
        'add its <inertial> to the URDF, or set the parameters of the node: payload.link: '
        f'{place.name}, payload.mass, payload.com',
    )


def _added(context: FindingContext, link: str) -> str:
    joint, torque = added_torque(context, link, _KILOGRAM)
    model = context.require_analysis().model
    limit = float(model.effort_limits[model.joint_names.index(joint)])
    share = '' if np.isnan(limit) else f', {plain_number(100.0 * torque / limit)} % of its limit'
    return f"{plain_number(torque)} {unit_of(context, joint)} to joint '{joint}'{share}"
