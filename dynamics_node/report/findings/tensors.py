"""Inertia tensors that are physically impossible, or those of another body."""

from __future__ import annotations

from functools import partial
import math

import numpy as np
from numpy.typing import NDArray

from .context import FindingContext
from .effects import changed, Effect, inertia_effect, largest, NEGLIGIBLE, UNKNOWN
from .grouping import group_findings, Occurrence, relevant
from .kinds import NOTE, PROBLEM, WARNING
from ..formatting import plain_number, plain_percent
from ..report import Finding, LinkEntry
from ...inertia import steiner
from ...inertia.consistency import rounding_of
from ...urdf import Inertial

# Ratio of the largest moment to the sum of the others below which the excess is rounding.
_ROUNDED = 1.02
# Ratio at which two principal moments are nothing beside the third.
_FLAT = 1e6
# Relative effect on an inertia below which a possible tensor is no finding.
_RELEVANT = 0.01
# Relative effect above which the finding is a warning.
_WARNS = 0.05
_DIAGONAL = ('ixx', 'iyy', 'izz')
# Factors of a missing decimal point.
_FACTORS = (10.0, 100.0, 1000.0)
# Implausible radius of gyration in units of the link's size.
_GYRATION_OF_LINK = 3.0
# Implausible radius of gyration as a share of the robot's reach.
_GYRATION_OF_REACH = 0.2
# Share of the moving mass below which the moments of a link do not matter.
_LIGHT = 2e-3
# Share of the products of inertia that remains if the parallel axis term explains them.
_EXPLAINED = 0.1
# Products of inertia below this share of the trace are too small for that conclusion.
_SMALL_PRODUCTS = 0.02
_NO_EFFECT = Effect('none: it stands on the base, where no joint feels it', 0.0)


def find_tensors(context: FindingContext) -> list[Finding]:
    """Return errors in inertia tensors."""
    impossible, triangle, large, shifted = [], [], [], []
    for entry in context.report.links:
        inertial = context.links[entry.name].inertial
        if inertial is None or not entry.mass >= 0.0:
            continue
        principal = np.array(entry.principal_moments)
        tolerance = rounding_of(inertial.pseudo_inertia)
        if principal[0] < -tolerance:
            impossible.append(_impossible(context, entry, principal, inertial))
        elif principal[2] - principal[1] - principal[0] > tolerance:
            triangle.append(_triangle(context, entry, principal, inertial))
        elif entry.carrier is not None and entry.mass > _LIGHT * context.moving_mass:
            if is_too_large(context, entry):
                large.append(_too_large(context, entry, inertial))
            elif _is_about_frame(inertial):
                shifted.append(_about_frame(context, entry, inertial))
    large += _copies(context, {occurrence.subject for occurrence in large})
    return [
        *group_findings(
            impossible, lambda count: f'{count} links have a tensor that is not positive definite'
        ),
        *group_findings(
            triangle,
            lambda count: (
                f'{count} links have physically impossible principal moments (one is larger than '
                'the sum of the two others)'
            ),
        ),
        *group_findings(
            relevant(large, _RELEVANT),
            lambda count: (
                f'{count} links have moments of inertia far too large for their mass and size'
            ),
        ),
        *group_findings(
            relevant(shifted, _RELEVANT),
            lambda count: (
                f'{count} links have a tensor that seems to be about the link frame, not about '
                'the center of mass'
            ),
        ),
    ]


def _copies(context: FindingContext, links: set[str]) -> list[Occurrence]:
    # Larger links with the very mass and tensor of a link that is too small for them.
    inertials = {entry.name: context.links[entry.name].inertial for entry in context.report.links}
    keys = {_key(inertial) for name, inertial in inertials.items() if inertial and name in links}
    return [
        _too_large(context, entry, inertial)
        for entry in context.moved_with_mass
        if entry.name not in links
        and (inertial := inertials[entry.name]) is not None
        and _key(inertial) in keys
    ]


def _key(inertial: Inertial) -> tuple[float, ...]:
    return inertial.mass, *inertial.tensor.ravel().tolist()


def _is_on_base(context: FindingContext, entry: LinkEntry) -> bool:
    return entry.carrier is None and context.examination.is_whole


def _impossible(
    context: FindingContext, entry: LinkEntry, principal: NDArray[np.float64], inertial: Inertial
) -> Occurrence:
    is_on_base = _is_on_base(context, entry)
    return Occurrence(
        NOTE if is_on_base else PROBLEM,
        'impossible_inertia',
        entry.name,
        f"link '{entry.name}': its inertia is physically impossible: the smallest principal "
        f'moment is {plain_number(principal[0])} kg m^2, must be >= 0',
        f'{plain_number(principal[0])} kg m^2',
        _NO_EFFECT
        if is_on_base
        else UNKNOWN
        if context.analysis is None
        else partial(
            _share_in_inertia,
            context,
            entry.name,
            changed(inertial, tensor=_positive(inertial.tensor)),
        ),
        'the signs of ixy, ixz, iyz or a diagonal entry are wrong, or one product of inertia is '
        'too large: copy the tensor again from the CAD program, about the center of mass',
        -float(principal[0]),
    )


