"""Tables of links and bodies."""

from rich import box
from rich.table import Table
from rich.text import Text

from .numbers import short, shorts, vector

# Frames that are named before the rest is only counted.
_FRAMES = 12
# From this width on a body shows where its mass is.
_WIDE = 110


def table(*columns):
    """
    Return an empty table.

    Parameters
    ----------
    *columns : (str, str)
        Heading and justification.

    """
    made = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for heading, justify in columns:
        made.add_column(Text(heading), justify=justify, overflow='fold')
    return made


def link_table(report):
    """Return the links that have an <inertial>, or a shape without one."""
    made = table(
        ('link', 'left'),
        ('kg', 'right'),
        ('center of mass, m', 'right'),
        ('principal moments, kg m²', 'right'),
        ('', 'left'),
    )
    for link in report.links:
        if not (link.has_inertial or link.has_shape) or not _weighs(link):
            continue
        remark = '' if link.is_physical else 'no real body'
        if link.mass == 0.0:
            remark = 'weighs nothing'
        elif link.carrier is None and report.verdict == 'usable':
            remark = remark or 'on the base'
        made.add_row(
            Text(link.name),
            short(link.mass),
            vector(link.com),
            shorts(link.principal_moments),
            Text(remark, style='red' if not link.is_physical else 'dim'),
        )
    return made


def frames_line(report):
    """Return a line about the links without mass, or None."""
    frames = [link.name for link in report.links if not _weighs(link)]
    if not frames:
        return None
    more = f' and {len(frames) - _FRAMES} more' if len(frames) > _FRAMES else ''
    return Text(f'frames without mass: {", ".join(frames[:_FRAMES])}{more}', style='dim')


def body_table(report, width):
    """Return what each joint moves, with the links that fixed joints attach."""
    wide = width >= _WIDE
    more = [('center of mass, m', 'right'), ('principal moments, kg m²', 'right')] if wide else []
    made = table(
        ('joint', 'left'), ('its link + what is fixed to it', 'left'), ('kg', 'right'), *more
    )
    frames = {link.name for link in report.links if not _weighs(link)}
    for body in report.bodies:
        lumped = [name for name in body.lumped if name not in frames]
        style = '' if body.is_physical else 'red'
        cells = [vector(body.com), shorts(body.principal_moments)] if wide else []
        made.add_row(
            Text(body.joint),
            Text(' + '.join([body.link, *lumped])),
            Text(short(body.mass), style=style),
            *cells,
        )
    return made


def _weighs(link):
    # NaN: its numbers cannot be read, which is no frame.
    return link.mass != 0.0 or link.has_shape
