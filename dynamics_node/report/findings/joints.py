"""What the reader of the URDF has put in order, and robots that do not move."""

from dataclasses import replace

import numpy as np

from .kinds import NOTE, WARNING
from .words import names, number
from ..report import Finding
from ...dynamics import one_off_model
from ...model import build_tree

# Words of a warning of the reader → kind, severity and advice.
_READER = (
    (
        'it is normalized to 1',
        'axis_length',
        NOTE,
        'none: it is normalized',
        'write a unit vector, so that every other program takes the same axis',
    ),
    (
        'must be >= 0: 0 is used',
        'negative_friction',
        WARNING,
        'no gravity torque; compensate.friction leaves it out',
        'write <dynamics damping="..." friction="..."/> without a minus sign',
    ),
)
# Warnings that have findings of their own.
_ELSEWHERE = ('inertia is not physical', 'axis is missing', 'moving links without mass')


def find_joints(case):
    """Return what is wrong with joints beside their limits."""
    found = _axes(case)
    warnings = case.report.model.warnings if case.report.model else case.description.warnings
    for words, kind, severity, effect, advice in _READER:
        mine = [warning for warning in warnings if words in warning]
        if mine:
            found.append(
                Finding(severity, kind, _subjects(case, mine), _together(mine), effect, advice)
            )
    known = (*_ELSEWHERE, *(words for words, *_ in _READER))
    found += [
        Finding(WARNING, 'reader_warning', (), warning, '', 'look at it in the URDF')
        for warning in warnings
        if not any(words in warning for words in known)
    ]
    if not case.report.joints and not case.report.refusals:
        found.append(
            Finding(
                NOTE,
                'no_movable_joint',
                (),
                'nothing moves: the robot has no movable joint',
                'there is no torque to compute',
                'make a joint revolute, continuous or prismatic',
            )
        )
    return found


def _axes(case):
    missing = [
        joint for joint in case.report.joints if not case.joints[joint.name].stated.has_axis
    ]
    if not missing:
        return []
    return [
        Finding(
            WARNING,
            'missing_axis',
            tuple(joint.name for joint in missing),
            f'{"one joint has" if len(missing) == 1 else f"{len(missing)} joints have"} no '
            f'<axis>, so the x axis is used: {names(joint.name for joint in missing)}',
            _axis_effect(case, missing[0]),
            'write the <axis xyz="..."/> that is meant',
        )
    ]


def _axis_effect(case, entry):
    # Most arms turn about z.
    joint = entry.mimics or entry.name
    if case.study is None or entry.gravity is None:
        return ''
    joints = tuple(
        replace(other, axis=np.array([0.0, 0.0, 1.0])) if other.name == joint else other
        for other in case.study.description.joints
    )
    model = one_off_model(
        build_tree(replace(case.study.description, joints=joints)), case.study.model.gravity
    )
    index = model.joint_names.index(joint)
    torque = abs(case.study.worst_with(model, index)[1])
    return (
        f"the largest gravity torque of joint '{joint}' is "
        f'{number(entry.gravity.magnitude)} {entry.effort_unit}; with the z axis it would be '
        f'{number(torque)} {entry.effort_unit}'
    )


def _subjects(case, warnings):
    return tuple(
        name
        for name in case.joints
        if any(warning.startswith(f"joint '{name}':") for warning in warnings)
    )


def _together(warnings, most=3):
    more = f'; and {len(warnings) - most} more joints' if len(warnings) > most else ''
    return '; '.join(warnings[:most]) + more
