"""The plots of all joints and bodies, and the style that all plots share."""

from __future__ import annotations

from collections.abc import Sequence
import html
import math
from typing import Any

from ..formatting import count, number, percent, quantity, vector
from ..report import BodyEntry, GravityLoad, JointEntry

Figure = dict[str, Any]

# Height of a joint or body in a plot, px.
ROW = 26
# Height above and below the rows, px.
MARGINS = 74
# Longest name beside a plot, characters; the whole name is shown under the mouse.
LONGEST = 26
# Share of an effort limit above which little is left for motion.
TIGHT = 0.8


def plot_text(value: object) -> str:
    """
    Return a text that plotly shows literally.

    plotly interprets some tags in every text, and templates such as `%{x}` in some. Escaped
    braces are no templates: plotly decodes entities after templates.

    Parameters
    ----------
    value : object
        Anything with a `str`.

    Returns
    -------
    str

    """
    return html.escape(str(value), quote=False).replace('{', '&#123;').replace('}', '&#125;')


def color(name: str) -> dict[str, str]:
    """Return a color of the page's style sheet, which has light and dark ones."""
    return {'css': name}


def tone(share: float) -> str:
    """Return the style sheet's name of the color for a share of an effort limit."""
    if math.isnan(share):
        return 'faint'
    return 'problem' if share > 1.0 else 'warning' if share > TIGHT else 'accent'


def short_name(name: str, longest: int = LONGEST) -> str:
    """Return a name that fits beside a plot, its middle replaced by '…', for plotly."""
    if len(name) > longest:
        half = (longest - 1) // 2
        name = f'{name[:half]}…{name[-half:]}'
    return plot_text(name)


def rows(names: Sequence[str]) -> Figure:
    """
    Return the vertical axis with one row per name, the first one on top.

    The names are labels at 0, 1, 2...: as categories, plotly would take '1' for a number and
    '2026-01-01' for a date.

    """
    return {
        'type': 'linear',
        'tickmode': 'array',
        'tickvals': list(range(len(names))),
        'ticktext': [short_name(name) for name in names],
        'range': [len(names) - 0.4, -0.6],
        'ticks': '',
        'zeroline': False,
        'showgrid': False,
        'automargin': True,
        'fixedrange': True,
        'color': color('ink'),
        'tickfont': {'size': 12},
    }


def axis(title: str, **more: Any) -> Figure:
    """Return a horizontal or vertical axis of numbers."""
    return {
        'type': 'linear',
        'title': {'text': title, 'font': {'size': 12}},
        'gridcolor': color('grid'),
        'zerolinecolor': color('line'),
        'zerolinewidth': 1,
        'linecolor': color('line'),
        'color': color('muted'),
        'automargin': True,
        'tickfont': {'size': 12},
        **more,
    }


def layout(**more: Any) -> Figure:
    """Return the layout of a plot."""
    return {
        'paper_bgcolor': 'rgba(0,0,0,0)',
        'plot_bgcolor': 'rgba(0,0,0,0)',
        'font': {
            'color': color('ink'),
            'size': 13,
            'family': 'system-ui, -apple-system, Segoe UI, Roboto, Noto Sans, Arial',
        },
        'margin': {'l': 10, 'r': 14, 't': 12, 'b': 44},
        'showlegend': False,
        'hoverlabel': {
            'bgcolor': color('raised'),
            'bordercolor': color('line'),
            'font': {'color': color('ink')},
            'align': 'left',
            'namelength': -1,
        },
        'modebar': {
            'bgcolor': 'rgba(0,0,0,0)',
            'color': color('faint'),
            'activecolor': color('accent'),
        },
        # A finger that scrolls the page must not zoom into a plot.
        'dragmode': False,
        'bargap': 0.38,
        **more,
    }


def dotted_line(color_name: str, **ends: Any) -> Figure:
    """Return a dotted line across a plot."""
    return {
        'type': 'line',
        **ends,
        'line': {'color': color(color_name), 'width': 1.5, 'dash': 'dot'},
    }


def gravity_of(joint: JointEntry) -> GravityLoad:
    """Return the gravity load of a joint that has one."""
    assert joint.gravity is not None
    return joint.gravity


