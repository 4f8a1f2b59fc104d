"""Signals that end the process, and standard output that never blocks it."""

import os
import signal
import socket
import sys
import threading
import time

# Signals within this time count as one, s: a terminal and `ros2 launch` both send SIGINT.
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
        Of the first signal, '' until it comes.
    count : int
        Signals so far, without those that came right after another one.

    """

    def __init__(self, clock=time.monotonic):
        """
        Handle the signals from now on, but SIGHUP only where it is not ignored (nohup).

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
            number = getattr(signal, name, None)  # not all of them exist on every system
            if number is None:
                continue
            # SIGINT is ignored at first in every background job of a shell; it stops the arm.
            if name != 'SIGHUP' or signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._received)

    def call(self, wake):
        """
        Set the function that ends the wait of the main loop when a signal comes.

        A wait inside rclpy does not end by a signal, and Python runs no handler before it ends.

        Parameters
        ----------
        wake : callable()
            Ends the wait.

        """
        self._has_started = True
        reader, writer = socket.socketpair()
        writer.setblocking(False)
        signal.set_wakeup_fd(writer.fileno())

        def watch():
            while reader.recv(1):
                try:
                    wake()
                except Exception:  # the node has been destroyed: no wait is left to end
                    return

        threading.Thread(target=watch, name='signals', daemon=True).start()
        self._ends = reader, writer  # open for the life of the process

    def _received(self, number, frame):
        now = self._clock()
        if self.count and now - self._last < SAME_SIGNAL:
            return
        self._last = now
        self.count += 1
        self.name = self.name or signal.Signals(number).name
        if self.count > 1 and not self._has_started:
            sys.exit(0)  # no effort has been sent yet
        if self.count > 2:
            # The user insists. The effort may stay in force.
            sys.exit(1)


class UnblockedOutput:
    """
    Replaces a file descriptor by a pipe; output that would block is dropped.

    A terminal that is paused by Ctrl-S, or a pipe whose reader has stopped, blocks the process in
    its next log line, and with it the arm.

    """

    def __init__(self, descriptor):
        """
        Replace a file descriptor by a pipe, which a thread empties into the original.

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
            target=self._pass_on, args=(reader,), daemon=True, name=f'output {descriptor}'
        )
        self._thread.start()

    def close(self):
        """Put the original back, and give the thread a moment to pass on the rest."""
        os.dup2(self._original, self._descriptor)  # which closes the pipe's only way in
        self._thread.join(CLOSE_WITHIN)

    def _pass_on(self, reader):
        while data := os.read(reader, 65536):
            try:
                os.write(self._original, data)
            except OSError:  # the terminal is gone
                pass
