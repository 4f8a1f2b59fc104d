"""`python -m dynamics_node.report ROBOT.urdf`: the report in a terminal, as JSON or as a page."""

import json
import os
import sys

from .command_line import parse
from ..errors import ArgumentError, RobotDescriptionError

UNUSABLE = 2


def main(arguments=None):
    """
    Make a report and show it.

    Parameters
    ----------
    arguments : list of str, optional
        Those of the process if not given.

    Returns
    -------
    int
        Exit code: 0, 1 (with --strict: there is a problem or a warning), 2 (nothing to report).

    """
    options = parse(arguments)
    for stream in (sys.stdout, sys.stderr):
        # A terminal without ² and τ shows something else in their place.
        stream.reconfigure(errors='replace')  # type: ignore[union-attr]
    try:
        return _run(options)
    except (RobotDescriptionError, ArgumentError, OSError, _UnusableError) as error:
        print(f'error: {_words(error, options)}', file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        return 130


class _UnusableError(Exception):
    """Says what is missing and what to type."""


def _run(options):
    report = _make(options)
    if options.html is not None:
        _write_html(report, options.html)
    try:
        _show(report, options)
    except BrokenPipeError:
        # Somebody has read enough, say head; that changes nothing about the robot. Python would
        # complain once more when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return int(options.strict and not report.is_clean)


def _show(report, options):
    if options.json:
        from .to_json import to_json

        json.dump(to_json(report), sys.stdout, indent=1, allow_nan=False)
        print()
    else:
        _terminal().print_report(report)
    sys.stdout.flush()


def _make(options):
    # numba takes a second: --help and a misspelled path need not wait for it.
    source = sys.stdin.buffer.read() if options.robot == '-' else _path(options.robot)
    arguments = {
        'gravity': options.gravity,
        'samples': options.samples,
        'seed': options.seed,
        'link': options.payload_link,
        'point': options.payload_point,
    }
    from .make import make_report

    if options.json or not sys.stderr.isatty():
        return make_report(source, **arguments)
    try:
        from .progress import progress_bar
    except ModuleNotFoundError:
        return make_report(source, **arguments)
    with progress_bar() as tell:
        return make_report(source, **arguments, progress=tell)


def _path(text):
    from pathlib import Path

    path = Path(text)
    if not text or path.is_dir() or not path.exists():
        what = 'is no name' if not text else 'is a folder' if path.is_dir() else 'does not exist'
        raise _UnusableError(f"expected a URDF file, got '{text}', which {what} (in {Path.cwd()})")
    if path.is_file():
        return path
    # A pipe, as of <(xacro arm.urdf.xacro) in a shell. More than anybody takes is not read.
    from ..urdf.input_limits import MAX_BYTES

    with path.open('rb') as stream:
        return stream.read(MAX_BYTES + 1)


def _terminal():
    try:
        from . import terminal
    except ModuleNotFoundError as error:
        raise _UnusableError(
            f'the report in a terminal needs the Python package rich ({error}): '
            'pip install rich; or use --json'
        ) from error
    return terminal


def _write_html(report, path):
    from .html import write_html

    try:
        write_html(report, path)
    except ModuleNotFoundError as error:
        raise _UnusableError(
            f'--html needs the Python package plotly ({error}): pip install plotly'
        ) from error
    print(f'wrote {path}', file=sys.stderr)


def _words(error, options):
    if isinstance(error, RobotDescriptionError):
        name = 'standard input' if options.robot == '-' else f"'{options.robot}'"
        return f'{name} cannot be read as a URDF: ' + '; '.join(error.problems)
    if isinstance(error, ArgumentError):
        return f'{error}; see --help'
    return str(error)


if __name__ == '__main__':
    sys.exit(main())