def worst_figure(joints: Sequence[JointEntry]) -> Figure:
    """
    Return the plot of the worst gravity torques against the effort limits.

    Parameters
    ----------
    joints : sequence of JointEntry
        Those with a `gravity`.

    Returns
    -------
    dict
        `data` and `layout` for plotly, `height` (px), and `modes`, shares of the limits and
        torques: `label`, `visible` (per trace) and `layout` (the changes) of each.

    """
    shares = [gravity_of(joint).share for joint in joints]
    torques = [gravity_of(joint).magnitude for joint in joints]
    limits = [joint.effort for joint in joints]
    bar: Figure = {
        'type': 'bar',
        'orientation': 'h',
        'y': list(range(len(joints))),
        'hovertext': [_worst_hover(joint) for joint in joints],
        'hoverinfo': 'text',
        'marker': {'color': [color(tone(share)) for share in shares]},
        'textposition': 'outside',
        'cliponaxis': False,
        'textfont': {'size': 12, 'color': color('muted')},
    }
    limit_marks = {
        'type': 'scatter',
        'mode': 'markers',
        'name': 'limit',
        'y': list(range(len(joints))),
        'x': [limit if math.isfinite(limit) else None for limit in limits],
        'hoverinfo': 'skip',
        'marker': {
            'symbol': 'line-ns',
            'size': 17,
            'color': color('ink'),
            'line': {'width': 2.5, 'color': color('ink')},
        },
    }
    data = [
        {
            **bar,
            'name': 'share',
            'x': [100.0 * share if math.isfinite(share) else 0.0 for share in shares],
            'text': [plot_text(_share_label(joint)) for joint in joints],
        },
        {
            **bar,
            'name': 'torque',
            'x': torques,
            'text': [plot_text(_torque_label(joint)) for joint in joints],
        },
        limit_marks,
    ]
    largest = max([100.0 * share for share in shares if math.isfinite(share)], default=0.0)
    return _with_modes(
        joints,
        data,
        is_share=[True, False, False],
        share_axis=axis(
            '% of the effort limit', range=[0, 1.3 * max(largest, 78.0)], rangemode='tozero'
        ),
        torque_axis=axis(
            f'worst gravity torque [{_units(joints)}]', range=[0, _torque_end(torques, limits)]
        ),
        has_shares=any(math.isfinite(share) for share in shares),
    )


def distribution_figure(joints: Sequence[JointEntry]) -> Figure:
    """
    Return the plot of the distribution of |G_j| over the samples, one box per joint.

    Parameters
    ----------
    joints : sequence of JointEntry
        Those with a `gravity`.

    Returns
    -------
    dict
        As `worst_figure`.

    """
    limited = [
        index
        for index, joint in enumerate(joints)
        if math.isfinite(joint.effort) and joint.effort > 0.0
    ]
    to_share = [100.0 / joints[index].effort for index in limited]
    everything, unscaled = list(range(len(joints))), [1.0 for _ in joints]
    figure = _with_modes(
        joints,
        [
            _boxes(joints, limited, to_share),
            _boxes(joints, everything, unscaled),
            _medians(joints, limited, to_share),
            _medians(joints, everything, unscaled),
        ],
        is_share=[True, False, True, False],
        share_axis=axis('% of the effort limit', rangemode='tozero'),
        torque_axis=axis(f'|gravity torque| [{_units(joints)}]', rangemode='tozero'),
        has_shares=bool(limited),
    )
    figure['layout']['boxgap'] = 0.42
    return figure


def mass_figure(bodies: Sequence[BodyEntry]) -> Figure:
    """
    Return the plot of the masses of the bodies, in the order of the chain.

    Parameters
    ----------
    bodies : sequence of BodyEntry

    Returns
    -------
    dict
        `data`, `layout` and `height` (px).

    """
    total = sum(body.mass for body in bodies)
    largest = max((body.mass for body in bodies), default=0.0) or 1.0
    bars = {
        'type': 'bar',
        'orientation': 'h',
        'y': list(range(len(bodies))),
        'x': [body.mass for body in bodies],
        'name': 'mass',
        'text': [f'{number(body.mass, 3)} kg' for body in bodies],
        'textposition': 'outside',
        'textfont': {'size': 12, 'color': color('muted')},
        'cliponaxis': False,
        'hoverinfo': 'text',
        'hovertext': [_mass_hover(body, total) for body in bodies],
        'marker': {'color': [color('mass' if body.is_physical else 'problem') for body in bodies]},
    }
    return {
        'data': [bars],
        'height': ROW * len(bodies) + MARGINS,
        'layout': layout(
            yaxis=rows([body.link for body in bodies]),
            xaxis=axis('mass [kg]', range=[0, 1.25 * largest]),
        ),
    }


