"""The tables of the campaigns."""

from rich import box
from rich.markup import escape
from rich.table import Table

_ANSWERS = 12


def print_results(console, results, seed):
    """Print figures, answers and findings of all targets."""
    table = Table(box=box.SIMPLE_HEAD, title=f'seed {seed}')
    table.add_column('')
    for result in results:
        table.add_column(result.name, justify='right')
    for label, figure in _FIGURES:
        table.add_row(label, *map(figure, results))
    console.print(table)
    for result in results:
        console.print(_answers(result))
    for result in results:
        for finding in result.findings.values():
            console.print(
                f'[bold red]FOUND[/] in {result.name}: {escape(finding.error[:300])}\n'
                f'  at {escape(finding.where)}\n  again: make fuzz '
                f"ARGS='--replay {escape(str(finding.path))}'"
            )


def _answers(result):
    table = Table('answers', box=box.SIMPLE_HEAD, title=result.name)
    table.add_column('times', justify='right')
    common = result.answers.most_common()
    for answer, count in common[:_ANSWERS]:
        table.add_row(escape(answer), str(count))
    if len(common) > _ANSWERS:
        table.add_row(
            f'{len(common) - _ANSWERS} other ways',
            str(sum(count for _, count in common[_ANSWERS:])),
        )
    return table


def _taken(result):
    return str(
        sum(count for answer, count in result.answers.items() if answer.startswith('taken'))
    )


def _refused(result):
    return str(
        sum(count for answer, count in result.answers.items() if not answer.startswith('taken'))
    )


_FIGURES = (
    ('inputs', lambda result: str(result.inputs)),
    ('taken', _taken),
    ('refused', _refused),
    ('findings', lambda result: str(len(result.findings))),
    ('slowest input, processor', lambda result: f'{result.slowest * 1e3:.0f} ms'),
    ('its size', lambda result: f'{result.slowest_size} bytes'),
    ('slowest input, clock', lambda result: f'{result.longest * 1e3:.0f} ms'),
    ('memory after a tenth', lambda result: f'{result.early_memory:.1f} MB'),
    ('memory at the end', lambda result: f'{result.late_memory:.1f} MB'),
    ('most memory', lambda result: f'{result.peak_memory:.1f} MB'),
    ('duration', lambda result: f'{result.duration:.0f} s'),
)
