"""Arms that end in a flange: what will be mounted there has no weight yet."""

import re

import numpy as np

from .effects import added_torque, unit_of
from .kinds import NOTE, WARNING
from .words import names, number
from ..report import Finding

_TOOL = re.compile(
    r'gripper|(^|_)hand|finger|jaw|claw|suction|vacuum|pinch|robotiq|2f_?85|'
    r'effector|eef|tool|tcp|flange|attach|palm|(^|_)ee($|_)',
    re.IGNORECASE,
)
# What is no gripper whatever else its name says.
_NO_TOOL = re.compile(
    r'foot|sole|ankle|toe|leg|wheel|head|neck|camera|imu|laser|contact', re.IGNORECASE
)
# A chain of so many joints is an arm.
_ARM = 4
_KILOGRAM = 1.0


def find_missing_tools(case):
    """Return arms whose last joint carries no tool that weighs something."""
    if case.study is None or not case.moved_with_mass:
        return []
    found = []
    for joint in _last_joints(case):
        entries = [entry for entry in case.report.links if entry.carrier == joint.name]
        frames = [entry for entry in entries if entry.name != joint.child]
        if any(_NO_TOOL.search(entry.name) for entry in entries):
            continue
        tools = [entry for entry in frames if _TOOL.search(entry.name)]
        if any(entry.mass > 0.0 and _TOOL.search(entry.name) for entry in entries):
            continue  # something that is called a tool weighs something
        shaped = [entry for entry in tools if case.links[entry.name].has_visual]
        is_one_arm = len(_leaves(case)) == 1
        is_seen = any(case.links[entry.name].has_visual and not entry.mass for entry in frames)
        if not tools and (is_seen or not is_one_arm):
            continue  # what is seen without mass is told as that
        found.append(_finding(case, joint, (shaped or tools or entries)[-1], tools, shaped))
    return found


def _leaves(case):
    return [joint for joint in case.report.joints if not case.body_children[joint.name]]


def _last_joints(case):
    # Fingers mimic, slide, or sit side by side on one body: then there is a gripper.
    last = []
    for joint in _leaves(case):
        parent = case.body_parent[joint.name]
        siblings = case.body_children[parent] if parent else []
        depth, above = 1, parent
        while above is not None:
            depth, above = depth + 1, case.body_parent[above]
        if (
            depth >= _ARM
            and len(siblings) == 1
            and joint.mimics is None
            and joint.kind != 'prismatic'
            and not _TOOL.search(joint.name + joint.child)
        ):
            last.append(joint)
    return last


def _finding(case, joint, entry, tools, shaped):
    most, torque = added_torque(case, entry.name, _KILOGRAM)
    index = case.study.model.joint_names.index(most)
    limit = float(case.study.model.effort_limits[index])
    share = '' if np.isnan(limit) else f', {number(100.0 * torque / limit)} % of its limit'
    if shaped:
        what = (
            f"behind the last joint '{joint.name}' {names([e.name for e in shaped])} can be "
            'seen without any mass: the gripper is missing'
        )
    else:
        what = (
            f"behind the last joint '{joint.name}' there is no tool that weighs something: "
            f'the arm ends in {names([e.name for e in tools] or [entry.name])}'
        )
    subjects = (entry.name, *(other.name for other in tools if other is not entry))
    return Finding(
        WARNING if shaped else NOTE,
        'missing_gripper',
        subjects,
        what,
        f"a gripper of 1 kg at '{entry.name}' adds up to {number(torque)} "
        f"{unit_of(case, most)} to joint '{most}'{share}; until it is known, that is missing in "
        'the gravity torque',
        'add its <inertial> to the URDF, or tell the node: parameters payload.link: '
        f'{entry.name}, payload.mass, payload.com',
    )
