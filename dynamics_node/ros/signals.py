"""SIGINT and SIGTERM: noticed from the first moment, acted on when the arm is at rest."""

import signal
import sys


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

    def _received(self, number, frame):
        if self.name:
            sys.exit(0)
        self.name = signal.Signals(number).name
