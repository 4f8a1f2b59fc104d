"""Limits that are missing, zero or exchanged, and gravity above effort limits."""

from __future__ import annotations

import math

from .context import FindingContext
from .effects import Effect, UNKNOWN
from .grouping import group_findings, Occurrence
from .kinds import NOTE, WARNING
from ..formatting import plain_number, plain_percent, quoted_names
from ..report import Finding, GravityLoad, JointEntry
from ..workspace_analysis import WorkspaceAnalysis


def find_limits(context: FindingContext) -> list[Finding]:
    """Return errors in limits, and joints that gravity alone overloads."""
    joints = [joint for joint in context.report.joints if joint.mimics is None]
    stated = {joint.name: context.joints[joint.name].stated for joint in joints}
    negative = [joint for joint in joints if stated[joint.name].effort < 0.0]
    zero = [joint for joint in joints if stated[joint.name].effort == 0.0]
    missing = [
        joint
        for joint in joints
        if math.isnan(joint.effort) and joint not in negative and joint not in zero
    ]
    has_masses = bool(context.moved_with_mass)  # otherwise the gravity torques are unknown
    return [
        *_overloaded(joints, context.analysis),
        *_empty_ranges(context, joints),
        *_efforts('zero_effort_limit', negative, 'an effort limit below zero', has_masses),
        *_efforts('zero_effort_limit', zero, 'an effort limit of 0', has_masses),
        *_efforts('no_effort_limit', missing, 'no effort limit', has_masses),
        *_velocities(context, [joint for joint in joints if math.isnan(joint.velocity)]),
        *_not_looked_at(joints),
    ]


def _overloaded(joints: list[JointEntry], analysis: WorkspaceAnalysis | None) -> list[Finding]:
    occurrences = [
        _above_limit(joint, joint.gravity, analysis)
        for joint in joints
        if analysis is not None and joint.gravity is not None and joint.gravity.share > 1.0
    ]
    return group_findings(
        occurrences, lambda count: f'gravity alone is above the effort limit of {count} joints'
    )


def _above_limit(joint: JointEntry, load: GravityLoad, analysis: WorkspaceAnalysis) -> Occurrence:
    torque, limit = plain_number(load.magnitude), plain_number(joint.effort)
    index = analysis.model.joint_names.index(joint.name)
    share = float((abs(analysis.torques[:, index]) > joint.effort).mean())
    return Occurrence(
        WARNING,
        'over_effort_limit',
        joint.name,
        f"joint '{joint.name}': gravity alone takes up to {torque} {joint.effort_unit}, "
        f'{100.0 * load.share:.1f} % of its effort limit of {limit} {joint.effort_unit}',
        f'{torque} of {limit} {joint.effort_unit}',
        Effect(
            f'at {plain_percent(share)} of the sampled positions the motor cannot hold it; held '
            'there, the node reports a FAULT after 2 s',
            share,
        ),
        'check masses, centers of mass and <limit effort> (N m or N at the joint, behind the '
        'gear); without springs or counterweights the arm must keep away from there',
        load.share,
    )


def _efforts(kind: str, joints: list[JointEntry], words: str, has_masses: bool) -> list[Finding]:
    if not joints:
        return []
    loads = {joint: joint.gravity for joint in joints if joint.gravity is not None}
    is_loaded = any(load.magnitude > 0.0 for load in loads.values())
    needs_limit = not has_masses or is_loaded or len(loads) < len(joints)
    effect = ''
    if loads and has_masses:
        joint, load = max(loads.items(), key=lambda item: item[1].magnitude)
        effect = (
            f'gravity needs up to {plain_number(load.magnitude)} {joint.effort_unit} of '
            f"'{joint.name}'; "
            if is_loaded
            else 'gravity does not load them; '
        )
    return [
        Finding(
            WARNING if needs_limit else NOTE,
            kind,
            tuple(joint.name for joint in joints),
            f'{_counted(joints)} {words}: {quoted_names(joint.name for joint in joints)}',
            f'{effect}the node refuses to be enabled, and the payload that is left is not known',
            'write the effort of the motor, <limit effort="..."/>, or set the parameter '
            'effort_limits of the node',
        )
    ]


def _velocities(context: FindingContext, joints: list[JointEntry]) -> list[Finding]:
    if not joints:
        return []
    stated = {context.joints[joint.name].stated.velocity for joint in joints}
    words = 'a velocity limit of 0' if stated == {0.0} else 'no valid velocity limit'
    if all(math.isnan(value) for value in stated):
        words = 'no velocity limit'
    return [
        Finding(
            NOTE,
            'no_velocity_limit',
            tuple(joint.name for joint in joints),
            f'{_counted(joints)} {words}: {quoted_names(joint.name for joint in joints)}',
            'no torque: but the node does not detect that a joint jumps or runs away',
            'write <limit velocity="..."/>',
        )
    ]


def _empty_ranges(context: FindingContext, joints: list[JointEntry]) -> list[Finding]:
    occurrences = []
    for joint in joints:
        if joint.kind == 'continuous' or math.isfinite(joint.lower) or math.isfinite(joint.upper):
            continue
        stated = context.joints[joint.name].stated
        if math.isnan(stated.lower) and math.isnan(stated.upper):
            continue
        lower, upper = (
            (0.0 if math.isnan(value) else value) for value in (stated.lower, stated.upper)
        )
        if lower >= upper:
            occurrences.append(_empty_range(joint, plain_number(lower), plain_number(upper)))
    return group_findings(occurrences, lambda count: f'{count} joints have an empty range')


def _empty_range(joint: JointEntry, lower: str, upper: str) -> Occurrence:
    effect = UNKNOWN
    if joint.gravity is not None:
        effect = Effect(
            'it counts as a joint without limits: its largest gravity torque, '
            f'{plain_number(joint.gravity.magnitude)} {joint.effort_unit}, may be at a position '
            'that it never reaches',
            math.nan,
        )
    return Occurrence(
        WARNING,
        'empty_range',
        joint.name,
        f"joint '{joint.name}': lower limit {lower} {joint.unit} is not below upper limit "
        f'{upper} {joint.unit}',
        f'{lower} to {upper} {joint.unit}',
        effect,
        'exchange them, or make the joint fixed or continuous if that is intended',
    )


def _not_looked_at(joints: list[JointEntry]) -> list[Finding]:
    fixed = [joint for joint in joints if joint.kind == 'prismatic' and joint.range_note]
    if not fixed:
        return []
    names = quoted_names(joint.name for joint in fixed)
    return [
        Finding(
            NOTE,
            'not_looked_at',
            tuple(joint.name for joint in fixed),
            f'{_counted(fixed, "is", "are")} prismatic without limits: {names}',
            f'this report has {"it" if len(fixed) == 1 else "them"} at the neutral position only: '
            'torques of other joints may be larger elsewhere',
            'write <limit lower="..." upper="..."/> in meters',
        )
    ]


def _counted(joints: list[JointEntry], singular: str = 'has', plural: str = 'have') -> str:
    return f'one joint {singular}' if len(joints) == 1 else f'{len(joints)} joints {plural}'
