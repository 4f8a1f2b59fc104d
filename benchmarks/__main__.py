"""`python -m benchmarks`: measure, print and write the report and its plot."""

import argparse
from pathlib import Path
import sys

from . import libraries
from .plot import draw
from .report import render
from .robots import ROOT
from .run import run
from .scaling import SIZES

PICTURE = 'benchmarks.png'


def main(arguments=None):
    """
    Run the benchmarks.

    Parameters
    ----------
    arguments : list of str, optional
        Default: those of the command line.

    Returns
    -------
    int
        Exit code.

    """
    parser = argparse.ArgumentParser(prog='python -m benchmarks', description=__doc__)
    parser.add_argument(
        '--output',
        type=Path,
        default=ROOT / 'docs',
        metavar='FOLDER',
        help='folder of benchmarks.md and its plot (default: docs)',
    )
    parser.add_argument(
        '--rounds',
        type=int,
        default=21,
        help='interleaved rounds of single calls (default: %(default)s)',
    )
    parser.add_argument(
        '--states', type=int, default=100_000, help='states in a batch (default: %(default)s)'
    )
    parser.add_argument(
        '--largest',
        type=int,
        default=SIZES[-1],
        help='joints of the largest chain and tree (default: %(default)s)',
    )
    parser.add_argument(
        '--libraries',
        nargs='*',
        choices=libraries.FILES,
        default=list(libraries.FILES),
        help='libraries to compare with (default: all)',
    )
    parser.add_argument(
        '--without-sections', action='store_true', help='omit the sections that need ROS'
    )
    options = parser.parse_args(arguments)
    if options.rounds < 1 or options.states < 1:
        parser.error('expected at least one round and one state')
    results = run(
        options.rounds,
        options.states,
        sizes=[size for size in SIZES if size <= options.largest],
        names=options.libraries,
        with_sections=not options.without_sections,
        say=lambda text: print(text, file=sys.stderr, flush=True),
    )
    report = render(results, PICTURE)
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / 'benchmarks.md').write_text(report, encoding='utf-8')
    draw(results, options.output / PICTURE)
    print(report)
    print(f'Written: {options.output / "benchmarks.md"} and {PICTURE} beside it.', file=sys.stderr)
    return 0


if __name__ == '__main__':
    sys.exit(main())
