"""The table of joints: what holds them, and what gravity asks of them at most."""

import math

from .escape import span, text
from .plot_worst import tone
from .table import amount, Cell, Column, name, table, words
from ..formatting import number, percent, position

_TONES = {'problem': 'bad', 'warning': 'doubt', 'accent': '', 'faint': 'missing'}


def joints_table(joints, names):
    """
    Return the table of all movable joints.

    Parameters
    ----------
    joints : sequence of JointEntry
    names : sequence of str
        The independent joints, in the order of every position.

    Returns
    -------
    str
        Markup.

    """
    unit = ' or '.join(sorted({joint.effort_unit for joint in joints}, reverse=True))
    columns = (
        Column('joint'),
        Column('kind'),
        Column('range'),
        Column('worst gravity torque', unit, True),
        Column('effort limit', unit, True),
        Column('share of the limit', '', True),
        Column('payload left there', 'kg', True),
        Column('velocity limit', 'per s', True),
        Column('friction', 'dry, viscous', True),
        Column('worst at'),
    )
    slides = {joint.name: joint.kind == 'prismatic' for joint in joints}
    return table('joints', columns, [_joint(joint, names, slides) for joint in joints])


def _joint(joint, names, slides):
    is_prismatic = joint.kind == 'prismatic'
    load = joint.gravity
    kind = joint.kind
    if joint.mimics is not None:
        kind = f'{joint.kind}, follows {joint.mimics}'
    limit = amount(joint.effort, tone='' if joint.effort > 0.0 else 'doubt')
    if load is None:
        empty = Cell('–', math.nan, 'missing')
        worst, share, left, where = empty, empty, empty, Cell('–', tone='missing')
    else:
        worst = Cell(text(number(load.worst)), load.magnitude)
        share = _share(load.share)
        left = amount(load.payload_left, 3, tone='bad' if load.payload_left == 0.0 else '')
        where = Cell(_where(load.position, names, slides))
    velocity = amount(joint.velocity)
    if math.isfinite(joint.velocity):
        velocity = Cell(position(joint.velocity, is_prismatic), joint.velocity)
    return (
        name(joint.name),
        words(kind),
        _range(joint, is_prismatic),
        worst,
        limit,
        share,
        left,
        velocity,
        Cell(text(f'{number(joint.friction, 3)}, {number(joint.damping, 3)}'), joint.friction),
        where,
    )


def _range(joint, is_prismatic):
    if math.isinf(joint.lower) and math.isinf(joint.upper):
        return words('without end' if not is_prismatic else 'no limits')
    ends = f'{position(joint.lower, is_prismatic)} to {position(joint.upper, is_prismatic)}'
    return words(ends, 'firm doubt' if joint.lower >= joint.upper else 'firm')


def _share(share):
    if math.isnan(share):
        return Cell('–', share, 'missing')
    # The width of the bar inside its meter; all of it when the limit is reached.
    name_of_tone = _TONES[tone(share)]
    width = 100.0 * min(share, 1.0)
    return Cell(
        f'<span class="meter"><i class="{name_of_tone}" style="width:{width:.1f}%"></i>'
        f'</span>{percent(share)}',
        share,
        name_of_tone,
    )


def _where(values, names, slides):
    lines = ', '.join(
        f'{span(joint)} {position(value, slides[joint])}'
        for joint, value in zip(names, values, strict=True)
    )
    return f'<details><summary>pose</summary>{lines}</details>'
