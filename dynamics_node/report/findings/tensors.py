"""Inertia tensors of no real body, or of another one."""

import math

import numpy as np

from .effects import changed, Effect, inertia_effect, NOTHING, UNKNOWN
from .hit import Hit, told
from .kinds import NOTE, PROBLEM, WARNING
from .words import number, percent
from ...inertia import steiner
from ...inertia.consistency import rounding_of
from ...urdf.inertial import link_pseudo_inertia

# Moments that violate the triangle inequality by less than this are rounding of a real body's.
_ROUNDED = 1.02
# Two principal moments are nothing beside the third.
_FLAT = 1e6
# A tensor that may be right is told if it changes as much of an inertia; of a warning, more.
_MATTERS, _WARNS = 0.01, 0.05
_NAMES = ('ixx', 'iyy', 'izz')
_FACTORS = (10.0, 100.0, 1000.0)
# Radius of gyration in units of how far the link goes, and as a share of the robot's reach.
_LARGE, _OF_REACH = 3.0, 0.2
# Moments of links lighter than this share of what moves are nobody's concern.
_LIGHT = 2e-3
# A tensor is about the frame if Steiner's part explains so much of its products of inertia, and
# they are not small themselves.
_EXPLAINED, _SMALL_PRODUCTS = 0.1, 0.02
_NOTHING = Effect('none: it stands on the base, where no joint feels it', 0.0)


def find_tensors(case):
    """Return what is wrong with inertia tensors."""
    impossible, triangle, large, shifted = [], [], [], []
    for entry in case.report.links:
        inertial = case.links[entry.name].inertial
        if inertial is None or not entry.mass >= 0.0:
            continue
        principal = np.array(entry.principal_moments)
        tolerance = rounding_of(link_pseudo_inertia(inertial))
        if principal[0] < -tolerance:
            impossible.append(_impossible(case, entry, principal, inertial))
        elif principal[2] - principal[1] - principal[0] > tolerance:
            triangle.append(_triangle(case, entry, principal, inertial))
        elif entry.carrier is not None and entry.mass > _LIGHT * case.moving_mass:
            if is_too_large(case, entry):
                large.append(_too_large(case, entry, principal, inertial))
            elif _is_about_frame(inertial):
                shifted.append(_about_frame(case, entry, inertial))
    large += _with_the_same(case, {hit.subject for hit in large})
    large = [hit for hit in large if not hit.effect.share < _MATTERS]
    shifted = [hit for hit in shifted if not hit.effect.share < _MATTERS]
    return [
        *told(
            impossible, lambda count: f'{count} links have a tensor that is not positive definite'
        ),
        *told(
            triangle,
            lambda count: (
                f'{count} links have principal moments that no real body '
                'has (one is larger than the sum of the two others)'
            ),
        ),
        *told(
            large,
            lambda count: (
                f'{count} links have moments of inertia far too large for their mass and size'
            ),
        ),
        *told(
            shifted,
            lambda count: (
                f'{count} links have a tensor that seems to be about the '
                'link frame, not about the center of mass'
            ),
        ),
    ]


def _with_the_same(case, names):
    # A larger link whose mass and tensor are those of one that is too small for them.
    alike = {_key(case.links[name].inertial) for name in names}
    return [
        _too_large(case, entry, np.array(entry.principal_moments), case.links[entry.name].inertial)
        for entry in case.moved_with_mass
        if entry.name not in names and _key(case.links[entry.name].inertial) in alike
    ]


def _key(inertial):
    return inertial.mass, *inertial.tensor.ravel().tolist()


def _impossible(case, entry, principal, inertial):
    mended = changed(inertial, tensor=_positive(inertial.tensor))
    severity, effect = PROBLEM, UNKNOWN
    if case.study is not None:
        effect = _later(_mended_effect, case, entry.name, mended)
    if entry.carrier is None and case.examination.is_whole:
        severity, effect = NOTE, _NOTHING
    return Hit(
        severity,
        'impossible_inertia',
        entry.name,
        f"link '{entry.name}': no real body has its inertia: the smallest principal moment is "
        f'{number(principal[0])} kg m^2, must be >= 0',
        f'{number(principal[0])} kg m^2',
        effect,
        'the signs of ixy, ixz, iyz or a diagonal entry are wrong, or one product of inertia is '
        'too large: copy the tensor anew from the CAD program, about the center of mass',
        -float(principal[0]),
    )


