"""The plot of the worst gravity torque of every joint against its effort limit."""

import math
from typing import Any

from .escape import plot_text
from .plot_parts import axis, color, layout, MARGINS, ROW, rows
from ..formatting import number, percent, quantity

TIGHT = 0.8  # of the limit: what is left above is needed to move


def tone(share):
    """Return the colour of a share of an effort limit, by its name in the style sheet."""
    if math.isnan(share):
        return 'faint'
    return 'problem' if share > 1.0 else 'warning' if share > TIGHT else 'accent'


def worst_figure(joints):
    """
    Return the plot, in two modes: shares of the limits, and torques.

    Parameters
    ----------
    joints : sequence of JointEntry
        Those with a `gravity`.

    Returns
    -------
    dict
        `data` and `layout` as plotly takes them, `height` (px), and `modes`: a list of `label`,
        `visible` (per trace) and `layout` (what changes).

    """
    places = list(range(len(joints)))
    shares = [joint.gravity.share for joint in joints]
    torques = [joint.gravity.magnitude for joint in joints]
    limits = [joint.effort for joint in joints]
    hover = [plot_text(_sentence(joint)).replace('\n', '<br>') for joint in joints]
    bar: dict[str, Any] = {
        'type': 'bar',
        'orientation': 'h',
        'y': places,
        'hovertext': hover,
        'hoverinfo': 'text',
        'marker': {'color': [color(tone(share)) for share in shares]},
        'textposition': 'outside',
        'cliponaxis': False,
        'textfont': {'size': 12, 'color': color('muted')},
    }
    of_limit = {
        **bar,
        'name': 'share',
        'x': [_finite(100.0 * share, 0.0) for share in shares],
        'text': [plot_text(_share_label(joint)) for joint in joints],
    }
    plain = {
        **bar,
        'name': 'torque',
        'x': torques,
        'text': [plot_text(_torque_label(joint)) for joint in joints],
    }
    marks = {
        'type': 'scatter',
        'mode': 'markers',
        'name': 'limit',
        'y': places,
        'x': [_finite(limit) for limit in limits],
        'hoverinfo': 'skip',
        'marker': {
            'symbol': 'line-ns',
            'size': 17,
            'color': color('ink'),
            'line': {'width': 2.5, 'color': color('ink')},
        },
    }
    largest = max([100.0 * share for share in shares if math.isfinite(share)], default=0.0)
    share_axis = axis(
        '% of the effort limit', range=[0, 1.3 * max(largest, 78.0)], rangemode='tozero'
    )
    torque_axis = axis(_torque_title(joints), range=[0, _torque_end(torques, limits)])
    line = {
        'type': 'line',
        'x0': 100,
        'x1': 100,
        'y0': 0,
        'y1': 1,
        'yref': 'paper',
        'line': {'color': color('ink'), 'width': 1.5, 'dash': 'dot'},
    }
    modes: list[dict[str, Any]] = [
        {
            'label': 'share of the limit',
            'visible': [True, False, False],
            'layout': {'xaxis': share_axis, 'shapes': [line]},
        },
        {
            'label': 'torque',
            'visible': [False, True, True],
            'layout': {'xaxis': torque_axis, 'shapes': []},
        },
    ]
    # Without a single limit there are no shares to show.
    modes = modes if any(math.isfinite(share) for share in shares) else modes[1:]
    data: list[dict[str, Any]] = [of_limit, plain, marks]
    for trace, is_visible in zip(data, modes[0]['visible'], strict=True):
        trace['visible'] = is_visible
    return {
        'data': data,
        'height': ROW * len(joints) + MARGINS,
        'modes': modes,
        'layout': layout(yaxis=rows([joint.name for joint in joints]), **modes[0]['layout']),
    }


def _torque_end(torques, limits):
    """Return where the axis ends: a limit far beyond all torques would make them invisible."""
    largest = max(torques, default=0.0) or 1.0
    near = [limit for limit in limits if math.isfinite(limit) and limit <= 3.0 * largest]
    return max(1.35 * largest, 1.05 * max(near, default=0.0))


def _torque_title(joints):
    units = sorted({joint.effort_unit for joint in joints})
    return f'worst gravity torque [{" or ".join(units)}]'


def _finite(value, otherwise=None):
    return value if math.isfinite(value) else otherwise


def _share_label(joint):
    if math.isnan(joint.gravity.share):
        return f'no limit, {quantity(joint.gravity.magnitude, joint.effort_unit, 3)}'
    return percent(joint.gravity.share)


def _torque_label(joint):
    worst = number(joint.gravity.magnitude, 3)
    limit = '' if math.isnan(joint.effort) else f' of {number(joint.effort)}'
    return f'{worst}{limit} {joint.effort_unit}'


def _sentence(joint):
    load = joint.gravity
    lines = [joint.name, f'worst {quantity(load.worst, joint.effort_unit)}']
    if math.isnan(joint.effort):
        lines.append('no effort limit')
    else:
        lines.append(
            f'limit {quantity(joint.effort, joint.effort_unit)}, {percent(load.share)} of it'
        )
    return '\n'.join(lines)
