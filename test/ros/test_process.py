"""A signal ends a wait that Python would not see it in."""

import subprocess
import sys
import time

CODE = """
import os, signal, threading, time
from dynamics_node.ros.support.process import Signals
signals = Signals()
woken = threading.Event()
signals.call(woken.set)
threading.Timer(0.2, os.kill, (os.getpid(), signal.SIG{name})).start()
woken.wait()
while not signals.name:
    time.sleep(0.001)
print(signals.name)
{more}
"""


# Tests may run under nohup, which ignores it.
DEFAULT = 'import signal; signal.signal(signal.SIGHUP, signal.SIG_DFL)'


def run(name, more=''):
    """Run code that gets a signal; return exit code, output and duration."""
    begin = time.monotonic()
    done = subprocess.run(
        [sys.executable, '-c', DEFAULT + CODE.format(name=name, more=more)],
        capture_output=True,
        text=True,
        timeout=30.0,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr, time.monotonic() - begin


def test_the_first_signal_is_noted_and_ends_the_wait():
    for name in ('INT', 'TERM', 'HUP', 'QUIT'):
        code, out, err, duration = run(name)
        assert (code, out, err) == (0, f'SIG{name}\n', '')
        assert duration < 10.0


SEND = 'os.kill(os.getpid(), signal.SIGTERM); time.sleep({}); '


def test_signals_a_few_milliseconds_apart_count_as_one():
    more = SEND.format(0.01) * 5 + 'print(signals.count)'
    assert run('INT', more)[:2] == (0, 'SIGINT\n1\n')


def test_a_second_signal_is_counted_and_the_third_ends_the_process():
    more = 'time.sleep(0.6); ' + SEND.format(0.6) + 'print(signals.count); ' + SEND.format(60)
    code, out, err, _ = run('INT', more)
    assert (code, out, err) == (1, 'SIGINT\n2\n', '')


def test_a_terminal_that_closes_is_ignored_under_nohup():
    code = ('import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n' + CODE).format(
        name='TERM', more='print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN)'
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=30.0, check=False
    )
    assert done.stdout == 'SIGTERM\nTrue\n'


def test_a_wait_that_is_gone_is_no_error():
    code = CODE.replace(
        'signals.call(woken.set)',
        """
def gone():
    woken.set()
    raise RuntimeError('destroyed')
signals.call(gone)""",
    ).format(name='INT', more='time.sleep(0.1)')
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=30.0, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, 'SIGINT\n', '')


def test_sigint_counts_in_a_background_job_where_shells_ignore_it():
    code = ('import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n' + CODE).format(
        name='INT', more=''
    )
    done = subprocess.run(
        [sys.executable, '-c', code], capture_output=True, text=True, timeout=30.0, check=False
    )
    assert done.stdout == 'SIGINT\n'
