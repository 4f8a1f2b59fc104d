"""The plots of one joint: G over its own position, and how often which torque comes."""

from itertools import pairwise
import math

from .escape import plot_text
from .plot_parts import axis, color, layout
from ..formatting import number, position, quantity

HEIGHT = 300  # [px]


def curve_figure(joint, own_position):
    """
    Return the plot of G_j over q_j, with the other joints as in the worst pose.

    Parameters
    ----------
    joint : JointEntry
        With a `gravity`.
    own_position : float
        Of this joint in its worst pose, rad or m.

    Returns
    -------
    dict
        `data`, `layout` and `height` (px).

    """
    load, slides = joint.gravity, joint.kind == 'prismatic'
    unit = joint.effort_unit
    scale = 1.0 if slides else 180.0 / math.pi
    places = [scale * value for value in load.curve_positions]
    data = [
        {
            'type': 'scatter',
            'mode': 'lines',
            'x': places,
            'y': list(load.curve_torques),
            'line': {'color': color('accent'), 'width': 2.5, 'shape': 'spline'},
            'name': plot_text(joint.name),
            'hovertemplate': f'%{{x:.4g}}{" m" if slides else "°"}: %{{y:.4g}} {unit}'
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
            'hovertext': [
                f'worst: {quantity(load.worst, unit)} at {position(own_position, slides)}'
            ],
        },
    ]
    shapes, notes = [], []
    ends = [*load.curve_torques, load.worst, 0.0]
    low, high = min(ends), max(ends)
    room = 0.12 * (high - low) or 1.0
    # A limit far outside would press the curve into a line: then a sentence says it.
    for limit in (-joint.effort, joint.effort):
        near = low - 1.5 * (high - low) <= limit <= high + 1.5 * (high - low)
        if math.isfinite(limit) and near:
            shapes.append(
                {
                    'type': 'line',
                    'xref': 'paper',
                    'x0': 0,
                    'x1': 1,
                    'y0': limit,
                    'y1': limit,
                    'line': {'color': color('problem'), 'width': 1.5, 'dash': 'dot'},
                }
            )
            notes.append(
                {
                    'xref': 'paper',
                    'x': 0.01,
                    'y': limit,
                    'xanchor': 'left',
                    'yanchor': 'bottom' if limit > 0.0 else 'top',
                    'showarrow': False,
                    'text': 'effort limit',
                    'font': {'size': 11, 'color': color('problem')},
                }
            )
            low, high = min(low, limit), max(high, limit)
    return {
        'data': data,
        'height': HEIGHT,
        'layout': layout(
            xaxis=axis(
                'position of the joint [m]' if slides else 'position of the joint [°]',
                zeroline=False,
            ),
            yaxis=axis(f'gravity torque [{unit}]', range=[low - room, high + room]),
            shapes=shapes,
            annotations=notes,
            hovermode='closest',
        ),
    }


def histogram_figure(joint):
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
    load, unit = joint.gravity, joint.effort_unit
    total = sum(load.counts) or 1
    edges = load.edges
    data = [
        {
            'type': 'bar',
            'x': [(a + b) / 2.0 for a, b in pairwise(edges)],
            'width': [b - a for a, b in pairwise(edges)],
            'y': [100.0 * amount / total for amount in load.counts],
            'name': 'poses',
            'marker': {'color': color('accent'), 'line': {'color': color('card'), 'width': 1}},
            'hoverinfo': 'text',
            'hovertext': [
                f'{number(a, 3)} to {number(b, 3)} {unit}: {amount} of {total} poses'
                for a, b, amount in zip(edges[:-1], edges[1:], load.counts, strict=True)
            ],
        }
    ]
    shapes = []
    if math.isfinite(joint.effort) and joint.effort <= 1.3 * max(edges[-1], load.magnitude):
        shapes.append(
            {
                'type': 'line',
                'yref': 'paper',
                'y0': 0,
                'y1': 1,
                'x0': joint.effort,
                'x1': joint.effort,
                'line': {'color': color('problem'), 'width': 1.5, 'dash': 'dot'},
            }
        )
    return {
        'data': data,
        'height': HEIGHT,
        'layout': layout(
            xaxis=axis(f'|gravity torque| [{unit}]', zeroline=False),
            yaxis=axis('% of the sampled poses', rangemode='tozero'),
            shapes=shapes,
            bargap=0,
        ),
    }
