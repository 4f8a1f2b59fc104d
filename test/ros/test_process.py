"""The process: signals that end it, output that never blocks it, and its options."""

import subprocess
import sys
import time

from dynamics_node.ros.support.command_line import parse
import pytest

CODE = """
import os, signal, threading, time
from dynamics_node.ros.support.process import Signals
signals = Signals()
woken = threading.Event()
def wake():
    woken.set()
    {wake}
signals.call(wake)
threading.Timer(0.2, os.kill, (os.getpid(), signal.SIG{name})).start()
woken.wait()
while not signals.name:
    time.sleep(0.001)
print(signals.name)
{more}
"""
# The tests may run under nohup, which ignores SIGHUP.
DEFAULT = 'import signal; signal.signal(signal.SIGHUP, signal.SIG_DFL)'
SEND = 'os.kill(os.getpid(), signal.SIGTERM); time.sleep({}); '


def run(name, more='', before=DEFAULT, wake='pass'):
    """Run a process that receives a signal; return exit code, output and errors."""
    process = subprocess.run(
        [sys.executable, '-c', before + CODE.format(name=name, more=more, wake=wake)],
        capture_output=True,
        text=True,
        timeout=30.0,
        check=False,
    )
    return process.returncode, process.stdout, process.stderr


@pytest.mark.parametrize('name', ['INT', 'TERM', 'HUP', 'QUIT'])
def test_the_first_signal_is_recorded_and_ends_the_wait(name):
    begin = time.monotonic()
    assert run(name) == (0, f'SIG{name}\n', '')
    assert time.monotonic() - begin < 10.0


def test_signals_a_few_milliseconds_apart_count_as_one():
    more = SEND.format(0.01) * 5 + 'print(signals.count)'
    assert run('INT', more)[:2] == (0, 'SIGINT\n1\n')


def test_a_second_signal_is_counted_and_the_third_ends_the_process():
    more = 'time.sleep(0.6); ' + SEND.format(0.6) + 'print(signals.count); ' + SEND.format(60)
    assert run('INT', more) == (1, 'SIGINT\n2\n', '')


def test_a_terminal_that_closes_is_ignored_under_nohup():
    more = 'print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN)'
    assert run('TERM', more, DEFAULT.replace('DFL', 'IGN'))[1] == 'SIGTERM\nTrue\n'


def test_sigint_counts_in_a_background_job_where_shells_ignore_it():
    assert run('INT', '', 'import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)')[1] == (
        'SIGINT\n'
    )


def test_a_wait_that_no_longer_exists_is_no_error():
    wake = "raise RuntimeError('destroyed')"
    assert run('INT', 'time.sleep(0.1)', wake=wake) == (0, 'SIGINT\n', '')


OUTPUT = """
import os
from dynamics_node.ros.support.process import UnblockedOutput
output = UnblockedOutput(2)
{write}
output.close()
{after}
"""


def test_an_unread_log_does_not_block_the_process():
    write = """
for _ in range(3000):
    try:
        os.write(2, b"x" * 1000)
    except BlockingIOError:
        pass
"""
    code = OUTPUT.format(write=write, after='print("done", flush=True)')
    process = subprocess.Popen(
        [sys.executable, '-c', code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    with process:
        assert process.stdout.readline() == b'done\n'  # while stderr is not read
        log = process.stderr.read()
    assert process.returncode == 0
    assert len(log) > 60_000


def test_logged_output_arrives():
    code = OUTPUT.format(write='os.write(2, b"first\\n")', after='os.write(2, b"second\\n")')
    run = subprocess.run([sys.executable, '-c', code], capture_output=True, check=True)
    assert run.stderr == b'first\nsecond\n'


@pytest.mark.parametrize(
    'arguments, executor, raw_states',
    [
        ('', 'rclpy', True),
        ('--executor events --no-raw-states --ros-args -r __ns:=/a', 'events', False),
        ('--ros-args -p a:=1 -- --executor=events --no-raw-states --other', 'events', False),
    ],
)
def test_the_options_are_read_and_arguments_of_ros_are_ignored(arguments, executor, raw_states):
    options = parse(['node', *arguments.split()])
    assert vars(options) == {'executor': executor, 'raw_states': raw_states}


def test_an_unknown_executor_is_refused(capsys):
    with pytest.raises(SystemExit):
        parse(['node', '--executor', 'fast'])
    assert 'choose from' in capsys.readouterr().err