def _with_modes(
    joints: Sequence[JointEntry],
    data: list[Figure],
    *,
    is_share: list[bool],
    share_axis: Figure,
    torque_axis: Figure,
    has_shares: bool,
) -> Figure:
    # Traces of shares and of torques in one plot, of which one kind is visible at a time.
    modes = [
        {
            'label': 'torque',
            'visible': [not share for share in is_share],
            'layout': {'xaxis': torque_axis, 'shapes': []},
        }
    ]
    if has_shares:
        limit = dotted_line('ink', x0=100, x1=100, y0=0, y1=1, yref='paper')
        modes.insert(
            0,
            {
                'label': 'share of the limit',
                'visible': is_share,
                'layout': {'xaxis': share_axis, 'shapes': [limit]},
            },
        )
    first: Figure = modes[0]
    for trace, is_visible in zip(data, first['visible'], strict=True):
        trace['visible'] = is_visible
    return {
        'data': data,
        'height': ROW * len(joints) + MARGINS,
        'modes': modes,
        'layout': layout(yaxis=rows([joint.name for joint in joints]), **first['layout']),
    }


def _units(joints: Sequence[JointEntry]) -> str:
    return ' or '.join(sorted({joint.effort_unit for joint in joints}))


def _torque_end(torques: Sequence[float], limits: Sequence[float]) -> float:
    # The end of the axis: a limit far above all torques would make them invisible.
    largest = max(torques, default=0.0) or 1.0
    near = [limit for limit in limits if math.isfinite(limit) and limit <= 3.0 * largest]
    return max(1.35 * largest, 1.05 * max(near, default=0.0))


def _share_label(joint: JointEntry) -> str:
    load = gravity_of(joint)
    if math.isnan(load.share):
        return f'no limit, {quantity(load.magnitude, joint.effort_unit, 3)}'
    return percent(load.share)


def _torque_label(joint: JointEntry) -> str:
    worst = number(gravity_of(joint).magnitude, 3)
    limit = '' if math.isnan(joint.effort) else f' of {number(joint.effort)}'
    return f'{worst}{limit} {joint.effort_unit}'


def _worst_hover(joint: JointEntry) -> str:
    load, unit = gravity_of(joint), joint.effort_unit
    limit = 'no effort limit'
    if not math.isnan(joint.effort):
        limit = f'limit {quantity(joint.effort, unit)}, {percent(load.share)} of it'
    return _lines(joint.name, f'worst {quantity(load.worst, unit)}', limit)


def _mass_hover(body: BodyEntry, total: float) -> str:
    mass = f'{number(body.mass)} kg'
    if total > 0.0:
        mass += f', {number(100.0 * body.mass / total, 3)} % of what moves'
    lines = [body.link, mass, f'center of mass {vector(body.com, 3)} m']
    if body.lumped:
        lines.append(f'with {count(len(body.lumped), "fixed link")}')
    return _lines(*lines)


def _boxes(
    joints: Sequence[JointEntry], indices: Sequence[int], scales: Sequence[float]
) -> Figure:
    # Boxes from a quarter to three quarters of the samples; whiskers hold 90 %.
    levels = {'lowerfence': 0.05, 'q1': 0.25, 'median': 0.5, 'q3': 0.75, 'upperfence': 0.95}
    return {
        'type': 'box',
        'orientation': 'h',
        'y': list(indices),
        'hoverinfo': 'skip',
        'line': {'color': color('accent'), 'width': 1.5},
        'fillcolor': color('accent-soft'),
        **{
            name: [
                scale * gravity_of(joints[index]).quantile(level)
                for index, scale in zip(indices, scales, strict=True)
            ]
            for name, level in levels.items()
        },
    }


def _medians(
    joints: Sequence[JointEntry], indices: Sequence[int], scales: Sequence[float]
) -> Figure:
    # Invisible points on the medians with the numbers as hover text.
    return {
        'type': 'scatter',
        'mode': 'markers',
        'y': list(indices),
        'hoverinfo': 'text',
        'x': [
            scale * gravity_of(joints[index]).quantile(0.5)
            for index, scale in zip(indices, scales, strict=True)
        ],
        'hovertext': [_distribution_hover(joints[index]) for index in indices],
        'marker': {'size': 16, 'opacity': 0},
    }


def _distribution_hover(joint: JointEntry) -> str:
    lines = [joint.name]
    for part, level in (('half of the poses', 0.5), ('three quarters', 0.75), ('95 %', 0.95)):
        value = gravity_of(joint).quantile(level)
        share = f', {percent(value / joint.effort)}' if joint.effort > 0.0 else ''
        lines.append(f'{part}: up to {quantity(value, joint.effort_unit)}{share}')
    return _lines(*lines)


def _lines(*lines: str) -> str:
    return '<br>'.join(map(plot_text, lines))
