"""The first screen of the page: the robot, the verdict and the numbers that matter most."""

import math

from .escape import text
from .findings import headline
from .plot_worst import tone
from ..formatting import count, number, percent, quantity


def summary(report):
    """
    Return the head of the page.

    Parameters
    ----------
    report : Report

    Returns
    -------
    str
        Markup.

    """
    verdict, kind = _verdict(report)
    return (
        f'<header><div><div class="kicker">Model report</div><div class="titleline">'
        f'<h1>{text(report.robot or "robot without a name")}</h1>'
        f'<span class="badge {kind}">{verdict}</span></div>'
        f'<p class="lead">{_lead(report)}</p>'
        f'<div class="tiles">{"".join(_tiles(report))}</div></div></header>'
    )


def _verdict(report):
    """Return the words of the badge and its colour."""
    if report.verdict == 'refused':
        return 'refused', 'problem'
    worst = next((severity for severity, amount in report.counts.items() if amount), 'good')
    if worst == 'problem':
        return f'not to be trusted: {count(report.counts[worst], worst)}', worst
    if worst == 'warning':
        return f'usable, with {count(report.counts[worst], worst)}', worst
    return 'usable', 'good'


def _lead(report):
    followers = sum(joint.mimics is not None for joint in report.joints)
    joints = count(len(report.joints) - followers, 'joint')
    if followers:
        joints += f' and {followers} that {"follow" if followers > 1 else "follows"} them'
    found = headline(report)
    return (
        f'{joints}, {count(len(report.links), "link")}; {found}. '
        f'Read from <code>{text(report.source)}</code>.'
    )


def _tiles(report):
    yield _tile(
        'mass',
        number(report.total_mass),
        'kg',
        f'{quantity(report.moving_mass, "kg")} of it moves'
        if report.verdict != 'refused'
        else 'of the links that could be read',
    )
    loads = [joint for joint in report.joints if joint.gravity is not None]
    limited = [joint for joint in loads if math.isfinite(joint.gravity.share)]
    if limited:
        worst = max(limited, key=lambda joint: joint.gravity.share)
        yield _tile(
            'largest share of an effort limit',
            percent(worst.gravity.share),
            '',
            f'{worst.name}: {number(worst.gravity.magnitude, 3)} of '
            f'{quantity(worst.effort, worst.effort_unit)} for gravity',
            tone(worst.gravity.share),
        )
    elif loads:
        worst = max(loads, key=lambda joint: joint.gravity.magnitude)
        yield _tile(
            'worst gravity torque',
            number(worst.gravity.magnitude, 3),
            worst.effort_unit,
            f'{worst.name}; no joint has an effort limit',
        )
    if report.payload is not None:
        yield _payload_tile(report.payload, report.moving_mass)
    if report.conditioning is not None:
        D = report.conditioning
        yield _tile(
            'condition number of D, median',
            number(D.median, 3),
            '',
            f'worst {number(D.worst, 3)}'
            + ('' if D.is_positive_definite else '; not positive definite'),
            '' if D.is_positive_definite else 'problem',
        )
    problems = report.counts['problem'] + report.counts['warning']
    yield _tile(
        'findings',
        str(len(report.findings)),
        '',
        headline(report),
        'problem' if report.counts['problem'] else 'warning' if problems else '',
    )


def _payload_tile(payload, moving_mass):
    if not moving_mass > 0.0:
        return _tile('payload at every pose', '–', '', 'not known: nothing that moves has a mass')
    if not payload.is_moved:
        return _tile('payload at every pose', '–', '', f'no joint moves {payload.link}')
    if math.isinf(payload.everywhere):
        return _tile('payload at every pose', '–', '', 'no effort limit is in the way')
    return _tile(
        'payload at every pose',
        number(payload.everywhere, 3),
        'kg',
        f'at {payload.link}; {payload.limiting_joint} allows no more',
        'problem' if payload.everywhere <= 0.0 else '',
    )


def _tile(label, value, unit, detail, tone_of_value=''):
    tone_of_value = tone_of_value if tone_of_value in ('problem', 'warning') else ''
    unit = f' <span class="unit">{text(unit)}</span>' if unit else ''
    return (
        f'<div class="tile"><div class="label">{text(label)}</div>'
        f'<div class="value {tone_of_value}">{text(value)}{unit}</div>'
        f'<div class="detail">{text(detail)}</div></div>'
    )
