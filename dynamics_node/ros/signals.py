"""SIGINT, SIGTERM, SIGHUP and SIGQUIT: noticed from the first moment, acted on in the loop."""

import signal
import socket
import sys
import threading
import time

# Signals closer together than this count as one: a terminal and `ros2 launch` both send SIGINT, s.
SAME_SIGNAL = 0.5
STOPPING_SIGNALS = ('SIGINT', 'SIGTERM', 'SIGHUP', 'SIGQUIT')


class Signals:
    """
    Counts the signals that ask the process to end.

    The first one stops the output by its ramp, the second one hastens the stop, the third one
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
        Call something as soon as a signal comes, from a thread of its own.

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
                except Exception:  # the node is gone already: no wait is left to end
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
            # Whatever the loop is doing: the user insists. The effort may stay in force.
            sys.exit(1)
