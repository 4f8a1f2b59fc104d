"""Joint definitions that the URDF reader corrected, and robots without movable joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from .context import FindingContext
from .kinds import NOTE, WARNING
from ..formatting import plain_number, quoted_names
from ..report import Finding, JointEntry
from ...dynamics import RobotModel
from ...model import build_tree

# Number of corrected joints that one finding describes.
_DESCRIBED = 3


class _ReaderWarning(NamedTuple):
    """A kind of finding for warnings of the URDF reader with certain words in them."""

    words: str
    kind: str
    severity: str
    effect: str
    advice: str


_READER_WARNINGS = (
    _ReaderWarning(
        ' has length ',
        'axis_length',
        NOTE,
        'none: it is normalized',
        'write a unit vector, so that every other program takes the same axis',
    ),
    _ReaderWarning(
        'must be >= 0: 0 is used',
        'negative_friction',
        WARNING,
        'no gravity torque; compensate.friction ignores it',
        'write <dynamics damping="..." friction="..."/> without a minus sign',
    ),
)
# Warnings of the reader with findings of their own.
_EXPLAINED = ('inertia is not physical', 'axis is missing', 'moving links without mass')


def find_joints(context: FindingContext) -> list[Finding]:
    """Return errors in joint definitions except their limits."""
    findings = _missing_axes(context)
    model = context.report.model
    warnings = model.warnings if model is not None else context.description.warnings
    for kind in _READER_WARNINGS:
        matching = [warning for warning in warnings if kind.words in warning]
        if matching:
            findings.append(
                Finding(
                    kind.severity,
                    kind.kind,
                    _subjects(context, matching),
                    _joined(matching),
                    kind.effect,
                    kind.advice,
                )
            )
    known = (*_EXPLAINED, *(kind.words for kind in _READER_WARNINGS))
    findings += [
        Finding(WARNING, 'reader_warning', (), warning, '', 'check it in the URDF')
        for warning in warnings
        if not any(words in warning for words in known)
    ]
    if not context.report.joints and not context.report.refusals:
        findings.append(
            Finding(
                NOTE,
                'no_movable_joint',
                (),
                'nothing moves: the robot has no movable joint',
                'there is no torque to compute',
                'make a joint revolute, continuous or prismatic',
            )
        )
    return findings


def _missing_axes(context: FindingContext) -> list[Finding]:
    missing = [
        joint for joint in context.report.joints if not context.joints[joint.name].stated.has_axis
    ]
    if not missing:
        return []
    subject = 'one joint has' if len(missing) == 1 else f'{len(missing)} joints have'
    names = quoted_names(joint.name for joint in missing)
    return [
        Finding(
            WARNING,
            'missing_axis',
            tuple(joint.name for joint in missing),
            f'{subject} no <axis>, so the x axis is used: {names}',
            _z_axis_effect(context, missing[0]),
            'write the intended <axis xyz="..."/>',
        )
    ]


def _z_axis_effect(context: FindingContext, entry: JointEntry) -> str:
    # Most joints turn about z.
    analysis, name = context.analysis, entry.mimics or entry.name
    if analysis is None or entry.gravity is None:
        return ''
    joints = tuple(
        replace(other, axis=np.array([0.0, 0.0, 1.0])) if other.name == name else other
        for other in analysis.description.joints
    )
    tree = build_tree(replace(analysis.description, joints=joints))
    model = RobotModel(tree, analysis.model.gravity, compile=False)
    torque = abs(analysis.worst_with(model, model.joint_names.index(name))[1])
    return (
        f"the largest gravity torque of joint '{name}' is "
        f'{plain_number(entry.gravity.magnitude)} {entry.effort_unit}; with the z axis it would '
        f'be {plain_number(torque)} {entry.effort_unit}'
    )


def _subjects(context: FindingContext, warnings: Sequence[str]) -> tuple[str, ...]:
    return tuple(
        name
        for name in context.joints
        if any(warning.startswith(f"joint '{name}':") for warning in warnings)
    )


def _joined(warnings: Sequence[str]) -> str:
    others = len(warnings) - _DESCRIBED
    more = f'; and {others} more joints' if others > 0 else ''
    return '; '.join(warnings[:_DESCRIBED]) + more
