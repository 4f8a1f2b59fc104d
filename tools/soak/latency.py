"""How long a joint state took to become a command, by the clocks of those who wrote them."""

from array import array
import heapq
import math

import numpy as np

# States that may be on their way at a time.
REMEMBERED = 5000


class Latency:
    """
    Pairs every command with the state that caused it.

    A command has no stamp. But the node answers a state twice, first by the command and then,
    from the same callback, on ~/gravity_torque with the stamp of the state: so the last command
    written before an answer belongs to it. All times are those of the writers, s.

    Attributes
    ----------
    values : array of float
        From the state written to its command written, s.

    """

    def __init__(self):
        """Know of nothing yet."""
        self.values = array('d')
        self._pending = []
        self._count = 0
        self._sent = {}
        self._command = -math.inf
        self._is_active = False

    def sent(self, time, stamp):
        """Take a joint state with its stamp, ns."""
        self._take(time, 'sent', stamp)

    def command(self, time):
        """Take a command."""
        self._take(time, 'command', None)

    def answer(self, time, stamp):
        """Take a gravity torque with its stamp, ns."""
        self._take(time, 'answer', stamp)

    def state(self, time, name):
        """Take a state of the output: only while it is ACTIVE a command answers every state."""
        self._take(time, 'state', name)

    def _take(self, time, kind, content):
        self._count += 1
        heapq.heappush(self._pending, (time, self._count, kind, content))

    def settle(self, until=math.inf):
        """Look at what was written up to a time, s; all of it must have arrived."""
        while self._pending and self._pending[0][0] <= until:
            time, _, kind, content = heapq.heappop(self._pending)
            getattr(self, f'_on_{kind}')(time, content)

    def quantile(self, share):
        """Return the latency that a share of all does not exceed, s; NaN if there is none."""
        return float(np.quantile(self.values, share)) if self.values else math.nan

    def _on_sent(self, time, stamp):
        self._sent.setdefault(stamp, time)
        if len(self._sent) > REMEMBERED:
            del self._sent[next(iter(self._sent))]

    def _on_command(self, time, content):
        self._command = time

    def _on_answer(self, time, stamp):
        sent = self._sent.pop(stamp, math.inf)
        if self._is_active and sent <= self._command:
            self.values.append(self._command - sent)
        self._command = -math.inf

    def _on_state(self, time, name):
        self._is_active = name == 'ACTIVE'
