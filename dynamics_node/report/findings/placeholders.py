"""Inertial parameters that look like placeholders or copies."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .context import FindingContext
from .effects import changed, inertia_effect, torque_effect
from .grouping import group_findings, Occurrence, relevant
from .kinds import NOTE, WARNING
from ..formatting import plain_number, quoted_names
from ..report import Finding, LinkEntry
from ...urdf import Inertial

# Relative effect on a torque or inertia below which there is no finding.
_RELEVANT = 0.01
# Relative effect above which a copy is a warning.
_WARNS = 0.05
# Share of the moving mass below which a link does not matter.
_LIGHT = 0.01
# Ratio to the moment of a ball of the link's size above which a placeholder is a warning.
_WRONG = 10.0
# Length of a chain of equal links that counts as copied.
_COPIES = 3
# Number of copies whose effect is computed.
_COPIES_TRIED = 8
# Share of the moving mass from which a link balanced on its joint is reported.
_HEAVY = 0.05
# Distance to the next joint from which a link balanced on its joint is reported, m.
_LONG = 0.1
# Smallest size of a link for the comparison with a ball, m.
_MIN_SIZE = 0.02


def find_placeholders(context: FindingContext) -> list[Finding]:
    """Return inertial parameters that are unlikely to be real."""
    entries = [
        entry for entry in context.moved_with_mass if entry.mass > _LIGHT * context.moving_mass
    ]
    placeholders, balanced = [], []
    for entry in entries:
        inertial = context.inertial(entry.name)
        if is_placeholder(inertial.tensor):
            placeholders.append(_placeholder(context, entry, inertial))
        if _is_balanced(context, entry, inertial):
            balanced.append(_balanced(context, entry, inertial))
    return [
        *_copies(context),
        *_unit_masses(context, entries),
        *group_findings(
            relevant(placeholders, _RELEVANT),
            lambda count: f'{count} links have a tensor that looks typed by hand',
        ),
        *group_findings(
            relevant(balanced, _RELEVANT),
            lambda count: f'{count} heavy links have their center of mass exactly on their joint',
        ),
    ]


def is_placeholder(tensor: NDArray[np.float64]) -> bool:
    """
    Return whether an inertia tensor is a power of ten times identity, or zero.

    Parameters
    ----------
    tensor : numpy.ndarray, shape (3, 3)
        kg m².

    Returns
    -------
    bool

    """
    value = tensor[0, 0]
    if np.any(tensor != value * np.eye(3)):
        return False
    if value <= 0.0:
        return bool(value == 0.0)
    power = math.log10(value)
    return abs(power - round(power)) < 1e-9


def _placeholder(context: FindingContext, entry: LinkEntry, inertial: Inertial) -> Occurrence:
    value = float(inertial.tensor[0, 0])
    size = max(context.size(entry.name), _MIN_SIZE)
    ball = 0.4 * entry.mass * (0.5 * size) ** 2
    is_far = not ball / _WRONG < value < ball * _WRONG
    has_unit_mass = entry.mass == 1.0
    moments = 'no inertia' if value == 0.0 else f'ixx = iyy = izz = {value:g}'
    mass = ' and a mass of exactly 1 kg' if has_unit_mass else ''
    at_mass = mass or f' at {plain_number(entry.mass)} kg'
    return Occurrence(
        WARNING if value > 0.0 and (is_far or has_unit_mass) else NOTE,
        'placeholder_tensor',
        entry.name,
        f"link '{entry.name}' has {moments}{at_mass}: it looks typed by hand",
        moments + mass,
        inertia_effect(
            context,
            entry.name,
            changed(inertial, tensor=ball * np.eye(3)),
            f'as a ball of {plain_number(size)} m',
        ),
        'take mass, center of mass and tensor from the CAD program, or compute them from the '
        'shape',
        abs(math.log(max(value, 1e-12) / ball)),
    )


def _unit_masses(context: FindingContext, entries: list[LinkEntry]) -> list[Finding]:
    exact = [entry for entry in entries if entry.mass == 1.0]
    if len(exact) < 2:
        return []
    inertials = {entry.name: context.inertial(entry.name) for entry in exact}
    has_placeholder = any(is_placeholder(inertial.tensor) for inertial in inertials.values())
    doubled = {name: changed(inertial, mass=2.0) for name, inertial in inertials.items()}
    return [
        Finding(
            WARNING if has_placeholder else NOTE,
            'placeholder_mass',
            tuple(inertials),
            f'{len(exact)} moving links have a mass of exactly 1 kg: {quoted_names(inertials)}',
            torque_effect(context, doubled, 'if each of them weighed 2 kg').text,
            'check that these masses are measured, or taken from the CAD program',
        )
    ]


def _copies(context: FindingContext) -> list[Finding]:
    # Equal links side by side are fingers, legs and wheels; one behind the other they are copied.
    groups: dict[tuple[float, ...], list[LinkEntry]] = {}
    for entry in context.moved_with_mass:
        inertial = context.inertial(entry.name)
        key = (inertial.mass, *inertial.placement.ravel(), *inertial.tensor.ravel())
        groups.setdefault(key, []).append(entry)
    chains = (_longest_chain(context, entries) for entries in groups.values())
    return [_copied(context, chain) for chain in chains if _is_copied(context, chain)]


def _is_copied(context: FindingContext, chain: list[LinkEntry]) -> bool:
    if len(chain) < _COPIES or sum(entry.mass for entry in chain) < _LIGHT * context.moving_mass:
        return False
    lengths = {round(context.size_without_com(entry.name), 6) for entry in chain}
    # Equal parts of equal length are a chain of modules.
    return len(lengths) > 1 or is_placeholder(context.inertial(chain[0].name).tensor)


def _copied(context: FindingContext, chain: list[LinkEntry]) -> Finding:
    # The first one may turn about the vertical: the largest effect counts.
    effect = max(
        (
            torque_effect(
                context,
                {entry.name: changed(context.inertial(entry.name), mass=2.0 * entry.mass)},
                f"if '{entry.name}' weighed twice as much",
            )
            for entry in chain[:_COPIES_TRIED]
        ),
        key=lambda effect: np.nan_to_num(effect.share),
    )
    return Finding(
        NOTE if effect.share < _WARNS else WARNING,
        'identical_inertials',
        tuple(entry.name for entry in chain),
        f'{len(chain)} links of one chain have the same <inertial> to the last digit '
        f'({plain_number(chain[0].mass)} kg): {quoted_names(entry.name for entry in chain)}',
        effect.text,
        'give each link its own <inertial>, unless they are equal parts indeed',
    )


def _longest_chain(context: FindingContext, entries: list[LinkEntry]) -> list[LinkEntry]:
    # The largest group of entries whose bodies lie on one path to the base.
    best: list[LinkEntry] = []
    if len(entries) < _COPIES:
        return best
    for entry in entries:
        path, joint = set(), entry.carrier
        while joint is not None and joint not in path:
            path.add(joint)
            joint = context.body_parent.get(joint)
        chain = list({other.carrier: other for other in entries if other.carrier in path}.values())
        if len(chain) > len(best):
            best = chain
    return best


def _is_balanced(context: FindingContext, entry: LinkEntry, inertial: Inertial) -> bool:
    return bool(
        not inertial.placement[:3, 3].any()
        and entry.mass > _HEAVY * context.moving_mass
        and max([0.0, *context.joint_distances[entry.name]]) > _LONG
    )


def _balanced(context: FindingContext, entry: LinkEntry, inertial: Inertial) -> Occurrence:
    joint = max(
        (joint for joint in context.description.joints if joint.parent == entry.name),
        key=lambda joint: float(np.linalg.norm(joint.placement[:3, 3])),
    )
    to_joint = joint.placement[:3, 3]
    return Occurrence(
        NOTE,
        'com_at_joint',
        entry.name,
        f"link '{entry.name}' of {plain_number(entry.mass)} kg has its center of mass exactly at "
        f'its frame, though it extends {plain_number(float(np.linalg.norm(to_joint)))} m to joint '
        f"'{joint.name}'",
        f'{plain_number(entry.mass)} kg',
        torque_effect(
            context,
            {entry.name: changed(inertial, com=0.5 * to_joint)},
            f"if it were halfway to joint '{joint.name}'",
        ),
        'check that <inertial><origin xyz> is not missing by mistake',
        entry.mass,
    )
