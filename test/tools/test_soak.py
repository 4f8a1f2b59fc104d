"""A soak of some seconds, and the faults whose detection needs a running node."""

from types import SimpleNamespace

from soak.faults import FAULTS, STATE_TIMEOUT
from support.python_process import run_tool


def test_some_seconds_of_soak_lose_nothing():
    run = run_tool('soak', '--minutes', '0.13', '--seed', '1', timeout=110)
    assert run.returncode == 0, run.stdout + run.stderr
    assert 'Nothing lost, nothing leaked, nothing out of limits.' in run.stdout
    for row in ('joint states accepted', 'state to command, p99', 'memory of the node'):
        assert row in run.stdout


def test_a_stopped_node_continues_before_it_reports_the_fault():
    done = []
    rig = SimpleNamespace(
        during=done.append,
        processes=SimpleNamespace(
            send=lambda process, number: done.append((process, number.name))
        ),
    )
    [fault] = [fault for fault in FAULTS if fault.name == 'node stopped']
    with fault.inflict(rig):
        assert [done[0], done[2]] == [('node', 'SIGSTOP'), ('node', 'SIGCONT')]
        assert done[1] > STATE_TIMEOUT