def _triangle(case, entry, principal, inertial):
    excess = float(principal[2] / max(principal[0] + principal[1], 1e-300))
    severity = PROBLEM if excess > _ROUNDED else NOTE
    # What is rounding beside the largest moment is shown as nothing.
    least, middle = (
        0.0 if abs(moment) < principal[2] / _FLAT else float(moment) for moment in principal[:2]
    )
    short = _excess(excess) if excess < _FLAT else 'two moments of 0'
    what = (
        f"link '{entry.name}': no real body has its inertia: the largest principal moment, "
        f'{number(principal[2])} kg m^2, is {_excess(excess)} the sum of the two others, '
        f'{number(least)} + {number(middle)}'
    )
    if excess > _FLAT:
        what = (
            f"link '{entry.name}': no real body has its inertia: one principal moment is "
            f'{number(principal[2])} kg m^2, the two others are {number(least)} and '
            f'{number(middle)}'
        )
    if severity == NOTE:
        advice = 'rounding, most likely: write the tensor with more digits'
        mended, with_what = _cut(inertial), 'with the largest moment cut to that sum'
    else:
        mended, with_what, advice = _proposal(inertial)
    if entry.carrier is None and case.examination.is_whole:
        severity, effect = NOTE, _NOTHING
    else:
        effect = inertia_effect(case, entry.name, mended, with_what)
        if effect.share < NOTHING:
            severity = NOTE
    return Hit(
        severity,
        'triangle_inequality',
        entry.name,
        what,
        short,
        effect,
        advice,
        min(excess, _FLAT),
    )


def _excess(ratio):
    # 1.0004 times, and not 1 times.
    if ratio < _ROUNDED:
        return f'{percent(ratio - 1.0)} more than'
    return f'{number(ratio)} times'


def _proposal(inertial):
    # A lost or misplaced decimal point: one entry of the diagonal that is 10, 100 or 1000 times
    # too large, or else too small.
    tensor = inertial.tensor
    order = np.argsort(-np.diagonal(tensor))
    for i, ways in ((order[0], (1.0,)), *((j, (-1.0,)) for j in order[:0:-1])):
        for factor in _FACTORS:
            for way in ways:
                trial = tensor.copy()
                trial[i, i] = tensor[i, i] * factor**-way
                moments = np.linalg.eigvalsh(trial)
                if moments[0] > 0.0 and moments[2] <= moments[0] + moments[1]:
                    name, size = _NAMES[i], 'large' if way > 0.0 else 'small'
                    entry = f'{name}="{trial[i, i]:.6g}"'
                    return (
                        changed(inertial, tensor=trial),
                        f'with {entry}',
                        f'a decimal point may be missing: {name}="{tensor[i, i]:.6g}" is '
                        f'{factor:g} times too {size}, {entry} belongs to a real body; look '
                        'into the CAD program',
                    )
    return (
        _cut(inertial),
        'with the largest moment cut to that sum',
        'copy the tensor anew from the CAD program: about the center of mass, in kg m^2, '
        'ixy, ixz, iyz with their signs',
    )


def _cut(inertial):
    moments, axes = np.linalg.eigh(inertial.tensor)
    moments[2] = min(moments[2], moments[0] + moments[1])
    return changed(inertial, tensor=axes @ np.diag(moments) @ axes.T)


def _positive(tensor):
    moments, axes = np.linalg.eigh(tensor)
    return axes @ np.diag(np.abs(moments)) @ axes.T


def mended_inertial(inertial):
    """
    Return inertial parameters with which torques can be computed, for effects to be told.

    Parameters
    ----------
    inertial : Inertial

    Returns
    -------
    Inertial
        Mass and principal moments without their signs; the same object if they have none.

    """
    moments = np.linalg.eigvalsh(inertial.tensor)
    if inertial.mass >= 0.0 and moments[0] >= 0.0:
        return inertial
    return changed(inertial, mass=abs(inertial.mass), tensor=_positive(inertial.tensor))


