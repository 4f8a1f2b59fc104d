"""The picture of the report: three panels, times on logarithmic axes."""

import matplotlib

matplotlib.use('Agg')

from matplotlib import pyplot
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from .formatting import digits
from .scaling import SHAPES
from .timing import spread_of

DYNAMICS_NODE = 'dynamics_node'
_LINES = {'chain': '-', 'binary tree': '--'}


def draw(results, path):
    """
    Write the picture.

    Parameters
    ----------
    results : Results
    path : str or os.PathLike
        PNG file.

    """
    figure = pyplot.figure(figsize=(10, 9), layout='constrained')
    grid = figure.add_gridspec(2, 2)
    _draw_single(results, figure.add_subplot(grid[0, :]))
    _draw_batch(results, figure.add_subplot(grid[1, 0]))
    _draw_scaling(results, figure.add_subplot(grid[1, 1]))
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def _draw_single(results, axes):
    rows = [row for row in results.single if row.quantity == 'dynamics']
    libraries = list(dict.fromkeys(row.library for row in rows))[::-1]
    for k, robot in enumerate(dict.fromkeys(row.robot for row in rows)):
        chosen = [row for row in rows if row.robot == robot]
        # One below the other: three robots stay readable.
        places = [libraries.index(row.library) + 0.3 * (1 - k) for row in chosen]
        _dots(axes, places, [spread_of(row.seconds) for row in chosen], 1e6, f'C{k}', robot)
    axes.set_yticks(range(len(libraries)), libraries)
    axes.set_xlabel('µs per call (some give less, see the table)')
    axes.set_title('D, C and G of one state, from Python', fontsize=10)
    axes.legend(fontsize=8)


def _draw_batch(results, axes):
    rows = results.batch[::-1]
    labels = [
        f'{row.library},\n{row.cores} core{"" if row.cores == "one" else "s"}' for row in rows
    ]
    for place, row in enumerate(rows):
        _dots(
            axes,
            [place],
            [spread_of(row.seconds)],
            1e6 / results.batch_count,
            'C0' if row.library == DYNAMICS_NODE else 'C7',
        )
    axes.set_yticks(range(len(rows)), labels)
    axes.set_ylim(-0.6, len(rows) - 0.4)
    if rows:
        medians = [1e6 * spread_of(row.seconds).median / results.batch_count for row in rows]
        axes.set_xlim(min(medians) / 2.0, max(medians) * 2.0)
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f'{value:g}'))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel('µs per state')
    axes.set_title(f'{results.batch_count} states of a 7-joint arm in one call', fontsize=10)


def _draw_scaling(results, axes):
    for number, library in enumerate(dict.fromkeys(row.library for row in results.scaling)):
        for shape in SHAPES:
            rows = [row for row in results.scaling if (row.shape, row.library) == (shape, library)]
            axes.loglog(
                [row.joints for row in rows],
                [1e6 * spread_of(row.seconds).median for row in rows],
                _LINES[shape],
                marker='o',
                markersize=3,
                color=f'C{number}',
                label=f'{library}, {shape}',
            )
    sizes = list(dict.fromkeys(row.joints for row in results.scaling))
    axes.set_xticks(sizes, [str(size) for size in sizes])
    axes.set_xticks([], minor=True)
    axes.grid(alpha=0.3)
    axes.set_xlabel('joints')
    axes.set_ylabel('µs per call')
    axes.set_title('D, C and G by number of joints', fontsize=10)
    axes.legend(fontsize=8)


def _dots(axes, places, spreads, scale, color, label=None):
    # Dots with quartiles: the length of a bar means nothing on a logarithmic axis.
    medians = [scale * spread.median for spread in spreads]
    sides = [
        [scale * (spread.median - spread.low) for spread in spreads],
        [scale * (spread.high - spread.median) for spread in spreads],
    ]
    axes.errorbar(
        medians, places, xerr=sides, fmt='o', markersize=5, capsize=2, color=color, label=label
    )
    for median, spread, place in zip(medians, spreads, places, strict=True):
        axes.annotate(
            digits(median),
            (scale * spread.high, place),
            (6, -3),
            textcoords='offset points',
            fontsize=7,
        )
    axes.set_xscale('log')
    axes.margins(x=0.3)
    axes.grid(alpha=0.3, axis='x')
