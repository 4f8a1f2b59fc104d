"""`CommandJudge`: every command is safe for an arm, by the clock of the writer."""

import heapq
import math

OFF = ('READY', 'FAULT', 'HOLDING')
# Largest relative difference between the system clock of the stamps, under NTP, and the steady
# clock of the node.
CLOCK_SLEW = 5e-4
ROUNDING = 1e-9  # relative to the limits


class CommandJudge:
    """
    Checks a stream of commands: length, finite, within the limits, their steps, silence.

    All times are source timestamps of DDS: delays of the transport have no influence.

    Steps are judged without a tolerance for a busy computer. The node reads its clock before it
    writes a command and, with one thread, after it wrote the previous one. So times `now[i]` must
    exist, each between the writing of command i - 1 and that of command i, with

        |command[i] - command[i - 1]| <= rate_limit * (now[i] - now[i - 1])

    Choosing the earliest possible time for each command finds them if they exist.

    Attributes
    ----------
    last : list of float, length m
        The last command judged, N m or N; zeros before the first.
    commands : int
        Commands judged.
    lost : int
        Commands that did not arrive, by their sequence numbers.
    violations : list of str
        The first MOST violations, as text.
    count : int
        Number of violations.

    """

    MOST = 20

    def __init__(self, limits, rate_limits):
        """
        Expect commands for m joints.

        Parameters
        ----------
        limits : sequence of float, length m
            Largest effort, N m or N.
        rate_limits : sequence of float, length m
            Largest change of effort, N m/s or N/s.

        """
        self._limits = [limit * (1.0 + ROUNDING) for limit in limits]
        self._rate_limits = [rate * (1.0 + CLOCK_SLEW) for rate in rate_limits]
        self._pending = []
        self._received = 0
        self.forget()
        self.commands = self.lost = self.count = 0
        self.violations = []

    def forget(self):
        """Expect a new node: its output is off, and its commands begin at zero."""
        self._is_off, self._why_off = True, 'before any state'
        self.last = [0.0] * len(self._limits)
        self._now = self._written = -math.inf
        self._number = None

    def command(self, time, values, number=None):
        """
        Take a command.

        Parameters
        ----------
        time : float
            When it was written, s.
        values : list of float
            N m or N.
        number : int, optional
            Of this message among those of its writer.

        """
        self._take(time, 'command', (values, number))

    def state(self, time, name):
        """
        Take a state of the output.

        Parameters
        ----------
        time : float
            When it was written, s.
        name : str
            READY, STARTING, ...

        """
        self._take(time, 'state', name)

    def _take(self, time, kind, content):
        self._received += 1
        heapq.heappush(self._pending, (time, self._received, kind, content))

    def settle(self, until=math.inf):
        """
        Judge messages in the order of their writing, up to a time.

        Parameters
        ----------
        until : float
            s; all messages written before have arrived.

        """
        while self._pending and self._pending[0][0] <= until:
            time, _, kind, content = heapq.heappop(self._pending)
            if kind == 'state':
                self._judge_state(time, content)
            else:
                self._judge_command(time, *content)

    def _judge_state(self, time, name):
        if self._is_off and name == 'STARTING':
            # Enabling reads the clock just before it publishes the state.
            self._now = self._written = time
        self._is_off, self._why_off = name in OFF, name

    def _judge_command(self, time, values, number):
        self.commands += 1
        if number is not None:
            self.lost += 0 if self._number is None else number - self._number - 1
            self._number = number
        if self._is_off:
            self._accuse(time, f'expected silence in {self._why_off}, got {values}')
        if len(values) != len(self._limits):
            self._accuse(time, f'expected {len(self._limits)} values, got {len(values)}')
            return
        if not all(map(math.isfinite, values)):
            self._accuse(time, f'expected finite values, got {values}')
            return
        self._judge_limits(time, values)
        self._judge_step(time, values)
        self.last = values

    def _judge_limits(self, time, values):
        for joint, (value, limit) in enumerate(zip(values, self._limits)):
            if abs(value) > limit:
                self._accuse(time, f'joint {joint}: expected at most {limit:.6g}, got {value:.6g}')

    def _judge_step(self, time, values):
        needed, joint = max(
            (abs(value - last) / rate, joint)
            for joint, (value, last, rate) in enumerate(zip(values, self.last, self._rate_limits))
        )
        earliest = max(self._now + needed, self._written)
        if earliest > time + 1e-6:  # s, precision of the stamps
            self._accuse(
                time,
                f'joint {joint}: the step from {self.last[joint]:.6g} to '
                f'{values[joint]:.6g} takes {needed:.6f} s at the rate limit, and '
                f'is {earliest - time:.6f} s too early',
            )
            earliest = time
        self._now, self._written = earliest, time

    def _accuse(self, time, text):
        self.count += 1
        if self.count <= self.MOST:
            self.violations.append(f'at {time:.6f}: {text}')
