"""`Latency`: time from a joint state to its command, by source timestamps."""

from array import array
import heapq
import math

import numpy as np

# States without an answer that are kept.
HISTORY = 5000


class Latency:
    """
    Pairs each command with the state that caused it.

    A command has no stamp. But the node answers a state twice: by the command, and then from the
    same callback on ~/gravity_torque, with the stamp of the state. So the last command before an
    answer belongs to the same state. All times are source timestamps, s.

    Attributes
    ----------
    values : array of float
        From the writing of a state to that of its command, s.

    """

    def __init__(self):
        self.values = array('d')
        self._pending = []
        self._count = 0
        self._sent = {}
        self._command = -math.inf
        self._is_active = False

    def sent(self, time, stamp):
        """Add a joint state with its stamp, ns."""
        self._take(time, 'sent', stamp)

    def command(self, time):
        """Add a command."""
        self._take(time, 'command', None)

    def answer(self, time, stamp):
        """Add a gravity torque with its stamp, ns."""
        self._take(time, 'answer', stamp)

    def state(self, time, name):
        """Add an output state: only while ACTIVE a command answers every joint state."""
        self._take(time, 'state', name)

    def _take(self, time, kind, content):
        self._count += 1
        heapq.heappush(self._pending, (time, self._count, kind, content))

    def settle(self, until=math.inf):
        """Evaluate messages written up to a time, s; all of them have arrived."""
        while self._pending and self._pending[0][0] <= until:
            time, _, kind, content = heapq.heappop(self._pending)
            getattr(self, f'_on_{kind}')(time, content)

    def quantile(self, share):
        """Return a quantile of the latency, s; NaN without values."""
        return float(np.quantile(self.values, share)) if self.values else math.nan

    def _on_sent(self, time, stamp):
        self._sent.setdefault(stamp, time)
        if len(self._sent) > HISTORY:
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
