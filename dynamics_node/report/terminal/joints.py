"""Tables of joints, gravity torques and what is left for a payload."""

import math

from rich.text import Text

from .links import table
from .numbers import short, vector

# From this width on, and up to so many joints, the worst position is shown.
_WIDE, _FEW = 110, 9


def joint_table(report):
    """Return kinds and limits of the joints."""
    made = table(
        ('joint', 'left'),
        ('kind', 'left'),
        ('from', 'right'),
        ('to', 'right'),
        ('velocity', 'right'),
        ('effort', 'right'),
        ('damping', 'right'),
        ('friction', 'right'),
    )
    for joint in report.joints:
        made.add_row(
            Text(joint.name),
            joint.kind,
            short(joint.lower),
            short(joint.upper),
            short(joint.velocity),
            short(joint.effort),
            short(joint.damping),
            short(joint.friction),
        )
    return made


def mimic_line(report):
    """Return a line about the joints that mimic others, or None."""
    said = [
        f'{joint.name} = {joint.multiplier:g} {joint.mimics}'
        + (f' + {joint.offset:g}' if joint.offset else '')
        for joint in report.joints
        if joint.mimics is not None
    ]
    return Text(f'mimic joints: {", ".join(said)}', style='dim') if said else None


def gravity_table(report, width):
    """Return the largest gravity torques beside the limits."""
    shows_position = width >= _WIDE and len(report.joint_names) <= _FEW
    made = table(
        ('joint', 'left'),
        ('largest', 'right'),
        ('', 'left'),
        ('median', 'right'),
        ('limit', 'right'),
        ('share', 'right'),
        ('kg left', 'right'),
        *([('at', 'left')] if shows_position else []),
    )
    for joint in report.joints:
        load = joint.gravity
        if load is None:
            continue
        share = '-' if math.isnan(load.share) else f'{100.0 * load.share:.0f} %'
        middle = load.quantiles[load.levels.index(0.5)]
        made.add_row(
            Text(joint.name),
            short(load.worst),
            joint.effort_unit,
            short(middle),
            short(joint.effort),
            Text(share, style=_share_style(load.share)),
            short(load.payload_left),
            *([_place(load)] if shows_position else []),
        )
    return made


def payload_lines(report):
    """Return lines about the payload and the conditioning of D."""
    payload, found = report.payload, report.conditioning
    place = f"'{payload.link}'"
    if any(payload.point):
        place += f' at ({", ".join(f"{value:g}" for value in payload.point)}) m'
    yield Text(
        f'\n"kg left": a point mass at {place}, in that position, until that joint is at '
        'its limit',
        style='dim',
    )
    if payload.is_guessed:
        yield Text(
            f'{place} is a guess, the end of the heaviest chain before its fingers; '
            '--payload-link LINK chooses another',
            style='dim',
        )
    if report.moving_mass > 0.0:
        yield _carries(payload, place)
    else:
        yield Text('What it can hold is not known, for nothing that moves has a mass')
    if payload.unlimited_joints:
        yield Text(
            f'not counted, for they have no effort limit: {", ".join(payload.unlimited_joints)}',
            style='yellow',
        )
    mixed = (
        '; joints slide and turn, so it depends on the units, m and rad'
        if (found.has_mixed_units)
        else ''
    )
    worst = short(found.worst) if found.is_positive_definite else 'none, it is singular'
    yield Text(
        f'Condition number of the mass matrix: median {short(found.median)}, worst '
        f"{worst} ('{found.weakest_joint}' feels least inertia there; {found.samples} "
        f'positions){mixed}'
    )


def _carries(payload, place):
    if not payload.is_moved:
        return Text(f'No joint moves {place}: it carries anything')
    if payload.limiting_joint is None:
        return Text(f'No effort limit is in the way of a payload at {place}')
    text = Text('It can hold ')
    text.append(f'{short(payload.everywhere)} kg', style='bold')
    text.append(f" at {place} everywhere ('{payload.limiting_joint}' allows no more)")
    if math.isfinite(payload.best):
        text.append(f', {short(payload.best)} kg at the best of the sampled positions')
    return text


def _place(load):
    return '' if load.worst == 0.0 else vector(load.position, 2)


def _share_style(share):
    if math.isnan(share):
        return ''
    return 'bold red' if share > 1.0 else 'yellow' if share > 0.8 else 'green'
