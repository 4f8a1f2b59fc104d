"""The verdict: clean figures are clean, and every kind of loss is said."""

from collections import Counter
import io
from types import SimpleNamespace

import pytest
from rich.console import Console
from soak.command_judge import CommandJudge
from soak.latency import Latency
from soak.message_accounting import Books
from soak.report import failures, MEMORY, print_report
from soak.soak import Tally


@pytest.fixture
def soak():
    """Return a soak in which all went well."""
    vitals = {'memory': 200.0, 'files': 20, 'threads': 17}
    latency = Latency()
    latency.values.extend([0.001, 0.002, 0.004])
    return SimpleNamespace(
        tallies={'nan': Tally(3, 3), 'flood': Tally()},
        books=Books(),
        latency=latency,
        before=dict(vitals),
        after=dict(vitals),
        rejected=Counter({'stamp': 7}),
        duration=600.0,
    )


@pytest.fixture
def client():
    """Return a client that has seen all 10 commands of the node."""
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


def break_fault(soak, client):
    soak.tallies['nan'].failures.append('expected FAULT, got ACTIVE')


def break_command(soak, client):
    client.judge.command(1.0, [2.0])
    client.judge.settle()


def break_books(soak, client):
    soak.books.missing = 1


def break_surplus(soak, client):
    soak.books.surplus = 1


def break_answers(soak, client):
    soak.books.unanswered = 1


def break_count(soak, client):
    client.judge.lost = 0


def break_memory(soak, client):
    soak.after['memory'] += MEMORY + 0.1


def break_files(soak, client):
    soak.after['files'] += 1


@pytest.mark.parametrize(
    'damage, sentence',
    [
        (break_fault, 'nan: expected FAULT, got ACTIVE'),
        (break_command, 'command at 1.000000: expected silence'),
        (break_books, 'does not account for 1'),
        (break_surplus, 'counts 1 too many'),
        (break_answers, '1 had no command'),
        (break_count, 'published 10 commands, got 9 and missed 0'),
        (break_memory, 'grew from 200.0 to 208.1 MB'),
        (break_files, 'had 20 files and has 21 now'),
    ],
)
def test_whatever_is_lost_leaked_or_wrong_is_said(soak, client, damage, sentence):
    damage(soak, client)
    assert any(sentence in failure for failure in failures(soak, client))


def test_a_run_in_which_not_every_fault_came_judges_no_leak(soak, client):
    soak.before = {}
    soak.after['memory'] = 1e4
    assert failures(soak, client) == []
