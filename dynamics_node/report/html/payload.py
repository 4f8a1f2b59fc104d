"""What the arm can carry, and how well its motion is conditioned."""

import math

from .escape import span, text
from ..formatting import count, number, position, quantity, vector


def payload_section(report):
    """
    Return the section on the payload.

    Parameters
    ----------
    report : Report
        With a `payload`.

    Returns
    -------
    str
        Markup.

    """
    payload = report.payload
    guess = (
        ' (a guess, the end of the heaviest chain before its fingers; '
        '<code>--payload-link</code> chooses another)'
        if payload.is_guessed
        else ''
    )
    facts = [
        ('carried by', span(payload.link) + guess),
        ('at the point', f'{text(vector(payload.point))} m, in the frame of the link'),
    ]
    if not report.moving_mass > 0.0:
        facts.append(('at every pose', 'not known, for nothing that moves has a mass'))
    elif not payload.is_moved:
        facts.append(('at every pose', 'no joint moves this link'))
    else:
        facts += [
            ('at every pose', _held(payload.everywhere, payload.limiting_joint)),
            ('at the best pose', _held(payload.best, payload.best_joint)),
        ]
        if payload.limiting_position is not None:
            facts.append(('the worst pose', _pose(report, payload.limiting_position)))
        if payload.best_joint is not None:
            facts.append(('the best pose', _pose(report, payload.best_position)))
    if payload.unlimited_joints:
        names = ', '.join(span(joint) for joint in payload.unlimited_joints)
        facts.append(('not counted', f'without an effort limit: {names}'))
    return _section(
        'payload',
        'Payload',
        'The point mass that can be held at rest within the effort limits.',
        facts,
    )


def conditioning_section(report):
    """
    Return the section on the conditioning of D.

    Parameters
    ----------
    report : Report
        With a `conditioning`.

    Returns
    -------
    str
        Markup.

    """
    D = report.conditioning
    facts = [
        ('median', number(D.median, 3)),
        ('worst', number(D.worst, 3)),
        ('the worst pose', _pose(report, D.position)),
        ('moves the least', span(D.weakest_joint)),
        (
            'positive definite',
            f'at all of {count(D.samples, "pose")}'
            if D.is_positive_definite
            else '<span class="bad">not at every pose</span>',
        ),
    ]
    if D.has_mixed_units:
        facts.append(
            ('mind', 'some joints turn and some slide: the numbers depend on the units, rad and m')
        )
    return _section(
        'conditioning',
        'Conditioning of D',
        'The largest over the smallest '
        'eigenvalue of the mass matrix. Beyond some thousand, a joint with little '
        'inertia needs finer control than the rest.',
        facts,
    )


def _held(mass, joint):
    if math.isinf(mass):
        return 'no effort limit is in the way'
    by = '' if joint is None else f', limited by {span(joint)}'
    return f'<b>{quantity(mass, "kg", 3)}</b>{by}'


def _pose(report, values):
    slides = {joint.name: joint.kind == 'prismatic' for joint in report.joints}
    lines = ', '.join(
        f'{span(name)} {position(value, slides[name])}'
        for name, value in zip(report.joint_names, values, strict=True)
    )
    return f'<details><summary>{count(len(values), "joint")}</summary>{lines}</details>'


def _section(identifier, title, lead, facts):
    lines = ''.join(f'<dt>{label}</dt><dd>{content}</dd>' for label, content in facts)
    return (
        f'<section id="{identifier}"><h2>{title}</h2><p class="quiet">{lead}</p>'
        f'<dl class="facts">{lines}</dl></section>'
    )
