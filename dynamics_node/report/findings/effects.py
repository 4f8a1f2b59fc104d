"""What another inertia would do to the torques, computed and said in a sentence."""

from dataclasses import replace
import math
from typing import NamedTuple

import numpy as np

from .words import number, percent

# Below this share nothing is said to change.
NOTHING = 1e-3


class Effect(NamedTuple):
    """
    What a change would do.

    Attributes
    ----------
    text : str
    share : float
        Of the torque or inertia that changes most, without sign; NaN if it is not known.

    """

    text: str
    share: float


UNKNOWN = Effect('', math.nan)


def torque_effect(case, inertials, if_what):
    """
    Say what other inertial parameters would do to the largest gravity torques.

    Parameters
    ----------
    case : Case
    inertials : dict of str to Inertial or None
        By link.
    if_what : str
        'if it weighed 7 kg'.

    Returns
    -------
    Effect
        On the joint whose torque changes most.

    """
    if case.study is None:
        return UNKNOWN
    return _torque_sentence(case, case.study.with_inertials(inertials), inertials, if_what)


def payload_effect(case, link, mass, if_what):
    """Say the same for a point mass at the origin of a link's frame."""
    if case.study is None:
        return UNKNOWN
    model = case.study.model.with_payload(link, mass)
    return _torque_sentence(case, model, [link], if_what)


def inertia_effect(case, link, inertial, with_what):
    """
    Say how much more or less inertia joints feel than with another tensor.

    Parameters
    ----------
    case : Case
    link : str
    inertial : Inertial
        What would be right.
    with_what : str
        'with izz = 0.01'.

    Returns
    -------
    Effect

    """
    joints = [] if case.study is None else case.study.joints_under(link)
    if not joints:
        return UNKNOWN
    before = case.sampled_inertia[:, joints]
    after = case.diagonal_of(case.study.with_inertials({link: inertial}))[:, joints]
    with np.errstate(all='ignore'):
        change = np.where(after > 0.0, before / after - 1.0, 0.0)
    place = np.unravel_index(int(np.argmax(np.abs(change))), change.shape)
    share, name = float(change[place]), case.study.model.joint_names[joints[place[1]]]
    if abs(share) < NOTHING:
        return Effect(
            'next to nothing: the inertia that any joint feels changes by less than '
            f'{percent(NOTHING)} {with_what}, gravity torques not at all',
            abs(share),
        )
    way = f'up to {percent(share)} more' if share > 0.0 else f'up to {percent(-share)} less'
    return Effect(
        f"joint '{name}' seems to have {way} inertia (D_jj) than {with_what}; gravity "
        'torques do not change',
        abs(share),
    )


def changed(inertial, **values):
    """Return inertial parameters with other `mass`, `tensor` or `com`."""
    if 'com' in values:
        placement = inertial.placement.copy()
        placement[:3, 3] = values.pop('com')
        values['placement'] = placement
    return replace(inertial, **values)


def added_torque(case, link, mass):
    """
    Return what a point mass at a link's frame adds at most to a joint, over all positions.

    Parameters
    ----------
    case : Case
    link : str
        That some joint moves.
    mass : float
        kg.

    Returns
    -------
    joint : str
        That gets most of it.
    torque : float
        N m, or N where the joint slides.

    """
    study = case.study
    bare = study.with_inertials({entry.name: None for entry in case.moved})
    loaded = bare.with_payload(link, mass)
    torques = {
        joint: abs(study.worst_with(loaded, joint)[1]) for joint in study.joints_under(link)
    }
    turning = {
        joint: torque
        for joint, torque in torques.items()
        if unit_of(case, study.model.joint_names[joint]) == 'N m'
    }
    chosen = turning or torques
    joint = max(chosen, key=lambda key: chosen[key])
    return study.model.joint_names[joint], chosen[joint]


def unit_of(case, joint):
    """Return the unit of a joint's efforts."""
    return 'N' if case.joints[joint].kind == 'prismatic' else 'N m'


def _torque_sentence(case, model, links, if_what):
    study = case.study
    joints = sorted({joint for link in links for joint in study.joints_under(link)})
    if not joints:
        return Effect('none: no joint moves it', 0.0)
    pairs = [
        (joint, abs(study.worst[joint][1]), abs(study.worst_with(model, joint)[1]))
        for joint in joints
    ]
    joint, before, after = max(pairs, key=lambda pair: abs(pair[2] - pair[1]))
    name = study.model.joint_names[joint]
    if abs(after - before) <= NOTHING * max(before, after):
        return Effect(
            'next to nothing: no gravity torque changes by more than '
            f'{percent(NOTHING)} {if_what}',
            0.0,
        )
    unit = unit_of(case, name)
    more = (
        ''
        if before <= 1e-9 * after
        else f' ({"+" if after > before else "-"}{percent(abs(after - before) / before)})'
    )
    return Effect(
        f"the largest gravity torque of joint '{name}' would be {number(after)} {unit} "
        f'instead of {number(before)} {unit}{more} {if_what}',
        abs(after - before) / max(before, study.rounding),
    )
