"""Masses that are missing, negative or given in grams."""

import math

from .defaults import is_placeholder
from .effects import changed, payload_effect, torque_effect
from .hit import Hit, told
from .kinds import NOTE, PROBLEM, WARNING
from .tensors import is_too_large
from .words import factor, kilograms, names, number
from ..report import Finding

# A body so many times lighter than those before and behind it is suspicious; it must be lighter
# than this, kg, too, and what it carries heavier.
_LIGHTER = 30.0
_LIGHT = 0.1
# At the end of a chain a body may be light; so many times lighter is suspicious there, too.
_LIGHTER_AT_END, _LIGHT_AT_END = 500.0, 0.01
# Radius of gyration, as a share of the robot's reach, that no light part of it has, and that none
# has at all.
_GYRATION, _GYRATION_OF_ALL = 0.5, 1.0
# Moments of links lighter than this share of what moves do not tell what all of them are like.
_LIGHT_LINK = 2e-3
# What changes no torque by as much is not told.
_MATTERS = 0.01
# If grams were written as kilograms, then the mass is between these shares of its neighbors';
# as what it may weigh it is named only if it is not much more than theirs.
_PLAUSIBLE, _LIKELY = (0.05, 20.0), 3.0


def find_masses(case):
    """Return what is wrong with masses."""
    if case.moved and not case.moved_with_mass and not case.examination.unread:
        return [_nothing_weighs(case)]
    return [*_negative(case), *_moves_nothing(case), *_shapes(case), *_grams(case)]


def _nothing_weighs(case):
    without = [entry.name for entry in case.moved if not entry.has_inertial]
    how = (
        'none of them has an <inertial>'
        if len(without) == len(case.moved)
        else 'every <inertial> has a mass of 0'
    )
    return Finding(
        PROBLEM,
        'no_inertial',
        tuple(entry.name for entry in case.moved),
        f'nothing that moves has a mass: {len(case.moved)} moving links, {how}',
        'every torque that is computed is 0: gravity compensation does nothing, and the mass '
        'matrix is zero, so that the node refuses to be enabled',
        'add an <inertial> to every moving link; the exporter of the CAD program writes them, '
        'and a robot without them is meant for pictures only',
    )


def _negative(case):
    hits = [
        Hit(
            PROBLEM,
            'negative_mass',
            entry.name,
            f"link '{entry.name}' has a mass of {number(entry.mass)} kg",
            f'{number(entry.mass)} kg',
            _later(
                torque_effect,
                case,
                {entry.name: changed(case.links[entry.name].inertial, mass=0.0)},
                'if it weighed nothing, let alone as much as it is said to lift',
            ),
            'write its mass without the minus sign, or leave the <inertial> away',
            -entry.mass,
        )
        for entry in case.report.links
        if entry.mass < 0.0
    ]
    return told(hits, lambda count: f'{count} links have a negative mass')


def _moves_nothing(case):
    # Only where a chain ends: a body without mass in the middle of one is how joints with
    # several axes are written. Mimic joints count with the one that they follow. Of parts nobody
    # knows what is behind a joint, nor what a mass weighs that cannot be read.
    if not case.examination.is_whole:
        return []
    leaders: dict[str, list] = {}
    for joint in case.report.joints:
        leaders.setdefault(joint.mimics or joint.name, []).append(joint)
    empty = [
        name
        for name, followers in leaders.items()
        if all(
            case.body_mass[joint.name] + case.mass_behind[joint.name] <= 0.0 for joint in followers
        )
    ]
    if not empty:
        return []
    return [
        Finding(
            PROBLEM,
            'joint_moves_nothing',
            tuple(empty),
            f'{"joint" if len(empty) == 1 else f"{len(empty)} joints"} {names(empty)} '
            f'{"moves" if len(empty) == 1 else "move"} nothing that has a mass',
            'the row of D is zero there, so D is not positive definite: the node refuses to be '
            'enabled, and forward_dynamics has no answer',
            'add an <inertial> to the links behind it, or make it a fixed joint',
        )
    ]


def _shapes(case):
    massless = [
        entry
        for entry in case.moved
        if entry.has_shape
        and not entry.mass > 0.0
        and not entry.mass < 0.0
        and not math.isnan(entry.mass)
    ]
    mass = _ordinary_mass(case)
    hits = [
        Hit(
            _severity(case, entry),
            'shape_without_mass',
            entry.name,
            f"link '{entry.name}' has a shape but {_no_mass(entry)}: it weighs nothing",
            _no_mass(entry),
            _later(
                payload_effect,
                case,
                entry.name,
                mass,
                f'if it weighed {kilograms(mass)}, as the median link that moves',
            ),
            'add an <inertial> with its real mass; if the mass of the link that it is fixed '
            'to has it in already, all is well',
            case.body_mass[entry.carrier] == 0.0,
        )
        for entry in massless
    ]
    return told(hits, lambda count: f'{count} moving links have a shape but no mass')


def _severity(case, entry):
    # Seen, and either alone or at the end of a chain, where tools are: that is hardly meant.
    # Elsewhere somebody may have added its mass to that of the link before.
    alone = case.body_mass[entry.carrier] == 0.0
    at_end = not case.body_children[entry.carrier]
    return WARNING if case.links[entry.name].has_visual and (alone or at_end) else NOTE


