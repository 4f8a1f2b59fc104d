"""The table and the verdict of a soak."""

import math

from rich import box
from rich.table import Table

# Growth of memory since the warm-up that is no leak, MB.
MAX_GROWTH = 8.0


def failures(soak, client):
    """
    Return one sentence per failed expectation.

    Parameters
    ----------
    soak : Soak
        After its run.
    client : ArmClient

    Returns
    -------
    list of str

    """
    judge, accounting = client.judge, soak.accounting
    sentences = [
        f'{name}: {failure}' for name, tally in soak.tallies.items() for failure in tally.failures
    ]
    sentences += [f'command {text}' for text in judge.violations]
    if judge.count > len(judge.violations):
        sentences.append(f'... and {judge.count - len(judge.violations)} more wrong commands')
    if accounting.missing or accounting.surplus:
        sentences.append(
            f'of {accounting.sent} joint states, the node does not account for '
            f'{accounting.missing} and counts {accounting.surplus} too many'
        )
    if accounting.unanswered:
        sentences.append(
            f'of {accounting.active} joint states accepted while ACTIVE, {accounting.unanswered} '
            'had no command, or several'
        )
    published = client.number('output', 'commands')
    if judge.commands + judge.lost != published:
        sentences.append(
            f'the node says that it has published {published:.0f} commands, got '
            f'{judge.commands} and missed {judge.lost}'
        )
    if soak.before:
        if soak.after['memory'] - soak.before['memory'] > MAX_GROWTH:
            sentences.append(
                f'the memory of the node grew from {soak.before["memory"]:.1f} to '
                f'{soak.after["memory"]:.1f} MB, expected at most {MAX_GROWTH:g} more'
            )
        sentences += [
            f'the node had {soak.before[what]} {what} and has {soak.after[what]} now'
            for what in ('files', 'threads')
            if soak.after[what] > soak.before[what]
        ]
    return sentences


def print_report(console, soak, client, seed):
    """Print the figures of a soak on a rich.console.Console."""
    table = Table(
        box=box.SIMPLE_HEAD,
        title=f'{soak.duration:.0f} s of soak, seed {seed}',
        title_justify='left',
    )
    table.add_column('', no_wrap=True)
    table.add_column('', justify='right', no_wrap=True)
    for label, value in _figures(soak, client):
        table.add_row(label, value)
    console.print(table)
    console.print(_faults(soak))


def _figures(soak, client):
    judge, accounting, latency = client.judge, soak.accounting, soak.latency
    states = client.diagnostics['joint states']
    yield 'joint states accepted', states['accepted']
    for kind, count in sorted(soak.rejected.items()):
        yield f'  rejected: {kind}', str(count)
    yield '  skipped', states['skipped']
    yield 'joint states sent, in accounted periods', str(accounting.sent)
    yield '  missing or counted twice', f'{accounting.missing} / {accounting.surplus}'
    yield 'accepted while ACTIVE, accounted', str(accounting.active)
    yield '  without a command', str(accounting.unanswered)
    yield 'commands', client.diagnostics['output']['commands']
    yield '  judged, not seen', f'{judge.commands} / {judge.lost}'
    yield '  wrong', str(judge.count)
    for label, share in (('median', 0.5), ('p99', 0.99), ('worst', 1.0)):
        value = latency.quantile(share)
        yield (f'state to command, {label}', '-' if math.isnan(value) else f'{1e3 * value:.2f} ms')
    for what, unit in (('memory', ' MB'), ('files', ''), ('threads', '')):
        before, after = (vitals.get(what, math.nan) for vitals in (soak.before, soak.after))
        digits = 1 if what == 'memory' else 0
        earlier = '' if math.isnan(before) else f'{before:.{digits}f} -> '
        yield f'{what} of the node', f'{earlier}{after:.{digits}f}{unit}'


def _faults(soak):
    table = Table(box=box.SIMPLE_HEAD)
    table.add_column('fault', no_wrap=True)
    table.add_column('injected', justify='right')
    table.add_column('survived', justify='right')
    table.add_column('link paused by itself', justify='right')
    for name, tally in soak.tallies.items():
        if tally.injected:
            table.add_row(name, str(tally.injected), str(tally.survived), str(tally.paused))
    table.add_section()
    table.add_row(
        'all',
        *(
            str(sum(getattr(tally, what) for tally in soak.tallies.values()))
            for what in ('injected', 'survived', 'paused')
        ),
    )
    return table
