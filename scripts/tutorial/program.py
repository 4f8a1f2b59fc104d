"""A program of the tutorial in a separate process, and the lines that it prints."""

import os
import queue
import shlex
import signal
import subprocess
import sys
import threading
import time

PATIENCE = 60.0  # s; a busy machine starts a node slowly


class Program:
    """A command of the page, started as by a user."""

    def __init__(self, command, folder):
        """
        Start it.

        Parameters
        ----------
        command : str
            Begins with `python`, replaced by the running interpreter.
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
        Return the next fitting line, and skip all others.

        Parameters
        ----------
        fits : callable(str) -> bool

        Returns
        -------
        str

        Raises
        ------
        AssertionError
            If none comes within PATIENCE seconds; lists the skipped lines.

        """
        passed, end = [], time.monotonic() + PATIENCE
        while (left := end - time.monotonic()) > 0:
            try:
                line = self._lines.get(timeout=left)
            except queue.Empty:
                break
            if fits(line):
                return line
            passed.append(line)
        raise AssertionError('expected line missing, got:\n' + '\n'.join(passed))

    def stop(self):
        """Press Ctrl-C, and wait for the end; returns the exit code."""
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