def _ordinary_mass(case):
    masses = sorted(entry.mass for entry in case.moved_with_mass)
    return masses[len(masses) // 2] if masses else 1.0


def _no_mass(entry):
    return 'a mass of 0' if entry.has_inertial else 'no <inertial>'


def _grams(case):
    hits = []
    judges_moments = not _are_all_too_large(case)
    for entry in case.moved_with_mass:
        reason = _too_light(case, entry, judges_moments)
        if reason is None:
            continue
        sentence, short, neighbors = reason
        mass = 1000.0 * entry.mass
        right = f'if it weighed {kilograms(mass)}'
        if not _is_plausible(mass, neighbors) or mass > _LIKELY * max(neighbors):
            mass = _mean(neighbors)
            right = f'if it weighed as much as its neighbors, {kilograms(mass)}'
        effect = torque_effect(
            case, {entry.name: changed(case.links[entry.name].inertial, mass=mass)}, right
        )
        if effect.share < _MATTERS and not case.body_children[entry.carrier]:
            continue  # at the end of a chain, propellers and the like may be as light
        hits.append(
            Hit(
                WARNING,
                'grams',
                entry.name,
                sentence,
                short,
                effect,
                'URDF has kilograms: were grams written as kilograms, or is a digit lost? Weigh '
                f'it or ask the CAD program, and correct <mass value="{number(entry.mass)}"/>',
                max(neighbors) / entry.mass,
            )
        )
    return told(hits, lambda count: f'{count} links are far lighter than their neighbors')


def _mean(masses):
    # Fingers behind a hand do not tell what it weighs.
    heavy = [mass for mass in masses if mass >= _PLAUSIBLE[0] * max(masses)]
    return math.exp(sum(map(math.log, heavy)) / len(heavy))


def _is_plausible(mass, neighbors):
    return _PLAUSIBLE[0] * min(neighbors) <= mass <= _PLAUSIBLE[1] * max(neighbors)


def _are_all_too_large(case):
    # Then the unit of the moments is wrong, and not the mass of the lightest.
    heavy = [
        entry for entry in case.moved_with_mass if entry.mass > _LIGHT_LINK * case.moving_mass
    ]
    return 2 * sum(is_too_large(case, entry) for entry in heavy) > len(heavy)


def _too_light(case, entry, judges_moments):
    # A sentence, its numbers, and the masses of the neighbors, kg; None for a likely mass.
    body = case.body_mass[entry.carrier]
    parent = case.body_parent[entry.carrier]
    before = (
        case.body_mass[parent]
        if parent
        else sum(
            other.mass for other in case.report.links if other.carrier is None and other.mass > 0.0
        )
    )
    behind = [
        case.body_mass[child]
        for child in case.body_children[entry.carrier]
        if case.body_mass[child] > 0.0
    ]
    neighbors = [mass for mass in (before, *behind, body - entry.mass) if mass > 0.1 * entry.mass]
    if not neighbors:
        return None
    gyration = (
        math.sqrt(max(entry.principal_moments) / entry.mass)
        if (max(entry.principal_moments) > 0.0)
        else 0.0
    )
    reach = case.reach
    is_most_of_body = entry.mass >= 0.5 * body
    is_lighter = judges_moments and entry.mass < 0.1 * max(neighbors)
    if is_lighter and (
        (
            gyration > _GYRATION_OF_ALL * reach > 0.0
            and _is_plausible(1000.0 * entry.mass, neighbors)
        )
        or (
            is_most_of_body
            and gyration > _GYRATION * reach > 0.0
            and entry.mass < 0.1 * min(neighbors)
        )
        or (
            # Beside heavier ones on the same body: a tool, or what carries one.
            not is_most_of_body
            and entry.mass < _LIGHT
            and is_too_large(case, entry)
            and _is_plausible(1000.0 * entry.mass, neighbors)
            and not is_placeholder(case.links[entry.name].inertial.tensor)
        )
    ):
        return (
            f"link '{entry.name}' weighs {kilograms(entry.mass)}, but its moments of inertia "
            f'are those of a part of {number(gyration)} m radius (sqrt(I/m)) in a robot that '
            f'reaches {number(reach)} m; its neighbors weigh '
            f'{kilograms(max(neighbors))}',
            kilograms(entry.mass),
            neighbors,
        )
    if not is_most_of_body:
        return None
    load = case.mass_behind[entry.carrier]
    if (
        not behind
        and _LIGHTER_AT_END * body < before
        and entry.mass < _LIGHT_AT_END
        and _is_plausible(1000.0 * entry.mass, neighbors)
    ):
        return (
            f"link '{entry.name}' weighs {kilograms(entry.mass)}, "
            f'{factor(before / body)} less than what carries it',
            kilograms(entry.mass),
            neighbors,
        )
    if (
        entry.mass < _LIGHT
        and behind
        and before > 0.0
        and (entry.has_shape or not case.any_shapes)
        and _LIGHTER * body < min(before, max(behind))
        and load > _LIGHTER * body
    ):
        return (
            f"link '{entry.name}' weighs {kilograms(entry.mass)}, "
            f'{factor(min(before, max(behind)) / body)} less than what is before and behind '
            f'it, and carries {kilograms(load)}',
            kilograms(entry.mass),
            neighbors,
        )
    return None


def _later(function, *arguments):
    return lambda: function(*arguments)
