"""Masses that are missing, negative or in grams."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
import math
from typing import NamedTuple

from .context import FindingContext
from .effects import changed, payload_effect, torque_effect
from .grouping import group_findings, Occurrence
from .kinds import NOTE, PROBLEM, WARNING
from .placeholders import is_placeholder
from .tensors import is_too_large, radius_of_gyration
from ..formatting import kilograms, plain_number, quoted_names
from ..report import Finding, LinkEntry

# Mass ratio at which a body is suspiciously lighter than those before and behind it.
_LIGHTER = 30.0
# Mass below which a link is suspicious, kg.
_LIGHT = 0.1
# Both for a body at the end of a chain, which may well be light.
_LIGHTER_AT_END = 500.0
_LIGHT_AT_END = 0.01
# Radius of gyration of an implausible light part, as a share of the robot's reach.
_GYRATION = 0.5
# The same for a part of any mass.
_GYRATION_OF_ALL = 1.0
# Share of the moving mass below which the moments of a link are not representative.
_LIGHT_LINK = 2e-3
# Relative change of a torque below which a light link at the end of a chain is no finding.
_RELEVANT = 0.01
# Range of a link's mass relative to its neighbors' if grams were written as kilograms.
_PLAUSIBLE = (0.05, 20.0)
# Ratio to the heaviest neighbor above which 1000 times the mass is not proposed.
_LIKELY = 3.0


def find_masses(context: FindingContext) -> list[Finding]:
    """Return errors in masses."""
    if context.moved and not context.moved_with_mass and not context.examination.unread:
        return [_no_inertial(context)]
    return [
        *_negative(context),
        *_moves_nothing(context),
        *_massless_shapes(context),
        *_grams(context),
    ]


def _no_inertial(context: FindingContext) -> Finding:
    without = [entry.name for entry in context.moved if not entry.has_inertial]
    reason = (
        'none of them has an <inertial>'
        if len(without) == len(context.moved)
        else 'every <inertial> has a mass of 0'
    )
    return Finding(
        PROBLEM,
        'no_inertial',
        tuple(entry.name for entry in context.moved),
        f'no moving link has a mass: {len(context.moved)} moving links, {reason}',
        'every computed torque is 0: gravity compensation does nothing, and the mass matrix is '
        'zero, so that the node refuses to be enabled',
        'add an <inertial> to every moving link; the URDF exporter of a CAD program writes them, '
        'and a robot without them is meant for visualization only',
    )


def _negative(context: FindingContext) -> list[Finding]:
    occurrences = [
        Occurrence(
            PROBLEM,
            'negative_mass',
            entry.name,
            f"link '{entry.name}' has a mass of {plain_number(entry.mass)} kg",
            f'{plain_number(entry.mass)} kg',
            partial(
                torque_effect,
                context,
                {entry.name: changed(context.inertial(entry.name), mass=0.0)},
                'if it weighed nothing; a negative mass lifts the arm instead',
            ),
            'write its mass without the minus sign, or remove the <inertial>',
            -entry.mass,
        )
        for entry in context.report.links
        if entry.mass < 0.0
    ]
    return group_findings(occurrences, lambda count: f'{count} links have a negative mass')


def _moves_nothing(context: FindingContext) -> list[Finding]:
    # Only at the end of a chain: joints with several axes have massless bodies in the middle.
    # Mimic joints count with the joint that they follow. A partial description does not tell
    # what is behind a joint.
    if not context.examination.is_whole:
        return []
    groups: dict[str, list[str]] = {}
    for joint in context.report.joints:
        groups.setdefault(joint.mimics or joint.name, []).append(joint.name)
    empty = [
        leader
        for leader, joints in groups.items()
        if all(context.body_mass[name] + context.mass_behind[name] <= 0.0 for name in joints)
    ]
    if not empty:
        return []
    subject, verb = ('joint', 'moves') if len(empty) == 1 else (f'{len(empty)} joints', 'move')
    return [
        Finding(
            PROBLEM,
            'joint_moves_nothing',
            tuple(empty),
            f'{subject} {quoted_names(empty)} {verb} no link with a mass',
            'the row of D is zero there, so D is not positive definite: the node refuses to be '
            'enabled, and forward_dynamics has no answer',
            'add an <inertial> to the links behind it, or make it a fixed joint',
        )
    ]


def _massless_shapes(context: FindingContext) -> list[Finding]:
    mass = _median_mass(context)
    occurrences = [
        Occurrence(
            _severity(context, entry),
            'shape_without_mass',
            entry.name,
            f"link '{entry.name}' has a shape but {_missing_mass(entry)}: it weighs nothing",
            _missing_mass(entry),
            partial(
                payload_effect,
                context,
                entry.name,
                mass,
                f'if it weighed {kilograms(mass)}, the median of the moving links',
            ),
            'add an <inertial> with its real mass, unless the mass of the link that it is fixed '
            'to includes it',
            float(_is_alone(context, entry)),
        )
        for entry in context.moved
        if entry.has_shape and entry.mass == 0.0
    ]
    return group_findings(
        occurrences, lambda count: f'{count} moving links have a shape but no mass'
    )


def _severity(context: FindingContext, entry: LinkEntry) -> str:
    # A visible massless link is hardly intended if it is a body of its own, or at the end of a
    # chain, the place of tools. Elsewhere the link before it may include its mass.
    is_at_end = not context.body_children[_carrier(entry)]
    is_suspicious = _is_alone(context, entry) or is_at_end
    return WARNING if context.links[entry.name].has_visual and is_suspicious else NOTE


def _is_alone(context: FindingContext, entry: LinkEntry) -> bool:
    return context.body_mass[_carrier(entry)] == 0.0


def _carrier(entry: LinkEntry) -> str:
    assert entry.carrier is not None  # only for moving links
    return entry.carrier


def _median_mass(context: FindingContext) -> float:
    masses = sorted(entry.mass for entry in context.moved_with_mass)
    return masses[len(masses) // 2] if masses else 1.0


def _missing_mass(entry: LinkEntry) -> str:
    return 'a mass of 0' if entry.has_inertial else 'no <inertial>'


class _Suspicion(NamedTuple):
    """Why a link seems too light, and the masses of its neighbors, kg."""

    what: str
    neighbors: Sequence[float]


def _grams(context: FindingContext) -> list[Finding]:
    occurrences = []
    judges_moments = not _are_most_too_large(context)
    for entry in context.moved_with_mass:
        suspicion = _suspicion(context, entry, judges_moments)
        if suspicion is None:
            continue
        neighbors = suspicion.neighbors
        mass = 1000.0 * entry.mass
        condition = f'if it weighed {kilograms(mass)}'
        if not _is_plausible(mass, neighbors) or mass > _LIKELY * max(neighbors):
            mass = _typical_mass(neighbors)
            condition = f'if it weighed as much as its neighbors, {kilograms(mass)}'
        heavier = changed(context.inertial(entry.name), mass=mass)
        effect = torque_effect(context, {entry.name: heavier}, condition)
        if effect.share < _RELEVANT and not context.body_children[_carrier(entry)]:
            continue  # at the end of a chain, propellers for example may be as light
        occurrences.append(
            Occurrence(
                WARNING,
                'grams',
                entry.name,
                suspicion.what,
                kilograms(entry.mass),
                effect,
                'URDF has kilograms: were grams written as kilograms, or is a digit lost? Weigh '
                'it or look it up in the CAD program, and correct '
                f'<mass value="{plain_number(entry.mass)}"/>',
                max(neighbors) / entry.mass,
            )
        )
    return group_findings(
        occurrences, lambda count: f'{count} links are far lighter than their neighbors'
    )


def _typical_mass(masses: Sequence[float]) -> float:
    # The geometric mean without far lighter ones: fingers do not tell the mass of a hand.
    heavy = [mass for mass in masses if mass >= _PLAUSIBLE[0] * max(masses)]
    return math.exp(sum(map(math.log, heavy)) / len(heavy))


def _is_plausible(mass: float, neighbors: Sequence[float]) -> bool:
    return _PLAUSIBLE[0] * min(neighbors) <= mass <= _PLAUSIBLE[1] * max(neighbors)


def _are_most_too_large(context: FindingContext) -> bool:
    # Then the unit of the moments is wrong, not the mass of the lightest link.
    heavy = [
        entry
        for entry in context.moved_with_mass
        if entry.mass > _LIGHT_LINK * context.moving_mass
    ]
    return 2 * sum(is_too_large(context, entry) for entry in heavy) > len(heavy)


def _suspicion(
    context: FindingContext, entry: LinkEntry, judges_moments: bool
) -> _Suspicion | None:
    carrier = _carrier(entry)
    body = context.body_mass[carrier]
    before = _mass_before(context, carrier)
    behind = [
        context.body_mass[child]
        for child in context.body_children[carrier]
        if context.body_mass[child] > 0.0
    ]
    neighbors = [mass for mass in (before, *behind, body - entry.mass) if mass > 0.1 * entry.mass]
    if not neighbors:
        return None
    weighs = f"link '{entry.name}' weighs {kilograms(entry.mass)}"
    if judges_moments and _has_moments_of_heavier(context, entry, body, neighbors):
        return _Suspicion(
            f'{weighs}, but its moments of inertia are those of a part of '
            f'{plain_number(radius_of_gyration(entry))} m radius (sqrt(I/m)) in a robot that '
            f'reaches {plain_number(context.reach)} m; its neighbors weigh '
            f'{kilograms(max(neighbors))}',
            neighbors,
        )
    if entry.mass < 0.5 * body:
        return None
    if not behind:
        is_light = _LIGHTER_AT_END * body < before and entry.mass < _LIGHT_AT_END
        if not (is_light and _is_plausible(1000.0 * entry.mass, neighbors)):
            return None
        ratio = plain_number(before / body)
        return _Suspicion(f'{weighs}, {ratio} times less than the body that carries it', neighbors)
    load, lightest = context.mass_behind[carrier], min(before, max(behind))
    is_light = _LIGHTER * body < min(lightest, load) and entry.mass < _LIGHT
    if not (is_light and (entry.has_shape or not context.has_shapes)):
        return None
    ratio = plain_number(lightest / body)
    return _Suspicion(
        f'{weighs}, {ratio} times less than the bodies before and behind it, and carries '
        f'{kilograms(load)}',
        neighbors,
    )


def _mass_before(context: FindingContext, carrier: str) -> float:
    # Of the body before a joint, or of the base.
    parent = context.body_parent[carrier]
    if parent is not None:
        return context.body_mass[parent]
    return sum(
        entry.mass for entry in context.report.links if entry.carrier is None and entry.mass > 0.0
    )


def _has_moments_of_heavier(
    context: FindingContext, entry: LinkEntry, body: float, neighbors: Sequence[float]
) -> bool:
    if entry.mass >= 0.1 * max(neighbors):
        return False
    gyration, reach = radius_of_gyration(entry), context.reach
    if gyration > _GYRATION_OF_ALL * reach > 0.0 and _is_plausible(1000.0 * entry.mass, neighbors):
        return True
    if entry.mass >= 0.5 * body:
        return gyration > _GYRATION * reach > 0.0 and entry.mass < 0.1 * min(neighbors)
    # Beside heavier links of the same body: a tool, or its mount.
    return (
        entry.mass < _LIGHT
        and is_too_large(context, entry)
        and _is_plausible(1000.0 * entry.mass, neighbors)
        and not is_placeholder(context.inertial(entry.name).tensor)
    )
