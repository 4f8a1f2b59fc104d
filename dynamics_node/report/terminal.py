"""The report in a terminal: tables first, findings and the verdict last, above the prompt."""

from __future__ import annotations

from collections.abc import Iterator
import math

from rich import box
from rich.console import Console, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from .formatting import fixed_vector, sentence, short, short_vector
from .report import GravityLoad, LinkEntry, PayloadEntry, Report

_COLORS = {'problem': 'bold red', 'warning': 'yellow', 'note': 'cyan'}
# Width from which centers of mass and worst positions are shown, characters.
_WIDE = 110
# Largest number of joints whose worst position fits into a line.
_FEW_JOINTS = 9
# Number of massless frames that are named; the others are counted.
_FRAMES = 12


def print_report(report: Report, console: Console | None = None) -> None:
    """
    Print a report.

    Parameters
    ----------
    report : Report
    console : rich.console.Console, optional
        By default standard output, in color if that is a terminal and NO_COLOR is not set.

    """
    console = console or _Console(highlight=False)
    for part in _parts(report, console.width):
        console.print(part)


class _Console(Console):
    # rich handles a closed pipe by ending the program with 1, which means "problem" here. rich
    # calls this method while it handles the BrokenPipeError.

    def on_broken_pipe(self) -> None:
        raise


def _parts(report: Report, width: int) -> Iterator[RenderableType]:
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
        yield from _titled('Links', _link_table(report))
        yield from _massless_frames(report)
    if report.bodies:
        yield from _titled('What each joint moves as one piece', _body_table(report, width))
    if report.joints:
        yield from _titled('Joints', _joint_table(report))
        yield from _mimic_joints(report)
    if report.joint_names:
        yield from _titled(
            f'Largest gravity torque of each joint ({report.samples} positions, '
            f'seed {report.seed}, then searched for the maximum)',
            _gravity_table(report, width),
        )
        yield from _payload_lines(report)
        yield _conditioning_line(report)
    yield from _findings(report)
    yield Text()
    yield _summary(report)


def _titled(title: str, table: Table) -> Iterator[RenderableType]:
    yield Text(f'\n{title}', style='bold')
    yield table


def _table(*columns: tuple[str, str]) -> Table:
    # Columns are pairs of heading and justification.
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, show_edge=False)
    for heading, justify in columns:
        table.add_column(
            Text(heading), justify='right' if justify == 'right' else 'left', overflow='fold'
        )
    return table


def _link_table(report: Report) -> Table:
    # Links with an <inertial>, or with a shape but without one.
    table = _table(
        ('link', 'left'),
        ('kg', 'right'),
        ('center of mass, m', 'right'),
        ('principal moments, kg m²', 'right'),
        ('', 'left'),
    )
    for link in report.links:
        if (link.has_inertial or link.has_shape) and not _is_frame(link):
            table.add_row(
                Text(link.name),
                short(link.mass),
                fixed_vector(link.com),
                short_vector(link.principal_moments),
                Text(_remark(link, report), style='red' if not link.is_physical else 'dim'),
            )
    return table


def _remark(link: LinkEntry, report: Report) -> str:
    if link.mass == 0.0:
        return 'massless'
    if not link.is_physical:
        return 'not physical'
    if link.carrier is None and report.verdict == 'usable':
        return 'on the base'
    return ''


def _is_frame(link: LinkEntry) -> bool:
    # A link with an unreadable mass, NaN, is not a frame.
    return link.mass == 0.0 and not link.has_shape


def _massless_frames(report: Report) -> Iterator[Text]:
    frames = [link.name for link in report.links if _is_frame(link)]
    if frames:
        more = f' and {len(frames) - _FRAMES} more' if len(frames) > _FRAMES else ''
        yield Text(f'frames without mass: {", ".join(frames[:_FRAMES])}{more}', style='dim')


def _body_table(report: Report, width: int) -> Table:
    # Each joint with its link and what fixed joints attach to that.
    is_wide = width >= _WIDE
    table = _table(
        ('joint', 'left'),
        ('its link + what is fixed to it', 'left'),
        ('kg', 'right'),
        *(
            [('center of mass, m', 'right'), ('principal moments, kg m²', 'right')]
            if is_wide
            else []
        ),
    )
    frames = {link.name for link in report.links if _is_frame(link)}
    for body in report.bodies:
        lumped = [name for name in body.lumped if name not in frames]
        cells = [fixed_vector(body.com), short_vector(body.principal_moments)] if is_wide else []
        table.add_row(
            Text(body.joint),
            Text(' + '.join([body.link, *lumped])),
            Text(short(body.mass), style='' if body.is_physical else 'red'),
            *cells,
        )
    return table


def _joint_table(report: Report) -> Table:
    numbers = ('from', 'to', 'velocity', 'effort', 'damping', 'friction')
    table = _table(
        ('joint', 'left'), ('kind', 'left'), *((heading, 'right') for heading in numbers)
    )
    for joint in report.joints:
        table.add_row(
            Text(joint.name),
            joint.kind,
            short(joint.lower),
            short(joint.upper),
            short(joint.velocity),
            short(joint.effort),
            short(joint.damping),
            short(joint.friction),
        )
    return table


