"""The process around the node: signals that ask it to end, and an output that never blocks."""

from __future__ import annotations

from collections.abc import Callable
import os
import signal
import socket
import sys
import threading
import time
from types import FrameType

# Signals closer together than this count as one: a terminal and `ros2 launch` both send SIGINT, s.
SAME_SIGNAL = 0.5
# Longest wait at the end for a terminal or a pipe that is not read, s.
CLOSE_WITHIN = 0.5
STOPPING_SIGNALS = ('SIGINT', 'SIGTERM', 'SIGHUP', 'SIGQUIT')


class Signals:
    """
    Counts the signals that ask the process to end.

    The first one stops the output by its ramp, the second one shortens the stop, the third one
    ends the process at once.

    Attributes
    ----------
    name : str
        Of the first signal, '' until it arrives.
    count : int
        Signals so far, without those that followed another one within SAME_SIGNAL.

    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        """
        Handle the signals from now on, except a SIGHUP that is ignored already (nohup).

        Parameters
        ----------
        clock : callable() -> float
            Steady, s.

        """
        self.name, self.count = '', 0
        self._clock = clock
        self._last = -SAME_SIGNAL
        self._has_started = False
        for name in STOPPING_SIGNALS:
            number = getattr(signal, name, None)  # not every system has all of them
            if number is None:
                continue
            # Shells ignore SIGINT in background jobs; here it must stop the arm all the same.
            if name != 'SIGHUP' or signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._received)

    def call(self, wake: Callable[[], object]) -> None:
        """
        Call a function from a separate thread as soon as a signal arrives.

        A signal does not end a wait inside rclpy, and Python runs no handler before its end.

        Parameters
        ----------
        wake : callable()
            Ends the wait.

        """
        self._has_started = True
        reader, writer = socket.socketpair()
        writer.setblocking(False)
        signal.set_wakeup_fd(writer.fileno())

        def watch() -> None:
            while reader.recv(1):
                try:
                    wake()
                except Exception:  # the node has been destroyed: there is no wait to end
                    return

        threading.Thread(target=watch, name='signals', daemon=True).start()
        self._ends = reader, writer  # open for the life of the process

    def _received(self, number: int, frame: FrameType | None) -> None:
        now = self._clock()
        if self.count and now - self._last < SAME_SIGNAL:
            return
        self._last = now
        self.count += 1
        self.name = self.name or signal.Signals(number).name
        if self.count > 1 and not self._has_started:
            sys.exit(0)  # no effort has been sent yet
        if self.count > 2:
            # The user insists, whatever state the loop is in. The effort may stay in force.
            sys.exit(1)


class UnblockedOutput:
    """
    Replaces a file descriptor by one that drops output instead of blocking.

    A terminal that is paused by Ctrl-S, or a pipe whose reader has stopped, blocks the process in
    its next log line, and with it the arm.

    """

    def __init__(self, descriptor: int) -> None:
        """
        Replace a file descriptor by a pipe; a thread copies the pipe to the original.

        Parameters
        ----------
        descriptor : int
            1 or 2.

        """
        self._descriptor = descriptor
        self._original = os.dup(descriptor)
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        os.dup2(writer, descriptor)
        os.close(writer)
        self._thread = threading.Thread(
            target=self._copy, args=(reader,), daemon=True, name=f'output {descriptor}'
        )
        self._thread.start()

    def close(self) -> None:
        """Restore the original, and wait up to CLOSE_WITHIN for the thread to copy the rest."""
        os.dup2(self._original, self._descriptor)  # closes the only writing end of the pipe
        self._thread.join(CLOSE_WITHIN)

    def _copy(self, reader: int) -> None:
        while data := os.read(reader, 65536):
            try:
                os.write(self._original, data)
            except OSError:  # the terminal has been closed
                pass
