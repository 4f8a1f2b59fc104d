"""What the plots of the page have in common: colors by name, labels, axes."""

from .escape import plot_text

ROW = 26  # [px] height of one joint or body in a plot
MARGINS = 74  # [px] above and below the rows
LONGEST = 26  # characters of a name beside a plot; all of it shows under the mouse


def color(name):
    """Return a color of the page's style sheet: light and dark have each their own."""
    return {'css': name}


def short(name, longest=LONGEST):
    """Return a name that fits beside a plot, its middle left out, as literal text."""
    if len(name) > longest:
        half = (longest - 1) // 2
        name = f'{name[:half]}…{name[-half:]}'
    return plot_text(name)


def rows(names):
    """
    Return the vertical axis with one row per name, the first one on top.

    The names are labels at 0, 1, 2...: as categories, '1' and '2026-01-01' would be taken for a
    number and a date.

    """
    count = len(names)
    return {
        'type': 'linear',
        'tickmode': 'array',
        'tickvals': list(range(count)),
        'ticktext': [short(name) for name in names],
        'range': [count - 0.4, -0.6],
        'ticks': '',
        'zeroline': False,
        'showgrid': False,
        'automargin': True,
        'fixedrange': True,
        'color': color('ink'),
        'tickfont': {'size': 12},
    }


def axis(title, **more):
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


def layout(**more):
    """Return the frame of a plot."""
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
