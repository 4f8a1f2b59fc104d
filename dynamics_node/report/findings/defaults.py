"""Inertial parameters that somebody has typed to fill a gap."""

import math

import numpy as np

from .effects import changed, inertia_effect, torque_effect
from .hit import Hit, told
from .kinds import NOTE, WARNING
from .words import names, number
from ..report import Finding

# What changes no torque or inertia by as much is not told; what changes less is a note.
_MATTERS, _WARNS = 0.01, 0.05
# Links lighter than this share of what moves do not matter here.
_LIGHT = 0.01
# A placeholder that is wrong by less than this, for a ball as large as the link, may stand.
_WRONG = 10.0
# A chain of so many equal links was copied.
_COPIES = 3
# Of so many of them it is computed what they do.
_COPIES_TRIED = 8
# A link balanced on its joint is told from this share of what moves, and this length, m.
_HEAVY, _LONG = 0.05, 0.1


def find_defaults(case):
    """Return inertial parameters that look like no real ones."""
    entries = [entry for entry in case.moved_with_mass if entry.mass > _LIGHT * case.moving_mass]
    hits, balanced = [], []
    for entry in entries:
        inertial = case.links[entry.name].inertial
        if is_placeholder(inertial.tensor):
            hits.append(_placeholder(case, entry, inertial))
        if _is_balanced(case, entry, inertial):
            balanced.append(_balanced(case, entry, inertial))
    hits = [hit for hit in hits if not hit.effect.share < _MATTERS]
    balanced = [hit for hit in balanced if not hit.effect.share < _MATTERS]
    return [
        *_copies(case),
        *_unit_masses(case, entries),
        *told(hits, lambda count: f'{count} links have a tensor that looks typed by hand'),
        *told(
            balanced,
            lambda count: f'{count} heavy links have their center of mass exactly on their joint',
        ),
    ]


def is_placeholder(tensor):
    """
    Judge an inertia tensor.

    Parameters
    ----------
    tensor : numpy.ndarray, shape (3, 3)
        kg m².

    Returns
    -------
    bool
        Whether it is c times identity with c = 1, 0.1, 1e-3..., or nothing at all.

    """
    value = tensor[0, 0]
    if np.any(tensor != value * np.eye(3)):
        return False
    if value <= 0.0:
        return bool(value == 0.0)
    power = math.log10(value)
    return abs(power - round(power)) < 1e-9


def _placeholder(case, entry, inertial):
    value = float(inertial.tensor[0, 0])
    size = max(case.size(entry.name), 0.02)
    moment = 0.4 * entry.mass * (0.5 * size) ** 2
    is_far = not moment / _WRONG < value < moment * _WRONG
    has_unit_mass = entry.mass == 1.0
    said = 'no inertia' if value == 0.0 else f'ixx = iyy = izz = {value:g}'
    mass = ' and a mass of exactly 1 kg' if has_unit_mass else ''
    at = f' at {number(entry.mass)} kg'
    return Hit(
        WARNING if value > 0.0 and (is_far or has_unit_mass) else NOTE,
        'placeholder_tensor',
        entry.name,
        f"link '{entry.name}' has {said}{mass or at}: it looks typed by hand",
        said + mass,
        inertia_effect(
            case,
            entry.name,
            changed(inertial, tensor=moment * np.eye(3)),
            f'as a ball of {number(size)} m',
        ),
        'take mass, center of mass and tensor from the CAD program, or compute them from the '
        'shape',
        abs(math.log(max(value, 1e-12) / moment)),
    )


def _unit_masses(case, entries):
    exact = [entry for entry in entries if entry.mass == 1.0]
    if len(exact) < 2:
        return []
    typed = [entry for entry in exact if is_placeholder(case.links[entry.name].inertial.tensor)]
    inertials = {entry.name: changed(case.links[entry.name].inertial, mass=2.0) for entry in exact}
    return [
        Finding(
            WARNING if typed else NOTE,
            'placeholder_mass',
            tuple(entry.name for entry in exact),
            f'{len(exact)} moving links have a mass of exactly 1 kg: '
            f'{names(entry.name for entry in exact)}',
            torque_effect(case, inertials, 'if each of them weighed 2 kg').text,
            'check that somebody has weighed them, or asked the CAD program',
        )
    ]


def _copies(case):
    # Equal links side by side are fingers, legs and wheels; one behind the other they are copied.
    keys: dict[tuple, list] = {}
    for entry in case.moved_with_mass:
        inertial = case.links[entry.name].inertial
        key = (inertial.mass, *inertial.placement.ravel(), *inertial.tensor.ravel())
        keys.setdefault(key, []).append(entry)
    found = []
    for entries in keys.values():
        chain = _in_one_chain(case, entries) if len(entries) >= _COPIES else []
        if len(chain) < _COPIES or sum(entry.mass for entry in chain) < _LIGHT * case.moving_mass:
            continue
        lengths = {round(case.size_without_com(entry.name), 6) for entry in chain}
        if len(lengths) == 1 and not is_placeholder(case.links[chain[0].name].inertial.tensor):
            continue  # equal parts of equal length: a chain of modules
        # The first one may turn about the vertical: the weightiest of all is told.
        effect = max(
            (
                torque_effect(
                    case,
                    {entry.name: changed(case.links[entry.name].inertial, mass=2.0 * entry.mass)},
                    f"if '{entry.name}' weighed twice as much",
                )
                for entry in chain[:_COPIES_TRIED]
            ),
            key=lambda effect: np.nan_to_num(effect.share),
        )
        found.append(
            Finding(
                NOTE if effect.share < _WARNS else WARNING,
                'identical_inertials',
                tuple(entry.name for entry in chain),
                f'{len(chain)} links of one chain have the same <inertial> to the last digit '
                f'({number(chain[0].mass)} kg): {names(entry.name for entry in chain)}',
                effect.text,
                'give each link its own <inertial>, unless they are equal parts indeed',
            )
        )
    return found


def _in_one_chain(case, entries):
    # The largest group of entries whose bodies lie on one way to the base.
    best: list = []
    for entry in entries:
        way, joint = set(), entry.carrier
        while joint is not None and joint not in way:
            way.add(joint)
            joint = case.body_parent.get(joint)
        # One of each body: what fixed joints put side by side is no chain.
        chain = list({other.carrier: other for other in entries if other.carrier in way}.values())
        if len(chain) > len(best):
            best = chain
    return best


def _is_balanced(case, entry, inertial):
    return (
        not inertial.placement[:3, 3].any()
        and entry.mass > _HEAVY * case.moving_mass
        and max([0.0, *case.joints_at[entry.name]]) > _LONG
    )


def _balanced(case, entry, inertial):
    joint = max(
        (joint for joint in case.description.joints if joint.parent == entry.name),
        key=lambda joint: float(np.linalg.norm(joint.placement[:3, 3])),
    )
    half = 0.5 * joint.placement[:3, 3]
    return Hit(
        NOTE,
        'com_at_joint',
        entry.name,
        f"link '{entry.name}' of {number(entry.mass)} kg has its center of mass exactly at its "
        f'frame, though it goes {number(2.0 * float(np.linalg.norm(half)))} m to joint '
        f"'{joint.name}'",
        f'{number(entry.mass)} kg',
        torque_effect(
            case,
            {entry.name: changed(inertial, com=half)},
            f"if it were halfway to joint '{joint.name}'",
        ),
        'check that <inertial><origin xyz> is not just missing',
        entry.mass,
    )