def _mended_effect(case, link, mended):
    joints = case.study.joints_under(link)
    if not joints:
        return UNKNOWN
    model = case.study.with_inertials({link: changed(mended, tensor=np.zeros((3, 3)))})
    share = np.nan_to_num(
        1.0 - case.diagonal_of(model)[:, joints] / case.sampled_inertia[:, joints]
    )
    place = np.unravel_index(int(np.argmax(share)), share.shape)
    name = case.study.model.joint_names[joints[place[1]]]
    return Effect(
        f'the tensor is up to {percent(float(share[place]))} of the inertia (D_jj) that joint '
        f"'{name}' feels, if its signs are made positive; as it stands RobotModel and the node "
        'refuse the robot',
        float(share[place]),
    )


def is_too_large(case, entry):
    """
    Judge the moments of inertia of a link with mass.

    Parameters
    ----------
    case : Case
    entry : LinkEntry

    Returns
    -------
    bool
        Whether its mass would have to be far outside the link.

    """
    gyration = math.sqrt(max(0.0, entry.principal_moments[2]) / entry.mass)
    return gyration > _LARGE * case.size(entry.name) and gyration > _OF_REACH * case.reach > 0.0


def _too_large(case, entry, principal, inertial):
    gyration = math.sqrt(principal[2] / entry.mass)
    size = max(case.size(entry.name), 0.05)
    ball = changed(inertial, tensor=0.4 * entry.mass * size**2 * np.eye(3))
    return Hit(
        WARNING,
        'inertia_too_large',
        entry.name,
        f"link '{entry.name}' has {number(principal[2])} kg m^2 at {number(entry.mass)} kg, as if "
        f'its mass were {number(gyration)} m from its center; as far as joints and center of mass '
        f'tell it goes {number(case.size(entry.name))} m',
        f'as if its mass were {number(gyration)} m from its center, in a link of '
        f'{number(case.size(entry.name))} m',
        inertia_effect(case, entry.name, ball, f'as a ball of {number(size)} m radius'),
        'URDF has kg m^2: g mm^2 are 1e-9 and kg mm^2 are 1e-6 of it, lb in^2 2.93e-4; look for '
        'a missing decimal point too',
        gyration / size,
    )


def _is_about_frame(inertial):
    com = inertial.placement[:3, 3]
    if not com.any() or not inertial.mass > 0.0:
        return False
    tensor = _in_link(inertial)
    without = tensor - steiner(np.zeros((3, 3)), inertial.mass, com)
    moments = np.linalg.eigvalsh(without)
    if not moments[0] > 0.0 or moments[2] > moments[0] + moments[1]:
        return False
    products = _products(tensor)
    return bool(
        products > _SMALL_PRODUCTS * np.trace(tensor)
        and _products(without) < _EXPLAINED * products
    )


def _about_frame(case, entry, inertial):
    com = inertial.placement[:3, 3]
    rotation = inertial.placement[:3, :3]
    without = _in_link(inertial) - steiner(np.zeros((3, 3)), inertial.mass, com)
    before, after = _products(_in_link(inertial)), _products(without)
    effect = inertia_effect(
        case,
        entry.name,
        changed(inertial, tensor=rotation.T @ without @ rotation),
        'with the tensor moved to the center of mass',
    )
    return Hit(
        NOTE if effect.share < _WARNS else WARNING,
        'tensor_not_about_com',
        entry.name,
        f"link '{entry.name}': its tensor seems to be about the link frame: moved to the center "
        f'of mass (Steiner), its products of inertia go from {number(before)} to '
        f'{number(after)} kg m^2',
        f'{number(before)} to {number(after)} kg m^2',
        effect,
        'URDF wants the tensor about the center of mass, in the axes of <origin rpy>: take that '
        'one from the CAD program',
        before,
    )


def _in_link(inertial):
    rotation = inertial.placement[:3, :3]
    return rotation @ inertial.tensor @ rotation.T


def _products(tensor):
    return float(np.linalg.norm([tensor[0, 1], tensor[0, 2], tensor[1, 2]]))


def _later(function, *arguments):
    return lambda: function(*arguments)
