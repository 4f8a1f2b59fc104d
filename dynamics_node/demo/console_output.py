"""Tables and logs that the demo prints."""

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from .story import FALL_TIME, MAX_DRIFT, MIN_FALL, MIN_PUSH, Outcome, WATCH_TIME


def print_mass_matrix(console: Console, names: list[str], matrix: np.ndarray) -> None:
    """Print a mass matrix, shape (n, n), with the names of the joints."""
    # Units without brackets, which are markup.
    console.print(
        '\nMass matrix D(q) at the start pose in kg m², kg m and kg, '
        'from /dynamics_node/get_mass_matrix:'
    )
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 0, 0, 1))
    table.add_column('joint', no_wrap=True)
    for column in range(len(names)):
        table.add_column(str(column + 1), justify='right', no_wrap=True)
    for row, name in enumerate(names):
        table.add_row(f'{row + 1} {name}', *map(_entry, matrix[row]))
    console.print(table)


def print_outcome(console: Console, outcome: Outcome) -> None:
    """Print measured and expected displacements."""
    console.print('\nLargest joint displacement:')
    table = Table(box=box.SIMPLE_HEAD)
    for heading in ('', 'measured', 'expected', 'joint'):
        table.add_column(heading, justify='right' if heading == 'measured' else 'left')
    small = f'< {MAX_DRIFT:.0f}°'
    for label, way, expected in (
        (f'fall in {FALL_TIME:.0f} s, node off', outcome.fall, f'> {MIN_FALL:.0f}°'),
        (f'drift in {outcome.hold:.0f} s, node on', outcome.drift, small),
        ('moved by the push', outcome.pushed, f'> {MIN_PUSH:.0f}°'),
        (f'drift in {WATCH_TIME:.0f} s there', outcome.drift_after_push, small),
    ):
        table.add_row(label, f'{outcome.largest(way):.3f}°', expected, _softest(outcome, way))
    console.print(table)
    if not outcome.recording.turning.all():
        console.print(_sliding(outcome))


def print_logs(console: Console, tails: dict[str, list[str]]) -> None:
    """Print the last lines of each log."""
    for name, lines in tails.items():
        console.print(f'--- last lines of {name} ---', style='bold')
        console.print('\n'.join(lines) or '(it printed nothing)', markup=False, highlight=False)


def _entry(value: float) -> str:
    """Return a matrix entry as text; a rounded zero has no sign."""
    return f'{round(value, 3) + 0.0:.3f}'


def _softest(outcome: Outcome, way: np.ndarray) -> str:
    """Return the name of the revolute joint that moved most."""
    turning = np.where(outcome.recording.turning, way, -1.0)
    return outcome.recording.names[int(np.argmax(turning))]


def _sliding(outcome: Outcome) -> str:
    """Return a line about prismatic joints, which degrees do not measure."""
    slides = ~outcome.recording.turning
    drift = max(np.max(outcome.drift[slides]), np.max(outcome.drift_after_push[slides]))
    return f'Joints that slide drifted at most {drift:.2f} mm and are not part of the degrees.'
