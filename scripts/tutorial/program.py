"""A program of the tutorial as a process, and its printed lines."""

import os
import queue
import shlex
import signal
import subprocess
import sys
import threading
import time

TIMEOUT = 60.0  # s, of a line: a busy machine takes long to start a node


class Program:
    """A command of the page, started as a user starts it."""

    def __init__(self, command, folder):
        """
        Start the program.

        Parameters
        ----------
        command : str
            Begins with `python`; the current interpreter runs it.
        folder : Path
            Working directory.

        """
        words = shlex.split(command)
        if words[0] != 'python':
            raise ValueError(f'expected a command that begins with python, got {command!r}')
        self._process = subprocess.Popen(
            [sys.executable, *words[1:]],
            cwd=folder,
            stdout=subprocess.PIPE,
            text=True,
            stderr=subprocess.STDOUT,
            env={**os.environ, 'PYTHONUNBUFFERED': '1', 'COLUMNS': '100'},
            start_new_session=True,
        )
        self._lines: queue.Queue[str] = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def next_line(self, fits):
        """
        Return the next line that fits, skipping others.

        Parameters
        ----------
        fits : callable(str) -> bool

        Returns
        -------
        str

        Raises
        ------
        AssertionError
            If none is printed within TIMEOUT; with the skipped lines.

        """
        passed, end = [], time.monotonic() + TIMEOUT
        while (left := end - time.monotonic()) > 0:
            try:
                line = self._lines.get(timeout=left)
            except queue.Empty:
                break
            if fits(line):
                return line
            passed.append(line)
        raise AssertionError('the line did not come; these did:\n' + '\n'.join(passed))

    def stop(self):
        """Send SIGINT, and wait for the end; return the exit code."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
        try:
            code = self._process.wait(timeout=15.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            raise
        self._reader.join()  # the pipe ends with the process
        self._process.stdout.close()
        return code

    def _read(self):
        for line in self._process.stdout:
            self._lines.put(line.rstrip())
