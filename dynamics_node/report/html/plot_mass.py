"""The plot of what the bodies weigh, in the order of the chain."""

from .escape import plot_text
from .plot_parts import axis, color, layout, MARGINS, ROW, rows
from ..formatting import count, number, vector


def mass_figure(bodies):
    """
    Return the plot.

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
    data = [
        {
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
            'hovertext': [_sentence(body, total) for body in bodies],
            'marker': {
                'color': [color('mass' if body.is_physical else 'problem') for body in bodies]
            },
        }
    ]
    return {
        'data': data,
        'height': ROW * len(bodies) + MARGINS,
        'layout': layout(
            yaxis=rows([body.link for body in bodies]),
            xaxis=axis('mass [kg]', range=[0, 1.25 * largest]),
        ),
    }


def _sentence(body, total):
    lines = [plot_text(body.link), f'{number(body.mass)} kg']
    if total > 0.0:
        lines[-1] += f', {number(100.0 * body.mass / total, 3)} % of what moves'
    lines.append(f'centre of mass {vector(body.com, 3)} m')
    if body.lumped:
        lines.append(f'with {count(len(body.lumped), "fixed link")}')
    return '<br>'.join(lines)
