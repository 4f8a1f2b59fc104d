"""Effect of other inertial parameters on torques and inertia, computed for this robot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .context import FindingContext
from ..formatting import plain_number, plain_percent
from ...dynamics import RobotModel
from ...urdf import Inertial

# Relative change below which an effect counts as none.
NEGLIGIBLE = 1e-3


class Effect(NamedTuple):
    """
    The effect of a change.

    Attributes
    ----------
    text : str
        A sentence; '' if it is not known.
    share : float
        Relative change of the torque or inertia that changes most, without sign; NaN if it is
        not known.

    """

    text: str
    share: float


UNKNOWN = Effect('', math.nan)


def torque_effect(
    context: FindingContext, inertials: Mapping[str, Inertial | None], condition: str
) -> Effect:
    """
    Return the effect of other inertial parameters on the largest gravity torques.

    Parameters
    ----------
    context : FindingContext
    inertials : mapping of str to Inertial or None
        By link name.
    condition : str
        End of the sentence, 'if it weighed 7 kg'.

    Returns
    -------
    Effect
        On the joint whose torque changes most.

    """
    if context.analysis is None:
        return UNKNOWN
    model = context.analysis.with_inertials(inertials)
    return _torque_sentence(context, model, inertials, condition)


def payload_effect(context: FindingContext, link: str, mass: float, condition: str) -> Effect:
    """Return the effect of a point mass (kg) at the origin of a link's frame."""
    if context.analysis is None:
        return UNKNOWN
    model = context.analysis.model.with_payload(link, mass)
    return _torque_sentence(context, model, [link], condition)


def inertia_effect(
    context: FindingContext, link: str, inertial: Inertial, comparison: str
) -> Effect:
    """
    Return the difference of the joints' inertia from that with another tensor.

    Parameters
    ----------
    context : FindingContext
    link : str
    inertial : Inertial
        The plausible inertial parameters.
    comparison : str
        End of the sentence, 'with izz = 0.01'.

    Returns
    -------
    Effect
        On the joint whose diagonal entry of D changes most.

    """
    analysis = context.analysis
    joints = [] if analysis is None else analysis.supporting_joints(link)
    if analysis is None or not joints:
        return UNKNOWN
    before = context.sampled_inertia[:, joints]
    after = context.diagonal_of(analysis.with_inertials({link: inertial}))[:, joints]
    with np.errstate(all='ignore'):
        change = np.where(after > 0.0, before / after - 1.0, 0.0)
    share, column = largest(change)
    name = analysis.model.joint_names[joints[column]]
    if abs(share) < NEGLIGIBLE:
        return Effect(
            'next to nothing: the inertia that any joint feels changes by less than '
            f'{plain_percent(NEGLIGIBLE)} {comparison}, gravity torques not at all',
            abs(share),
        )
    amount = f'{plain_percent(abs(share))} {"more" if share > 0.0 else "less"}'
    return Effect(
        f"joint '{name}' seems to have up to {amount} inertia (D_jj) than {comparison}; gravity "
        'torques do not change',
        abs(share),
    )


def largest(values: NDArray[np.float64]) -> tuple[float, int]:
    """Return the entry of a matrix with the largest magnitude, and its column."""
    row, column = np.unravel_index(int(np.argmax(np.abs(values))), values.shape)
    return float(values[row, column]), int(column)


def changed(
    inertial: Inertial,
    mass: float | None = None,
    com: NDArray[np.float64] | None = None,
    tensor: NDArray[np.float64] | None = None,
) -> Inertial:
    """Return inertial parameters with another mass (kg), center of mass (m) or tensor (kg m²)."""
    placement = inertial.placement
    if com is not None:
        placement = placement.copy()
        placement[:3, 3] = com
    return replace(
        inertial,
        mass=inertial.mass if mass is None else mass,
        placement=placement,
        tensor=inertial.tensor if tensor is None else tensor,
    )


def added_torque(context: FindingContext, link: str, mass: float) -> tuple[str, float]:
    """
    Return the largest torque that a point mass at a link's frame adds, over all positions.

    Parameters
    ----------
    context : FindingContext
    link : str
        A link that some joint moves.
    mass : float
        kg.

    Returns
    -------
    joint : str
        The joint with the largest added torque; a prismatic one only if no other joint moves the
        link.
    torque : float
        N m, or N for a prismatic joint.

    """
    analysis = context.require_analysis()
    massless = analysis.with_inertials({entry.name: None for entry in context.moved})
    loaded = massless.with_payload(link, mass)
    names = analysis.model.joint_names
    torques = {
        names[joint]: abs(analysis.worst_with(loaded, joint)[1])
        for joint in analysis.supporting_joints(link)
    }
    rotating = {
        joint: torque for joint, torque in torques.items() if unit_of(context, joint) == 'N m'
    }
    candidates = rotating or torques
    joint = max(candidates, key=lambda name: candidates[name])
    return joint, candidates[joint]


def unit_of(context: FindingContext, joint: str) -> str:
    """Return the unit of a joint's efforts."""
    return 'N' if context.joints[joint].kind == 'prismatic' else 'N m'


def _torque_sentence(
    context: FindingContext, model: RobotModel, links: Iterable[str], condition: str
) -> Effect:
    analysis = context.require_analysis()
    joints = sorted({joint for link in links for joint in analysis.supporting_joints(link)})
    if not joints:
        return Effect('none: no joint moves it', 0.0)
    pairs = [
        (joint, abs(analysis.worst[joint][1]), abs(analysis.worst_with(model, joint)[1]))
        for joint in joints
    ]
    joint, before, after = max(pairs, key=lambda pair: abs(pair[2] - pair[1]))
    name = analysis.model.joint_names[joint]
    if abs(after - before) <= NEGLIGIBLE * max(before, after):
        return Effect(
            'next to nothing: no gravity torque changes by more than '
            f'{plain_percent(NEGLIGIBLE)} {condition}',
            0.0,
        )
    unit = unit_of(context, name)
    change = ''
    if before > 1e-9 * after:
        sign = '+' if after > before else '-'
        change = f' ({sign}{plain_percent(abs(after - before) / before)})'
    return Effect(
        f"the largest gravity torque of joint '{name}' would be {plain_number(after)} {unit} "
        f'instead of {plain_number(before)} {unit}{change} {condition}',
        abs(after - before) / max(before, analysis.rounding),
    )
