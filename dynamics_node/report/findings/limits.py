"""Limits that are missing, zero or exchanged, and gravity beyond them."""

import math

from .effects import Effect, UNKNOWN
from .hit import Hit, told
from .kinds import NOTE, WARNING
from .words import names, number, percent
from ..report import Finding


def find_limits(case):
    """Return what is wrong with limits."""
    joints = [joint for joint in case.report.joints if joint.mimics is None]
    stated = {joint.name: case.joints[joint.name].stated for joint in joints}
    below = [joint for joint in joints if stated[joint.name].effort < 0.0]
    zero = [joint for joint in joints if stated[joint.name].effort == 0.0]
    missing = [
        joint
        for joint in joints
        if math.isnan(joint.effort) and joint not in below and joint not in zero
    ]
    weighs = bool(case.moved_with_mass)  # or else nobody knows what gravity asks
    still = [joint for joint in joints if math.isnan(joint.velocity)]
    return [
        *_over(joints, case.study),
        *_empty_ranges(case, joints),
        *_efforts('zero_effort_limit', below, 'an effort limit below zero', weighs),
        *_efforts('zero_effort_limit', zero, 'an effort limit of 0', weighs),
        *_efforts('no_effort_limit', missing, 'no effort limit', weighs),
        *_velocities(case, still),
        *_not_looked_at(joints),
    ]


def _over(joints, study):
    hits = [
        Hit(
            WARNING,
            'over_effort_limit',
            joint.name,
            f"joint '{joint.name}': gravity alone takes up to {number(joint.gravity.magnitude)} "
            f'{joint.effort_unit}, {100.0 * joint.gravity.share:.1f} % of its effort limit of '
            f'{number(joint.effort)} {joint.effort_unit}',
            f'{number(joint.gravity.magnitude)} of {number(joint.effort)} {joint.effort_unit}',
            _sinks(study, joint),
            'check masses, centers of mass and <limit effort> (N m or N at the joint, behind the '
            'gear); or the arm must keep away from there',
            joint.gravity.share,
        )
        for joint in joints
        if joint.gravity is not None and joint.gravity.share > 1.0
    ]
    return told(hits, lambda count: f'gravity alone is above the effort limit of {count} joints')


def _efforts(kind, joints, words, weighs):
    if not joints:
        return []
    known = [joint for joint in joints if joint.gravity is not None]
    effect = ''
    if known:
        most = max(known, key=lambda joint: joint.gravity.magnitude)
        effect = (
            ''
            if not weighs
            else 'gravity asks nothing of them; '
            if most.gravity.magnitude == 0.0
            else f'gravity asks up to {number(most.gravity.magnitude)} {most.effort_unit} of '
            f"'{most.name}'; "
        )
    asked = not weighs or any(
        joint.gravity is None or joint.gravity.magnitude > 0.0 for joint in joints
    )
    return [
        Finding(
            WARNING if asked else NOTE,
            kind,
            tuple(joint.name for joint in joints),
            f'{_counted(joints)} {words}: {names(joint.name for joint in joints)}',
            f'{effect}the node refuses to be enabled, and the payload that is left is not known',
            'write what the motor can do, <limit effort="..."/>, or tell the node: parameter '
            'effort_limits',
        )
    ]


def _velocities(case, joints):
    if not joints:
        return []
    written = {case.joints[joint.name].stated.velocity for joint in joints}
    said = 'a velocity limit of 0' if written == {0.0} else 'no velocity limit that can be used'
    if all(math.isnan(value) for value in written):
        said = 'no velocity limit'
    return [
        Finding(
            NOTE,
            'no_velocity_limit',
            tuple(joint.name for joint in joints),
            f'{_counted(joints)} {said}: {names(joint.name for joint in joints)}',
            'no torque: but a joint that jumps or runs away is not noticed by the node',
            'write <limit velocity="..."/>',
        )
    ]


def _empty_ranges(case, joints):
    found, unlimited = [], []
    for joint in joints:
        if joint.kind == 'continuous' or math.isfinite(joint.lower) or math.isfinite(joint.upper):
            continue
        stated = case.joints[joint.name].stated
        lower, upper = (
            (0.0 if math.isnan(value) else value) for value in (stated.lower, stated.upper)
        )
        if math.isnan(stated.lower) and math.isnan(stated.upper):
            unlimited.append(joint)
        elif lower >= upper:
            found.append(
                Hit(
                    WARNING,
                    'empty_range',
                    joint.name,
                    f"joint '{joint.name}': lower limit {number(lower)} {joint.unit} is not below "
                    f'upper limit {number(upper)} {joint.unit}',
                    f'{number(lower)} to {number(upper)} {joint.unit}',
                    _later_range(joint),
                    'exchange them, or make the joint fixed or continuous if that is meant',
                )
            )
    return told(found, lambda count: f'{count} joints have an empty range')


def _later_range(joint):
    if joint.gravity is None:
        return UNKNOWN
    return Effect(
        'it counts as a joint without limits: its largest gravity torque, '
        f'{number(joint.gravity.magnitude)} {joint.effort_unit}, may be at a position '
        'that it never has',
        math.nan,
    )


def _sinks(study, joint):
    index = study.model.joint_names.index(joint.name)
    share = float((abs(study.torques[:, index]) > joint.effort).mean())
    return Effect(
        f'at {percent(share)} of the sampled positions it sinks whatever the motor '
        'does; held there, the node reports a FAULT after 2 s',
        share,
    )


def _not_looked_at(joints):
    standing = [joint for joint in joints if joint.kind == 'prismatic' and joint.range_note]
    if not standing:
        return []
    return [
        Finding(
            NOTE,
            'not_looked_at',
            tuple(joint.name for joint in standing),
            f'{_counted(standing, "slides", "slide")} without limits: '
            f'{names(joint.name for joint in standing)}',
            f'this report has {"it" if len(standing) == 1 else "them"} stand at the neutral '
            'position only: torques of other joints may be larger elsewhere',
            'write <limit lower="..." upper="..."/> in meters',
        )
    ]


def _counted(joints, one='has', many='have'):
    return f'one joint {one}' if len(joints) == 1 else f'{len(joints)} joints {many}'