def _mimic_joints(report: Report) -> Iterator[Text]:
    equations = [
        f'{joint.name} = {joint.multiplier:g} {joint.mimics}'
        + (f' + {joint.offset:g}' if joint.offset else '')
        for joint in report.joints
        if joint.mimics is not None
    ]
    if equations:
        yield Text(f'mimic joints: {", ".join(equations)}', style='dim')


def _gravity_table(report: Report, width: int) -> Table:
    # The largest gravity torques beside the effort limits.
    shows_position = width >= _WIDE and len(report.joint_names) <= _FEW_JOINTS
    table = _table(
        ('joint', 'left'),
        ('largest', 'right'),
        ('', 'left'),
        ('median', 'right'),
        ('limit', 'right'),
        ('share', 'right'),
        ('kg left', 'right'),
        *([('at', 'left')] if shows_position else []),
    )
    for joint in report.joints:
        load = joint.gravity
        if load is None:
            continue
        share = '-' if math.isnan(load.share) else f'{100.0 * load.share:.0f} %'
        table.add_row(
            Text(joint.name),
            short(load.worst),
            joint.effort_unit,
            short(load.quantile(0.5)),
            short(joint.effort),
            Text(share, style=_share_style(load.share)),
            short(load.payload_left),
            *([_worst_position(load)] if shows_position else []),
        )
    return table


def _worst_position(load: GravityLoad) -> str:
    return '' if load.worst == 0.0 else fixed_vector(load.position, 2)


def _share_style(share: float) -> str:
    if math.isnan(share):
        return ''
    return 'bold red' if share > 1.0 else 'yellow' if share > 0.8 else 'green'


def _payload_lines(report: Report) -> Iterator[Text]:
    payload = report.payload
    assert payload is not None  # it is there with the joints
    place = f"'{payload.link}'"
    if any(payload.point):
        place += f' at ({", ".join(f"{value:g}" for value in payload.point)}) m'
    yield Text(
        f'\n"kg left": a point mass at {place}, in that position, until that joint is at '
        'its limit',
        style='dim',
    )
    if payload.is_guessed:
        yield Text(
            f'{place} is a guess, the end of the heaviest chain before its fingers; '
            '--payload-link LINK chooses another',
            style='dim',
        )
    if report.moving_mass > 0.0:
        yield _capacity(payload, place)
    else:
        yield Text('What it can hold is not known: the moving links have no mass')
    if payload.unlimited_joints:
        yield Text(
            f'not counted, without an effort limit: {", ".join(payload.unlimited_joints)}',
            style='yellow',
        )


def _capacity(payload: PayloadEntry, place: str) -> Text:
    if not payload.is_moved:
        return Text(f'No joint moves {place}: any payload is held')
    if payload.limiting_joint is None:
        return Text(f'No effort limit restricts a payload at {place}')
    text = Text('It can hold ')
    text.append(f'{short(payload.everywhere)} kg', style='bold')
    text.append(f" at {place} everywhere ('{payload.limiting_joint}' allows no more)")
    return text


def _conditioning_line(report: Report) -> Text:
    conditioning = report.conditioning
    assert conditioning is not None  # it is there with the joints
    mixed = (
        '; joints slide and turn, so it depends on the units, m and rad'
        if conditioning.has_mixed_units
        else ''
    )
    worst = short(conditioning.worst)
    if not conditioning.is_positive_definite:
        worst = 'none, it is singular'
    return Text(
        f'Condition number of the mass matrix: median {short(conditioning.median)}, worst '
        f"{worst} ('{conditioning.weakest_joint}' has the least inertia there; "
        f'{conditioning.samples} positions){mixed}'
    )


def _findings(report: Report) -> Iterator[RenderableType]:
    # Notes first, problems last: next to the verdict.
    if report.findings:
        yield Text('\nFindings', style='bold')
    for finding in reversed(report.findings):
        text = Text()
        text.append(finding.severity, style=_COLORS[finding.severity])
        text.append(f' [{finding.kind}] ', style='dim')
        text.append(sentence(finding.what))
        yield text
        if finding.effect:
            yield Padding(Text.assemble(('effect: ', 'dim'), finding.effect), (0, 0, 0, 2))
        if finding.advice:
            yield Padding(Text.assemble(('to do: ', 'dim'), finding.advice), (0, 0, 0, 2))


def _summary(report: Report) -> Text:
    counts = report.counts
    text = ', '.join(
        f'{count} {severity}{"" if count == 1 else "s"}' for severity, count in counts.items()
    )
    worst = next((severity for severity, count in counts.items() if count), None)
    verdict = 'usable'
    if report.verdict == 'refused':
        verdict = 'refused: RobotModel and the node do not take it'
    elif worst == 'problem':
        verdict = 'fix before use'
    style = 'bold green' if worst in (None, 'note') else _COLORS[worst or 'note']
    return Text(f'{report.robot}: {verdict}; {text}', style=style)
