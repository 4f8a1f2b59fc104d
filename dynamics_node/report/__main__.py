"""`python -m dynamics_node.report ROBOT.urdf`: the report in a terminal, as JSON or as a page."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
import json
import math
import os
from pathlib import Path
import sys

from .build import DEFAULT_SAMPLES, DEFAULT_SEED, make_report, Progress
from .report import Report
from .to_json import to_json
from ..errors import ArgumentError, RobotDescriptionError
from ..urdf.input_limits import MAX_BYTES

UNUSABLE = 2
_INTERRUPTED = 130

_EXAMPLES = """
examples:
  report my_arm.urdf                          links, joints, gravity torques, findings
  xacro my_arm.urdf.xacro | report -          of a xacro
  report my_arm.urdf --html page.html         one page to share, with plots; needs no network
  report my_arm.urdf --strict                 in CI: fails if there is a problem or a warning
  report my_arm.urdf --json | jq .findings    for programs
  report my_arm.urdf --gravity 9.81 0 0       mounted on a wall
  report my_arm.urdf --payload-link gripper_tcp --payload-point 0 0 0.05

exit codes:
  0  the report was made; with --strict: without problems and warnings (notes are fine)
  1  with --strict: there is a problem or a warning, or the robot is refused
  2  no report: wrong arguments, no such file, not a URDF
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Make a report and show it.

    Parameters
    ----------
    arguments : sequence of str, optional
        By default those of the process.

    Returns
    -------
    int
        Exit code: 0, 1 (with --strict: a problem or a warning), 2 (no report).

    """
    options = parse(arguments)
    for stream in (sys.stdout, sys.stderr):
        # A terminal whose encoding lacks ² and τ shows replacement characters.
        stream.reconfigure(errors='replace')  # type: ignore[union-attr]
    try:
        return _run(options)
    except (RobotDescriptionError, ArgumentError, OSError, _UnusableError) as error:
        print(f'error: {_message(error, options)}', file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        return _INTERRUPTED


def parse(arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """
    Read the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        By default those of the process.

    Returns
    -------
    argparse.Namespace
        robot, json, html, strict, gravity, payload_link, payload_point, samples, seed.

    """
    parser = argparse.ArgumentParser(
        prog='report',
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description='Report on a URDF: the dynamics of the robot, errors in the description, and\n'
        'their effect on the torques. Meshes are never opened.',
    )
    parser.add_argument('robot', metavar='ROBOT.urdf', help='a URDF file; - reads standard input')
    parser.add_argument(
        '--json', action='store_true', help='print the report as JSON, and nothing else'
    )
    parser.add_argument(
        '--html', metavar='FILE', help='write one self-contained page with tables and plots'
    )
    parser.add_argument(
        '--strict', action='store_true', help='exit with 1 if there is a problem or a warning'
    )
    parser.add_argument(
        '--gravity',
        nargs=3,
        type=_finite,
        metavar=('X', 'Y', 'Z'),
        default=(0.0, 0.0, -9.81),
        help='m/s^2 in the frame of the root link, points down (default: 0 0 -9.81)',
    )
    parser.add_argument(
        '--payload-link',
        metavar='LINK',
        help='link that carries a payload (default: the end of the arm, before its fingers)',
    )
    parser.add_argument(
        '--payload-point',
        nargs=3,
        type=_finite,
        metavar=('X', 'Y', 'Z'),
        default=(0.0, 0.0, 0.0),
        help='center of mass of the payload in the frame of that link, m (default: 0 0 0)',
    )
    parser.add_argument(
        '--samples',
        type=int,
        default=DEFAULT_SAMPLES,
        metavar='N',
        help='number of positions from which the search for the worst ones starts '
        f'(default: {DEFAULT_SAMPLES})',
    )
    parser.add_argument(
        '--seed',
        type=int,
        default=DEFAULT_SEED,
        metavar='N',
        help=f'seed of these positions (default: {DEFAULT_SEED})',
    )
    return parser.parse_args(arguments)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f'expected a finite number, got {text}')
    return value


class _UnusableError(Exception):
    """An input or a Python package is missing; the message says what to do."""


def _run(options: argparse.Namespace) -> int:
    report = _make(options)
    if options.html is not None:
        _write_html(report, options.html)
    try:
        _show(report, options)
    except BrokenPipeError:
        # The reader, head for example, has closed the pipe: the exit code stays that of the
        # robot. Without a new standard output Python would report the error again at its exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return int(options.strict and not report.is_clean)


def _make(options: argparse.Namespace) -> Report:
    source = sys.stdin.buffer.read() if options.robot == '-' else _source(options.robot)
    with _progress_bar(is_shown=not options.json and sys.stderr.isatty()) as progress:
        return make_report(
            source,
            gravity=options.gravity,
            samples=options.samples,
            seed=options.seed,
            link=options.payload_link,
            point=options.payload_point,
            progress=progress,
        )


@contextmanager
def _progress_bar(is_shown: bool) -> Iterator[Progress | None]:
    """Show a transient progress bar on standard error; without rich there is none."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Bar
    except ModuleNotFoundError:
        is_shown = False
    if not is_shown:
        yield None
        return
    with Bar(
        BarColumn(),
        TextColumn('{task.percentage:>3.0f} %'),
        TextColumn('{task.description}', markup=False),
        console=Console(stderr=True),
        transient=True,
    ) as bar:
        task = bar.add_task('', total=1.0)
        yield lambda fraction, text: bar.update(task, completed=fraction, description=text)


def _source(text: str) -> Path | bytes:
    path = Path(text)
    if not text or path.is_dir() or not path.exists():
        reason = 'is empty' if not text else 'is a folder' if path.is_dir() else 'does not exist'
        raise _UnusableError(
            f"expected a URDF file, got '{text}', which {reason} (in {Path.cwd()})"
        )
    if path.is_file():
        return path
    # A pipe with a path, as from <(xacro arm.urdf.xacro) in a shell. One byte above the limit is
    # enough for the reader to refuse the text.
    with path.open('rb') as stream:
        return stream.read(MAX_BYTES + 1)


def _show(report: Report, options: argparse.Namespace) -> None:
    if options.json:
        json.dump(to_json(report), sys.stdout, indent=1, allow_nan=False)
        print()
    else:
        try:
            from .terminal import print_report
        except ModuleNotFoundError as error:
            raise _UnusableError(
                f'the report in a terminal needs the Python package rich ({error}): '
                'pip install rich; or use --json'
            ) from error
        print_report(report)
    sys.stdout.flush()


def _write_html(report: Report, path: str) -> None:
    try:
        from .html import write_html

        write_html(report, path)
    except ModuleNotFoundError as error:
        raise _UnusableError(
            f'--html needs the Python packages jinja2 and plotly ({error}): '
            'pip install jinja2 plotly'
        ) from error
    print(f'wrote {path}', file=sys.stderr)


def _message(error: Exception, options: argparse.Namespace) -> str:
    if isinstance(error, RobotDescriptionError):
        name = 'standard input' if options.robot == '-' else f"'{options.robot}'"
        return f'{name} cannot be read as a URDF: ' + '; '.join(error.problems)
    if isinstance(error, ArgumentError):
        return f'{error}; see --help'
    return str(error)


if __name__ == '__main__':
    sys.exit(main())
