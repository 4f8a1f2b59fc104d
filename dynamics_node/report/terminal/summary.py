"""The report in a terminal: tables first, findings and the verdict last, where eyes are."""

from rich.console import Console
from rich.text import Text

from .findings import findings
from .joints import gravity_table, joint_table, mimic_line, payload_lines
from .links import body_table, frames_line, link_table

_COLOURS = {'problem': 'bold red', 'warning': 'yellow', 'note': 'cyan'}


def print_report(report, console=None):
    """
    Print a report.

    Parameters
    ----------
    report : Report
    console : rich.console.Console, optional
        By default standard output, in colors if that is a terminal and NO_COLOR is not set.

    """
    console = console or _Console(highlight=False)
    for part in _parts(report, console.width):
        console.print(part)


class _Console(Console):
    # rich ends the program with 1 where the reader has read enough, which is no exit code of
    # ours; it calls this while it handles the BrokenPipeError.

    def on_broken_pipe(self):
        raise


def _parts(report, width):
    yield Text(f'{report.robot}', style='bold')
    yield Text(
        f'{report.source}' + (f", root link '{report.root}'" if report.root else ''), style='dim'
    )
    x, y, z = report.gravity
    yield Text(
        f'{report.total_mass:.4g} kg, of which joints move {report.moving_mass:.4g} kg; '
        f'{len(report.links)} links, {len(report.joints)} movable joints; gravity '
        f'({x:g}, {y:g}, {z:g}) m/s²'
    )
    if report.links:
        yield from _titled('Links', link_table(report))
        frames = frames_line(report)
        if frames is not None:
            yield frames
    if report.bodies:
        yield from _titled('What each joint moves as one piece', body_table(report, width))
    if report.joints:
        yield from _titled('Joints', joint_table(report))
        mimics = mimic_line(report)
        if mimics is not None:
            yield mimics
    if report.joint_names:
        yield from _titled(
            f'Largest gravity torque of each joint ({report.samples} positions, '
            f'seed {report.seed}, then climbed to the top)',
            gravity_table(report, width),
        )
        yield from payload_lines(report)
    yield from findings(report, _COLOURS)
    yield Text()
    yield _summary(report)


def _titled(title, table):
    yield Text(f'\n{title}', style='bold')
    yield table


def _summary(report):
    counts = report.counts
    said = ', '.join(
        f'{count} {severity}{"" if count == 1 else "s"}' for severity, count in counts.items()
    )
    worst = next((severity for severity, count in counts.items() if count), None)
    verdict = (
        'refused: RobotModel and the node do not take it'
        if report.verdict == 'refused'
        else 'not to be trusted'
        if worst == 'problem'
        else 'usable'
    )
    style = 'bold green' if worst in (None, 'note') else _COLOURS[worst]
    return Text(f'{report.robot}: {verdict}; {said}', style=style)