def _triangle(
    context: FindingContext, entry: LinkEntry, principal: NDArray[np.float64], inertial: Inertial
) -> Occurrence:
    ratio = float(principal[2] / max(principal[0] + principal[1], 1e-300))
    severity = PROBLEM if ratio > _ROUNDED else NOTE
    if severity == NOTE:
        corrected, comparison = _cut(inertial), 'with the largest moment cut to that sum'
        advice = 'rounding, most likely: write the tensor with more digits'
    else:
        corrected, comparison, advice = _correction(inertial)
    if _is_on_base(context, entry):
        severity, effect = NOTE, _NO_EFFECT
    else:
        effect = inertia_effect(context, entry.name, corrected, comparison)
        if effect.share < NEGLIGIBLE:
            severity = NOTE
    return Occurrence(
        severity,
        'triangle_inequality',
        entry.name,
        f"link '{entry.name}': its inertia is physically impossible: "
        + _violation(principal, ratio),
        _excess(ratio) if ratio < _FLAT else 'two moments of 0',
        effect,
        advice,
        min(ratio, _FLAT),
    )


def _violation(principal: NDArray[np.float64], ratio: float) -> str:
    # Rounding errors beside the largest moment are shown as zero.
    least, middle = (
        0.0 if abs(moment) < principal[2] / _FLAT else float(moment) for moment in principal[:2]
    )
    greatest = plain_number(principal[2])
    if ratio > _FLAT:
        return (
            f'one principal moment is {greatest} kg m^2, the two others are '
            f'{plain_number(least)} and {plain_number(middle)}'
        )
    return (
        f'the largest principal moment, {greatest} kg m^2, is {_excess(ratio)} the sum of the '
        f'two others, {plain_number(least)} + {plain_number(middle)}'
    )


def _excess(ratio: float) -> str:
    # '0.04 % more than', where '1 times' would say nothing.
    if ratio < _ROUNDED:
        return f'{plain_percent(ratio - 1.0)} more than'
    return f'{plain_number(ratio)} times'


def _correction(inertial: Inertial) -> tuple[Inertial, str, str]:
    # A lost or misplaced decimal point: one diagonal entry that is 10, 100 or 1000 times too
    # large, or else too small.
    tensor = inertial.tensor
    order = np.argsort(-np.diagonal(tensor))
    for i, exponent in ((order[0], -1.0), *((j, 1.0) for j in order[:0:-1])):
        for factor in _FACTORS:
            trial = tensor.copy()
            trial[i, i] = tensor[i, i] * factor**exponent
            moments = np.linalg.eigvalsh(trial)
            if moments[0] > 0.0 and moments[2] <= moments[0] + moments[1]:
                name, size = _DIAGONAL[i], 'large' if exponent < 0.0 else 'small'
                entry = f'{name}="{trial[i, i]:.6g}"'
                return (
                    changed(inertial, tensor=trial),
                    f'with {entry}',
                    f'a decimal point may be missing: {name}="{tensor[i, i]:.6g}" is '
                    f'{factor:g} times too {size}, {entry} is physically possible; look it up in '
                    'the CAD program',
                )
    return (
        _cut(inertial),
        'with the largest moment cut to that sum',
        'copy the tensor again from the CAD program: about the center of mass, in kg m^2, '
        'ixy, ixz, iyz with their signs',
    )


def _cut(inertial: Inertial) -> Inertial:
    moments, axes = np.linalg.eigh(inertial.tensor)
    moments[2] = min(moments[2], moments[0] + moments[1])
    return changed(inertial, tensor=axes @ np.diag(moments) @ axes.T)


def _positive(tensor: NDArray[np.float64]) -> NDArray[np.float64]:
    moments, axes = np.linalg.eigh(tensor)
    return axes @ np.diag(np.abs(moments)) @ axes.T


def with_absolute_values(inertial: Inertial) -> Inertial:
    """
    Return inertial parameters without negative values, so that torques can be computed.

    Parameters
    ----------
    inertial : Inertial

    Returns
    -------
    Inertial
        With absolute values of mass and principal moments; the same object if none is negative.

    """
    moments = np.linalg.eigvalsh(inertial.tensor)
    if inertial.mass >= 0.0 and moments[0] >= 0.0:
        return inertial
    return changed(inertial, mass=abs(inertial.mass), tensor=_positive(inertial.tensor))


