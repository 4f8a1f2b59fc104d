"""Child processes of the demo: always ended, with logs."""

import signal

from dynamics_node.demo.processes import DemoError, Processes
import pytest


@pytest.fixture(autouse=True)
def sigint_is_heard():
    """Restore SIGINT: where the tests run in the background, children would ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_processes_end_with_the_context_and_get_ctrl_c_first():
    with Processes() as processes:
        processes.start('server', 'http.server', '0', '--bind', '127.0.0.1')
        child = processes._running['server']
        while not processes.lines('server') and child.poll() is None:
            pass
        processes.check()
    assert child.returncode == 0


def test_a_process_that_ends_by_itself_is_a_failure_with_its_log():
    with Processes() as processes:
        processes.start('helper', 'no_such_module_at_all')
        processes._running['helper'].wait()
        with pytest.raises(DemoError, match='helper ended by itself with exit code 1'):
            processes.check()
        assert 'No module named' in processes.tails()['helper'][-1]
