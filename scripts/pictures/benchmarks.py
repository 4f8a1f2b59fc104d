"""docs/benchmarks_short.png: the first table of docs/benchmarks.md for the README."""

import re

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

DYNAMICS_NODE = 'dynamics_node'
# Slower kernels of this library, and a library in pure Python.
LEFT_OUT = ('general kernel', 'textbook formulas', 'roboticstoolbox')
UNITS = {'ns': 1e-3, 'µs': 1.0, 'ms': 1e3, 's': 1e6}
COLORS = ('#1f4e9e', '#e08e1b', '#2e9e6b')


def read(page):
    """
    Return the times of the first table of the benchmarks.

    Parameters
    ----------
    page : str
        docs/benchmarks.md, written by `make bench`.

    Returns
    -------
    robots : list of str
    times : dict of str to list of float
        Library → µs for D, C and G of one state, one for each robot.
    complete : set of str
        Libraries with all of D, C and G; the others give C q̇ instead of C.
    machine : str
        CPU of the measurement.

    """
    section = page.split('### D, C and G\n')[1].split('\n###')[0]
    heading, _, *lines = re.findall(r'^\|(.*)\|$', section, re.M)
    names = [cell.strip() for cell in heading.split('|')]
    columns = [
        place for place, name in enumerate(names) if name not in ('library', 'gives', 'ratio')
    ]
    times, complete = {}, set()
    for line in lines:
        cells = [cell.strip() for cell in line.split('|')]
        if cells[names.index('gives')] == 'D, C, G':
            complete.add(cells[0])
        values = [cells[column].split() for column in columns]
        times[cells[0]] = [float(number) * UNITS[unit] for number, unit in values]
    [machine] = re.findall(r'^\| CPU \| (.*?) \|$', page, re.M)
    return [names[column] for column in columns], times, complete, machine


def draw(page, path):
    """
    Write the picture.

    Parameters
    ----------
    page : str
        docs/benchmarks.md.
    path : Path
        PNG file.

    """
    robots, times, complete, machine = read(page)
    libraries = [name for name in times if name not in LEFT_OUT][::-1]
    figure = Figure(figsize=(8.3, 3.3), dpi=200, layout='constrained')
    FigureCanvasAgg(figure)
    axis = figure.subplots()
    for row, name in enumerate(libraries):
        ends = min(times[name]), max(times[name])
        axis.plot(ends, [row, row], color='#c9cdd3', lw=2, zorder=1)
    for place, (robot, color) in enumerate(zip(robots, COLORS, strict=True)):
        axis.scatter(
            [times[name][place] for name in libraries],
            range(len(libraries)),
            s=42,
            color=color,
            label=robot,
            zorder=2,
        )
    for row, name in enumerate(libraries):
        low, high = min(times[name]), max(times[name])
        axis.annotate(
            f'{low:.2g} to {high:.2g}',
            (high, row),
            (9, 0),
            va='center',
            textcoords='offset points',
            fontsize=9,
        )
    axis.set_yticks(
        range(len(libraries)),
        [name if name in complete else f'{name} *' for name in libraries],
        fontsize=10,
    )
    for label in axis.get_yticklabels():
        label.set_fontweight('bold' if label.get_text().startswith(DYNAMICS_NODE) else 'normal')
    axis.set_xscale('log')
    axis.set_xlim(0.25, 70.0)
    axis.set_xticks([0.3, 1.0, 3.0, 10.0, 30.0], ['0.3', '1', '3', '10', '30'])
    axis.set_xticks([], minor=True)
    axis.set_xlabel(
        f'µs for D, C and G of one state, called from Python (* C q̇ instead of C)\n{machine}',
        fontsize=9,
    )
    axis.grid(alpha=0.3, axis='x')
    axis.spines[['top', 'right']].set_visible(False)
    axis.legend(fontsize=9, frameon=False, loc='upper right')
    figure.savefig(path)
