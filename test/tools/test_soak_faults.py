"""Faults whose detection needs a running node."""

from types import SimpleNamespace

from soak.faults import FAULTS, STATE_TIMEOUT


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