def _share_in_inertia(context: FindingContext, link: str, corrected: Inertial) -> Effect:
    # The share of a link's tensor in the inertia of the joints.
    analysis = context.require_analysis()
    joints = analysis.supporting_joints(link)
    if not joints:
        return UNKNOWN
    model = analysis.with_inertials({link: changed(corrected, tensor=np.zeros((3, 3)))})
    share, column = largest(
        np.nan_to_num(
            1.0 - context.diagonal_of(model)[:, joints] / context.sampled_inertia[:, joints]
        )
    )
    name = analysis.model.joint_names[joints[column]]
    return Effect(
        f'the tensor is up to {plain_percent(share)} of the inertia (D_jj) that joint '
        f"'{name}' feels, if its signs are made positive; as it is, RobotModel and the node "
        'refuse the robot',
        share,
    )


def is_too_large(context: FindingContext, entry: LinkEntry) -> bool:
    """
    Return whether the moments of inertia of a link would need mass far outside the link.

    Parameters
    ----------
    context : FindingContext
    entry : LinkEntry
        With a positive mass.

    Returns
    -------
    bool

    """
    gyration = radius_of_gyration(entry)
    return (
        gyration > _GYRATION_OF_LINK * context.size(entry.name)
        and gyration > _GYRATION_OF_REACH * context.reach > 0.0
    )


def radius_of_gyration(entry: LinkEntry) -> float:
    """Return the radius of gyration (m) about the principal axis of the largest moment."""
    assert entry.principal_moments is not None  # it has a mass
    return math.sqrt(max(0.0, entry.principal_moments[2]) / entry.mass)


def _too_large(context: FindingContext, entry: LinkEntry, inertial: Inertial) -> Occurrence:
    assert entry.principal_moments is not None  # it has a mass
    gyration = radius_of_gyration(entry)
    size = max(context.size(entry.name), 0.05)
    ball = changed(inertial, tensor=0.4 * entry.mass * size**2 * np.eye(3))
    as_if = f'as if its mass were {plain_number(gyration)} m from its center'
    extent = plain_number(context.size(entry.name))
    return Occurrence(
        WARNING,
        'inertia_too_large',
        entry.name,
        f"link '{entry.name}' has {plain_number(entry.principal_moments[2])} kg m^2 at "
        f'{plain_number(entry.mass)} kg, {as_if}; its joints and center of mass are within '
        f'{extent} m',
        f'{as_if}, in a link of {extent} m',
        inertia_effect(context, entry.name, ball, f'as a ball of {plain_number(size)} m radius'),
        'URDF has kg m^2: g mm^2 are 1e-9 and kg mm^2 are 1e-6 of it, lb in^2 2.93e-4; look for '
        'a missing decimal point too',
        gyration / size,
    )


def _is_about_frame(inertial: Inertial) -> bool:
    com = inertial.placement[:3, 3]
    if not com.any() or not inertial.mass > 0.0:
        return False
    tensor = _in_link_axes(inertial)
    without = _without_parallel_axis_term(inertial)
    moments = np.linalg.eigvalsh(without)
    if not moments[0] > 0.0 or moments[2] > moments[0] + moments[1]:
        return False
    products = _products(tensor)
    return bool(
        products > _SMALL_PRODUCTS * np.trace(tensor)
        and _products(without) < _EXPLAINED * products
    )


def _about_frame(context: FindingContext, entry: LinkEntry, inertial: Inertial) -> Occurrence:
    rotation = inertial.placement[:3, :3]
    without = _without_parallel_axis_term(inertial)
    before, after = _products(_in_link_axes(inertial)), _products(without)
    effect = inertia_effect(
        context,
        entry.name,
        changed(inertial, tensor=rotation.T @ without @ rotation),
        'with the tensor moved to the center of mass',
    )
    return Occurrence(
        NOTE if effect.share < _WARNS else WARNING,
        'tensor_not_about_com',
        entry.name,
        f"link '{entry.name}': its tensor seems to be about the link frame: moved to the center "
        f'of mass (Steiner), its products of inertia go from {plain_number(before)} to '
        f'{plain_number(after)} kg m^2',
        f'{plain_number(before)} to {plain_number(after)} kg m^2',
        effect,
        'URDF needs the tensor about the center of mass, in the axes of <origin rpy>: take that '
        'one from the CAD program',
        before,
    )


def _in_link_axes(inertial: Inertial) -> NDArray[np.float64]:
    rotation = inertial.placement[:3, :3]
    return rotation @ inertial.tensor @ rotation.T


def _without_parallel_axis_term(inertial: Inertial) -> NDArray[np.float64]:
    com = inertial.placement[:3, 3]
    return _in_link_axes(inertial) - steiner(np.zeros((3, 3)), inertial.mass, com)


def _products(tensor: NDArray[np.float64]) -> float:
    return float(np.linalg.norm([tensor[0, 1], tensor[0, 2], tensor[1, 2]]))
