"""Processes under measurement: started, read out and ended."""

from contextlib import contextmanager
from pathlib import Path
import signal
import subprocess
import sys
import tempfile

ROOT = Path(__file__).parents[1]
# s: long, so that the pause between two slices causes no fault on a slow machine.
STATE_TIMEOUT = 0.5


class Measured:
    """A process and the processor time that it has used."""

    def __init__(self, module, *arguments):
        """Start `python -m module arguments`; its output is kept for `problem`."""
        self._log = tempfile.TemporaryFile('w+')  # noqa: SIM115 (closed by close)
        self._process = subprocess.Popen(
            [sys.executable, '-m', module, *arguments],
            cwd=ROOT,
            stdout=self._log,
            stderr=subprocess.STDOUT,
        )

    def cpu(self):
        """
        Return the processor time of all its threads.

        Returns
        -------
        float
            s, from the scheduler's count in nanoseconds: ticks of 10 ms are too coarse.

        """
        total = 0
        for path in Path(f'/proc/{self._process.pid}/task').glob('*/schedstat'):
            try:
                total += int(path.read_text().split()[0])
            except OSError:  # a thread that has just ended
                continue
        return total * 1e-9

    def is_running(self):
        """Return whether the process is running."""
        return self._process.poll() is None

    def problem(self):
        """Return the end of its output, for an error message."""
        self._log.seek(0)
        return self._log.read()[-4000:]

    def close(self):
        """End the process by SIGINT, or else kill it."""
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._log.close()


@contextmanager
def started(module, *arguments):
    """Run a module as a process during a with block."""
    process = Measured(module, *arguments)
    try:
        yield process
    finally:
        process.close()


def node(urdf, *arguments, namespace='/ours'):
    """Run the node with a robot, its topics in a namespace, during a with block."""
    return started(
        'dynamics_node.ros.main',
        *arguments,
        '--ros-args',
        '-r',
        f'__ns:={namespace}',
        '-p',
        f'robot_description_file:={urdf}',
        '-p',
        f'state_timeout:={STATE_TIMEOUT}',
    )


def relay(kind, namespace='/relay'):
    """Run a bare node of `relay.py`, its topics in a namespace, during a with block."""
    return started('benchmarks.relay', kind, '--ros-args', '-r', f'__ns:={namespace}')
