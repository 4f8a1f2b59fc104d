"""The plots of one joint: G over its own position, and the histogram of |G|."""

from __future__ import annotations

from itertools import pairwise
import math

from .plots import axis, color, dotted_line, Figure, gravity_of, layout, plot_text
from ..formatting import number, position, quantity
from ..report import JointEntry

# Height of a plot, px.
HEIGHT = 300


def curve_figure(joint: JointEntry, own_position: float) -> Figure:
    """
    Return the plot of G_j over q_j, with the other joints as in the worst pose.

    Parameters
    ----------
    joint : JointEntry
        With a `gravity`.
    own_position : float
        Position of this joint in its worst pose, rad or m.

    Returns
    -------
    dict
        `data`, `layout` and `height` (px).

    """
    load, is_prismatic, unit = gravity_of(joint), joint.kind == 'prismatic', joint.effort_unit
    scale, symbol = (1.0, 'm') if is_prismatic else (180.0 / math.pi, '°')
    worst = f'worst: {quantity(load.worst, unit)} at {position(own_position, is_prismatic)}'
    data = [
        {
            'type': 'scatter',
            'mode': 'lines',
            'x': [scale * value for value in load.curve_positions],
            'y': list(load.curve_torques),
            'line': {'color': color('accent'), 'width': 2.5, 'shape': 'spline'},
            'name': plot_text(joint.name),
            'hovertemplate': f'%{{x:.4g}}{" m" if is_prismatic else "°"}: %{{y:.4g}} {unit}'
            '<extra></extra>',
        },
        {
            'type': 'scatter',
            'mode': 'markers',
            'x': [scale * own_position],
            'y': [load.worst],
            'marker': {
                'color': color('mass'),
                'size': 11,
                'line': {'color': color('card'), 'width': 2},
            },
            'hoverinfo': 'text',
            'name': 'worst',
            'hovertext': [worst],
        },
    ]
    values = [*load.curve_torques, load.worst, 0.0]
    low, high = min(values), max(values)
    margin = 0.12 * (high - low) or 1.0
    limits = _near_limits(joint, low, high)
    low, high = min([low, *limits]), max([high, *limits])
    return {
        'data': data,
        'height': HEIGHT,
        'layout': layout(
            xaxis=axis(f'position of the joint [{symbol}]', zeroline=False),
            yaxis=axis(f'gravity torque [{unit}]', range=[low - margin, high + margin]),
            shapes=[
                dotted_line('problem', xref='paper', x0=0, x1=1, y0=limit, y1=limit)
                for limit in limits
            ],
            annotations=[_limit_label(limit) for limit in limits],
            hovermode='closest',
        ),
    }


def histogram_figure(joint: JointEntry) -> Figure:
    """
    Return the histogram of |G_j| over the sampled poses.

    Parameters
    ----------
    joint : JointEntry
        With a `gravity`.

    Returns
    -------
    dict
        `data`, `layout` and `height` (px).

    """
    load, unit = gravity_of(joint), joint.effort_unit
    total = sum(load.counts) or 1
    bins = list(pairwise(load.edges))
    bars = {
        'type': 'bar',
        'x': [(low + high) / 2.0 for low, high in bins],
        'width': [high - low for low, high in bins],
        'y': [100.0 * amount / total for amount in load.counts],
        'name': 'poses',
        'marker': {'color': color('accent'), 'line': {'color': color('card'), 'width': 1}},
        'hoverinfo': 'text',
        'hovertext': [
            f'{number(low, 3)} to {number(high, 3)} {unit}: {amount} of {total} poses'
            for (low, high), amount in zip(bins, load.counts, strict=True)
        ],
    }
    shapes = []
    if math.isfinite(joint.effort) and joint.effort <= 1.3 * max(load.edges[-1], load.magnitude):
        shapes.append(
            dotted_line('problem', yref='paper', y0=0, y1=1, x0=joint.effort, x1=joint.effort)
        )
    return {
        'data': [bars],
        'height': HEIGHT,
        'layout': layout(
            xaxis=axis(f'|gravity torque| [{unit}]', zeroline=False),
            yaxis=axis('% of the sampled poses', rangemode='tozero'),
            shapes=shapes,
            bargap=0,
        ),
    }


def _near_limits(joint: JointEntry, low: float, high: float) -> list[float]:
    # A limit far outside would flatten the curve.
    limits, span = [], high - low
    for limit in (-joint.effort, joint.effort):
        if math.isfinite(limit) and low - 1.5 * span <= limit <= high + 1.5 * span:
            limits.append(limit)
            low, high = min(low, limit), max(high, limit)
            span = high - low
    return limits


def _limit_label(limit: float) -> Figure:
    return {
        'xref': 'paper',
        'x': 0.01,
        'y': limit,
        'xanchor': 'left',
        'yanchor': 'bottom' if limit > 0.0 else 'top',
        'showarrow': False,
        'text': 'effort limit',
        'font': {'size': 11, 'color': color('problem')},
    }
