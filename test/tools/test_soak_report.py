"""The verdict of a soak: every kind of loss is reported."""

from collections import Counter
import io
from types import SimpleNamespace

import pytest
from rich.console import Console
from soak.command_judge import CommandJudge
from soak.latency import Latency
from soak.message_accounting import MessageAccounting
from soak.report import failures, MAX_GROWTH, print_report
from soak.soak import Tally


@pytest.fixture
def soak():
    """Return a successful soak."""
    vitals = {'memory': 200.0, 'files': 20, 'threads': 17}
    latency = Latency()
    latency.values.extend([0.001, 0.002, 0.004])
    return SimpleNamespace(
        tallies={'nan': Tally(3, 3), 'flood': Tally()},
        accounting=MessageAccounting(),
        latency=latency,
        before=dict(vitals),
        after=dict(vitals),
        rejected=Counter({'stamp': 7}),
        duration=600.0,
    )


@pytest.fixture
def client():
    """Return a client that has received all 10 commands of the node."""
    judge = CommandJudge([1.0], [1.0])
    judge.commands, judge.lost = 9, 1
    diagnostics = {
        'output': {'commands': '10'},
        'joint states': {'accepted': '55', 'skipped': '4'},
    }
    return SimpleNamespace(
        judge=judge,
        diagnostics=diagnostics,
        number=lambda part, key: float(diagnostics[part][key]),
    )


def test_a_clean_soak_has_no_failures_and_prints_its_figures(soak, client):
    assert failures(soak, client) == []
    output = io.StringIO()
    print_report(Console(file=output, width=100), soak, client, 5)
    text = output.getvalue()
    assert '600 s of soak, seed 5' in text
    for row, value in (
        ('joint states accepted', '55'),
        ('rejected: stamp', '7'),
        ('state to command, worst', '4.00 ms'),
        ('memory of the node', '200.0 -> 200.0 MB'),
        ('nan', '3'),
    ):
        assert any(row in line and value in line for line in text.splitlines()), row
    assert 'flood' not in text


def send_a_command_while_off(soak, client):
    client.judge.command(1.0, [2.0])
    client.judge.settle()


def add(part, key, value):
    """Return a function that adds to a count of the soak."""

    def damage(soak, client):
        count = getattr(soak, part)
        if isinstance(count, dict):
            count[key] += value
        else:
            setattr(count, key, getattr(count, key) + value)

    return damage


@pytest.mark.parametrize(
    'damage, sentence',
    [
        (
            lambda soak, _: soak.tallies['nan'].failures.append('expected FAULT, got ACTIVE'),
            'nan: expected FAULT, got ACTIVE',
        ),
        (send_a_command_while_off, 'command at 1.000000: expected silence'),
        (add('accounting', 'missing', 1), 'does not account for 1'),
        (add('accounting', 'surplus', 1), 'counts 1 too many'),
        (add('accounting', 'unanswered', 1), '1 had no command'),
        (
            lambda _, client: setattr(client.judge, 'lost', 0),
            'published 10 commands, got 9 and missed 0',
        ),
        (add('after', 'memory', MAX_GROWTH + 0.1), 'grew from 200.0 to 208.1 MB'),
        (add('after', 'files', 1), 'had 20 files and has 21 now'),
    ],
)
def test_losses_leaks_and_errors_are_reported(soak, client, damage, sentence):
    damage(soak, client)
    assert any(sentence in failure for failure in failures(soak, client))


def test_a_run_without_every_fault_judges_no_leak(soak, client):
    soak.before = {}
    soak.after['memory'] = 1e4
    assert failures(soak, client) == []
