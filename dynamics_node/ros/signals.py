"""SIGINT and SIGTERM: noticed from the first moment, acted on when the arm is at rest."""

import signal
import socket
import sys
import threading


class Signals:
    """
    Notes the first signal; the second one ends the process at once.

    Attributes
    ----------
    name : str
        Of the first signal, '' until it comes.

    """

    def __init__(self):
        """Take over both signals."""
        self.name = ''
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._received)

    def call(self, wake):
        """
        Call something as soon as a signal comes, out of a thread of its own.

        A wait inside rclpy does not end by a signal, and Python notices none before it ends. To
        look every tenth of a second instead would cost a timer in every wait.

        Parameters
        ----------
        wake : callable()
            Ends the wait.

        """
        reader, writer = socket.socketpair()
        writer.setblocking(False)
        signal.set_wakeup_fd(writer.fileno())

        def watch():
            while reader.recv(1):
                try:
                    wake()
                except Exception:  # the node is gone already: nothing waits any more
                    return
        threading.Thread(target=watch, name='signals', daemon=True).start()
        self._ends = reader, writer  # open for the life of the process

    def _received(self, number, frame):
        if self.name:
            sys.exit(0)
        self.name = signal.Signals(number).name
