"""Limits that are in degrees, or that no motor of this robot has."""

from dataclasses import replace
import math

import numpy as np

from .effects import Effect, NOTHING, unit_of
from .hit import Hit, told
from .kinds import NOTE, WARNING
from .words import kilograms, listed, number
from ..report import Finding
from ..sampling import sample_positions

# Beyond so many rad a joint makes more than two turns; up to so many, they may be degrees.
_TURNS, _DEGREES = 5.0 * math.pi, 720.0
# So many joints are told one by one.
_SHOWN = 4
# So many times the torque of the whole robot, hung up at its full reach, is no motor of it; or so
# many times its weight, where a joint slides.
_TORQUES, _FORCES = 10.0, 100.0
# Beyond so many times of that no limit was meant at all.
_NONE_MEANT = 100.0


def find_units(case):
    """Return limits that are likely in another unit, or a default."""
    return [*_in_degrees(case), *_without_meaning(case)]


def _in_degrees(case):
    joints = [
        joint
        for joint in case.report.joints
        if joint.kind == 'revolute'
        and joint.mimics is None
        and math.isfinite(joint.upper - joint.lower)
    ]
    beyond = [
        joint for joint in joints if _TURNS < max(abs(joint.lower), abs(joint.upper)) <= _DEGREES
    ]
    # One joint of many that turns for ever is often written so.
    if not beyond or 2 * len(beyond) < len(joints):
        return []
    shown = [
        f"'{joint.name}' ({number(joint.lower)} to {number(joint.upper)} rad)"
        for joint in beyond[:_SHOWN]
    ]
    first = beyond[0]
    return [
        Finding(
            WARNING,
            'limits_in_degrees',
            tuple(joint.name for joint in beyond),
            'position limits of many turns, which look like degrees: '
            f'{listed(shown, len(beyond))}',
            _radian_effect(case, joints),
            f'URDF has radians: \'{first.name}\' lower="{math.radians(first.lower):.5g}" '
            f'upper="{math.radians(first.upper):.5g}"; or make joints without end continuous',
        )
    ]


def _radian_effect(case, joints):
    if case.study is None:
        return ''
    study, ranges = case.study, case.study.ranges.copy()
    for joint in joints:
        index = study.model.joint_names.index(joint.name)
        ranges[index] = math.radians(joint.lower), math.radians(joint.upper)
    meant = replace(
        study,
        ranges=ranges,
        positions=sample_positions(ranges, len(study.positions), case.report.seed),
    )
    pairs = [
        (abs(before[1]), abs(after[1]))
        for before, after in zip(study.worst, meant.worst, strict=True)
    ]
    index = max(range(len(pairs)), key=lambda i: abs(pairs[i][0] - pairs[i][1]))
    before, after = pairs[index]
    if abs(after - before) <= NOTHING * max(before, after):
        return (
            'if they are degrees, no largest gravity torque changes, but nothing stops the '
            'joints where the real ones end'
        )
    name = study.model.joint_names[index]
    unit = unit_of(case, name)
    return (
        f"the largest gravity torque of joint '{name}', {number(before)} {unit}, is at a "
        f'position that it never has: {number(after)} {unit} if they are degrees'
    )


def _without_meaning(case):
    joints = [joint for joint in case.report.joints if joint.mimics is None]
    weight = case.moving_mass * float(np.linalg.norm(case.report.gravity))
    if case.study is None or not weight > 0.0:
        return []
    most = {'N m': _TORQUES * weight * case.reach, 'N': _FORCES * weight}
    hits = [
        Hit(
            WARNING if joint.effort > _NONE_MEANT * most[joint.effort_unit] else NOTE,
            'effort_limit_too_large',
            joint.name,
            f"joint '{joint.name}' has an effort limit of {number(joint.effort)} "
            f'{joint.effort_unit}, in a robot of {kilograms(case.moving_mass)} that reaches '
            f'{number(case.reach)} m: no motor of it has that',
            f'{number(joint.effort)} {joint.effort_unit}',
            _hides(joint),
            'write what the motor can do behind the gear, <limit effort="..."/>, or tell the '
            'node: parameter effort_limits',
            0.0 if joint.gravity is None else joint.gravity.magnitude,
        )
        for joint in joints
        if 0.0 < most[joint.effort_unit] < joint.effort
    ]
    return told(
        hits, lambda count: f'{count} joints have an effort limit that no motor of this robot has'
    )


def _hides(joint):
    asked = (
        ''
        if joint.gravity is None
        else (
            f'gravity asks at most {number(joint.gravity.magnitude)} {joint.effort_unit} of it; '
        )
    )
    return Effect(
        f'{asked}shares and payloads that are computed with this limit mean nothing, '
        'and the node lets nearly any command through there',
        math.nan,
    )
