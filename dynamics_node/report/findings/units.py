"""Limits in degrees, and effort limits that exceed any motor of the robot."""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np

from .context import FindingContext
from .effects import Effect, NEGLIGIBLE, unit_of
from .grouping import group_findings, Occurrence
from .kinds import NOTE, WARNING
from ..formatting import enumeration, kilograms, plain_number
from ..report import Finding, JointEntry
from ..workspace_analysis import sample_positions

# Position limit above which a joint makes more than two turns, rad.
_TURNS = 5.0 * math.pi
# Largest position limit that may be in degrees.
_DEGREES = 720.0
# Number of joints that are described one by one.
_NAMED = 4
# Implausible effort limit, in units of the robot's weight times its reach.
_TORQUES = 10.0
# Implausible effort limit of a prismatic joint, in units of the robot's weight.
_FORCES = 100.0
# Multiple of these limits above which no real limit is intended.
_UNINTENDED = 100.0


def find_units(context: FindingContext) -> list[Finding]:
    """Return limits that are probably in another unit, or defaults."""
    return [*_in_degrees(context), *_too_large_efforts(context)]


def _in_degrees(context: FindingContext) -> list[Finding]:
    joints = [
        joint
        for joint in context.report.joints
        if joint.kind == 'revolute'
        and joint.mimics is None
        and math.isfinite(joint.upper - joint.lower)
    ]
    beyond = [
        joint for joint in joints if _TURNS < max(abs(joint.lower), abs(joint.upper)) <= _DEGREES
    ]
    # A single joint with many turns among others is often an endless one.
    if not beyond or 2 * len(beyond) < len(joints):
        return []
    texts = [
        f"'{joint.name}' ({plain_number(joint.lower)} to {plain_number(joint.upper)} rad)"
        for joint in beyond[:_NAMED]
    ]
    first = beyond[0]
    return [
        Finding(
            WARNING,
            'limits_in_degrees',
            tuple(joint.name for joint in beyond),
            'position limits of many turns, which look like degrees: '
            f'{enumeration(texts, len(beyond))}',
            _radian_effect(context, joints),
            f'URDF has radians: \'{first.name}\' lower="{math.radians(first.lower):.5g}" '
            f'upper="{math.radians(first.upper):.5g}"; or make endless joints continuous',
        )
    ]


def _radian_effect(context: FindingContext, joints: list[JointEntry]) -> str:
    analysis = context.analysis
    if analysis is None:
        return ''
    ranges, names = analysis.ranges.copy(), analysis.model.joint_names
    for joint in joints:
        ranges[names.index(joint.name)] = math.radians(joint.lower), math.radians(joint.upper)
    converted = replace(
        analysis,
        ranges=ranges,
        positions=sample_positions(ranges, len(analysis.positions), context.report.seed),
    )
    pairs = [
        (abs(before), abs(after))
        for (_, before), (_, after) in zip(analysis.worst, converted.worst, strict=True)
    ]
    index = max(range(len(pairs)), key=lambda i: abs(pairs[i][0] - pairs[i][1]))
    before, after = pairs[index]
    if abs(after - before) <= NEGLIGIBLE * max(before, after):
        return (
            'if they are degrees, no largest gravity torque changes, but the joints do not stop '
            'at the ends of the real ones'
        )
    unit = unit_of(context, names[index])
    return (
        f"the largest gravity torque of joint '{names[index]}', {plain_number(before)} {unit}, is "
        f'at a position that it never reaches: {plain_number(after)} {unit} if they are degrees'
    )


def _too_large_efforts(context: FindingContext) -> list[Finding]:
    weight = context.moving_mass * float(np.linalg.norm(context.report.gravity))
    if context.analysis is None or not weight > 0.0:
        return []
    largest = {'N m': _TORQUES * weight * context.reach, 'N': _FORCES * weight}
    occurrences = [
        _too_large_effort(context, joint, largest[joint.effort_unit])
        for joint in context.report.joints
        if joint.mimics is None and 0.0 < largest[joint.effort_unit] < joint.effort
    ]
    return group_findings(
        occurrences,
        lambda count: f'{count} joints have an effort limit that exceeds any motor of this robot',
    )


def _too_large_effort(context: FindingContext, joint: JointEntry, largest: float) -> Occurrence:
    limit = f'{plain_number(joint.effort)} {joint.effort_unit}'
    magnitude = 0.0 if joint.gravity is None else joint.gravity.magnitude
    gravity = (
        ''
        if joint.gravity is None
        else f'gravity needs at most {plain_number(magnitude)} {joint.effort_unit} of it; '
    )
    return Occurrence(
        WARNING if joint.effort > _UNINTENDED * largest else NOTE,
        'effort_limit_too_large',
        joint.name,
        f"joint '{joint.name}' has an effort limit of {limit}, in a robot of "
        f'{kilograms(context.moving_mass)} that reaches {plain_number(context.reach)} m: it '
        'exceeds any motor of such a robot',
        limit,
        Effect(
            f'{gravity}shares and payloads that are computed with this limit mean nothing, and '
            'the node limits hardly any command there',
            math.nan,
        ),
        'write the effort of the motor behind the gear, <limit effort="..."/>, or set the '
        'parameter effort_limits of the node',
        magnitude,
    )
