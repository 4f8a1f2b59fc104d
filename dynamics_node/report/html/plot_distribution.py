"""The plot of how |G_j| is spread over the workspace, a box for every joint."""

import math
from typing import Any

from .escape import plot_text
from .plot_parts import axis, color, layout, MARGINS, ROW, rows
from ..formatting import percent, quantity


def quantile(load, level):
    """Return a quantile of |G_j| over the samples, one of `load.levels`."""
    return load.quantiles[load.levels.index(level)]


def distribution_figure(joints):
    """
    Return the plot, in two modes: shares of the limits, and torques.

    Parameters
    ----------
    joints : sequence of JointEntry
        Those with a `gravity`.

    Returns
    -------
    dict
        As of `plot_worst.worst_figure`.

    """
    limited = [
        place
        for place, joint in enumerate(joints)
        if math.isfinite(joint.effort) and joint.effort > 0.0
    ]
    everyone = range(len(joints))
    units = ' or '.join(sorted({joint.effort_unit for joint in joints}))
    data = [
        _boxes(joints, limited, [100.0 / joints[place].effort for place in limited]),
        _boxes(joints, everyone, [1.0 for _ in joints]),
        _hover(joints, limited, [100.0 / joints[place].effort for place in limited]),
        _hover(joints, everyone, [1.0 for _ in joints]),
    ]
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
            'visible': [True, False, True, False],
            'layout': {
                'xaxis': axis('% of the effort limit', rangemode='tozero'),
                'shapes': [line],
            },
        },
        {
            'label': 'torque',
            'visible': [False, True, False, True],
            'layout': {
                'xaxis': axis(f'|gravity torque| [{units}]', rangemode='tozero'),
                'shapes': [],
            },
        },
    ]
    modes = modes if limited else modes[1:]
    for trace, is_visible in zip(data, modes[0]['visible'], strict=True):
        trace['visible'] = is_visible
    return {
        'data': data,
        'height': ROW * len(joints) + MARGINS,
        'modes': modes,
        'layout': layout(
            yaxis=rows([joint.name for joint in joints]), boxgap=0.42, **modes[0]['layout']
        ),
    }


def _boxes(joints, places, scales):
    """Return boxes from a quarter to three quarters of the samples; whiskers hold 90 %."""
    levels = {'lowerfence': 0.05, 'q1': 0.25, 'median': 0.5, 'q3': 0.75, 'upperfence': 0.95}
    return {
        'type': 'box',
        'orientation': 'h',
        'y': list(places),
        'hoverinfo': 'skip',
        'line': {'color': color('accent'), 'width': 1.5},
        'fillcolor': color('accent-soft'),
        **{
            name: [
                scale * quantile(joints[place].gravity, level)
                for place, scale in zip(places, scales, strict=True)
            ]
            for name, level in levels.items()
        },
    }


def _hover(joints, places, scales):
    """Return invisible points on the medians that say the numbers."""
    return {
        'type': 'scatter',
        'mode': 'markers',
        'y': list(places),
        'hoverinfo': 'text',
        'x': [
            scale * quantile(joints[place].gravity, 0.5)
            for place, scale in zip(places, scales, strict=True)
        ],
        'hovertext': [_sentence(joints[place]) for place in places],
        'marker': {'size': 16, 'opacity': 0},
    }


def _sentence(joint):
    load, unit = joint.gravity, joint.effort_unit
    parts = [plot_text(joint.name)]
    for word, level in (('half of the poses', 0.5), ('three quarters', 0.75), ('95 %', 0.95)):
        value = quantile(load, level)
        share = (
            ''
            if math.isnan(joint.effort) or joint.effort <= 0.0
            else (f', {percent(value / joint.effort)}')
        )
        parts.append(f'{word}: up to {quantity(value, unit)}{share}')
    return '<br>'.join(parts)
