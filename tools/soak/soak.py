"""`Soak`: random faults at random times, judged one by one."""

from collections import Counter, deque
from dataclasses import dataclass, field
import time

from rclpy.qos import qos_profile_sensor_data, QoSProfile
from sensor_msgs.msg import JointState

from .faults import FAULTS, STALE, STATE_TIMEOUT
from .faulty_link import stamp_of
from .latency import Latency
from .message_accounting import Account, MessageAccounting
from .rig import NEAR

# Source timestamps of states: some seconds, also of a flood.
HISTORY = 20_000
# The pause between two faults, and its shortest and longest duration, s.
CALM = 'none: calm'
SHORTEST_CALM, LONGEST_CALM = 0.3, 2.0
# Timeout of detection and stop on a busy machine, s.
FAULT_TIMEOUT = 10.0


@dataclass
class Tally:
    """
    Results of one kind of fault.

    Attributes
    ----------
    injected, survived : int
    paused : int
        Faults during which the link was silent without being told to, see `Soak`.
    failures : list of str
        One sentence per failed expectation.

    """

    injected: int = 0
    survived: int = 0
    paused: int = 0
    failures: list = field(default_factory=list)


class Soak:
    """
    Injects random faults into a rig and checks the expectations.

    A busy machine may delay robot or link by more than the node's timeout. The node then has to
    stop, which is no failure; the source timestamps of the link tell.

    Attributes
    ----------
    tallies : dict of Tally
        By name of the fault.
    accounting : MessageAccounting
    latency : Latency
    before, after : dict
        Resources of the node, see `RigProcesses.vitals`. `before` is measured when every kind of
        fault has come once, because DDS keeps a buffer of the size of the largest message; it
        is empty after a shorter run.
    rejected : Counter
        Joint states rejected by the node, by kind.
    duration : float
        s.

    """

    def __init__(self, rig, rng, say):
        """
        Subscribe to states and torques.

        Parameters
        ----------
        rig : Rig
        rng : random.Random
            Chooses faults and times.
        say : callable(str)
            Prints a line per failed fault.

        """
        self.tallies = {name: Tally() for name in [CALM, *(fault.name for fault in FAULTS)]}
        self.accounting, self.latency = MessageAccounting(), Latency()
        self.before = self.after = {}
        self.rejected = Counter()
        self.duration = 0.0
        self._rig, self._client, self._rng, self._say = rig, rig.client, rng, say
        self._fresh, self._rounds = [], 0
        self._written = deque(maxlen=HISTORY)
        node, client = rig.client.node, rig.client
        # Serialized, for their stamps alone: they come at 1 kHz.
        node.create_subscription(
            JointState, 'joint_states', self._on_state, qos_profile_sensor_data, raw=True
        )
        node.create_subscription(
            JointState,
            'dynamics_node/gravity_torque',
            self._on_answer,
            QoSProfile(depth=100),
            raw=True,
        )
        client.on_command = self.latency.command
        client.on_output = self.latency.state
        client.on_diagnostics = self._on_diagnostics

    def run(self, seconds):
        """Inject faults for a duration, at least one."""
        rig, client = self._rig, self._client
        begin = time.monotonic()
        rig.float()
        self._open_accounting()
        rig.float()
        while time.monotonic() - begin < seconds:
            self._one_fault(self._choose())
            self._settle()
        self._close_accounting()
        rig.float()
        self.after = rig.processes.vitals('node')
        client.set_brakes(True)
        client.enable(False)
        rig.until(lambda: client.output == 'READY')
        client.until_diagnosed()
        client.settle(everything=True)
        self.rejected.update(
            {
                key.removeprefix('rejected: '): int(value)
                for key, value in client.diagnostics['joint states'].items()
                if key.startswith('rejected: ')
            }
        )
        self.duration = time.monotonic() - begin

    def _choose(self):
        # Every kind once per round, in random order.
        if not self._fresh:
            self._rounds += 1
            if self._rounds == 2:
                self.before = self._rig.processes.vitals('node')
            self._fresh = [fault for fault in FAULTS if self._rng.random() < fault.weight]
            self._rng.shuffle(self._fresh)
        return self._fresh.pop()

    def _one_fault(self, fault):
        rig, client = self._rig, self._client
        self._calm()
        if fault.breaks_accounting:
            self._close_accounting()
            rig.float()
        tally = self.tallies[fault.name]
        tally.injected += 1
        accused, changes = client.judge.count, len(client.outputs)
        failure = ''
        with fault.inflict(rig):
            try:
                if fault.stops:
                    rig.until(lambda: client.output == 'FAULT', FAULT_TIMEOUT)
                    client.set_brakes(True)
                else:
                    rig.during(self._rng.uniform(fault.longest / 3, fault.longest))
            except AssertionError:
                failure = f'expected FAULT, got {client.output}'
        rig.during(0.1)
        newest = client.outputs[-1]
        if fault.stops and not failure and fault.reason not in newest.reason:
            failure = f'expected a reason with {fault.reason!r}, got {newest.reason!r}'
        if not fault.stops and len(client.outputs) > changes:
            failure = f'expected ACTIVE, got {newest.name}: {newest.reason}'
        is_pause = bool(failure) and self._has_paused(changes)
        rig.float()
        self._bring_back()
        if fault.breaks_accounting:
            self._open_accounting()
            rig.float()
        client.settle()
        if client.judge.count > accused:
            failure, is_pause = failure or 'wrong commands, see below', False
        self._note(tally, fault.name, failure, is_pause)

    def _calm(self):
        # A stop without a fault needs an explanation, too.
        client, tally = self._client, self.tallies[CALM]
        tally.injected += 1
        changes = len(client.outputs)
        self._rig.during(self._rng.uniform(SHORTEST_CALM, LONGEST_CALM))
        failure = ''
        if len(client.outputs) > changes:
            failure = f'expected ACTIVE, got {client.output}: {client.outputs[-1].reason}'
        self._note(tally, CALM, failure, bool(failure) and self._has_paused(changes))
        if failure:
            self._rig.until(lambda: client.output == 'FAULT', FAULT_TIMEOUT)
            self._rig.float()

    def _has_paused(self, changes):
        # Whether a stop for silence was caused by a silent link. States written shortly before
        # the stop do not count: the node cannot have read them.
        client = self._client
        stops = [
            (time, output.reason)
            for time, output in zip(client.output_times[changes:], client.outputs[changes:])
            if output.name == 'STOPPING'
        ]
        if not stops or STALE not in stops[0][1]:
            return False
        end = stops[0][0]
        return not any(
            end - 0.9 * STATE_TIMEOUT < time < end - 0.1 * STATE_TIMEOUT for time in self._written
        )

    def _note(self, tally, name, failure, is_pause):
        if is_pause:
            tally.paused += 1
            self._say(f'{self._client.now:.1f} s, {name}: the link paused by itself')
        elif failure:
            tally.failures.append(failure)
            self._say(f'{self._client.now:.1f} s, {name}: {failure}')
        else:
            tally.survived += 1

    def _bring_back(self):
        # Repeated pushes would bring it to its position limits.
        if self._rig.distance > NEAR:
            self._rig.catch()
            self._rig.release()

    def _settle(self):
        self._client.settle()
        self.latency.settle(self._client.now - 1.0)

    # Accounting: while the link is silent, so that no state is in transit ---------------------

    def _open_accounting(self):
        self._rig.until(lambda: self._client.number('joint states', 'publishers') == 1, 60.0)
        self.accounting.open(self._account())

    def _close_accounting(self):
        if self.accounting.is_open:
            self.accounting.close(self._account())

    def _account(self):
        client = self._client
        client.set_brakes(True)
        client.set_fault('silent')
        self._rig.until(lambda: client.output == 'FAULT')
        client.until_diagnosed()
        states = 'joint states'
        return Account(
            client.sent(),
            *(int(client.number(states, key)) for key in ('accepted', 'rejected', 'skipped')),
        )

    # -----------------------------------------------------------------------------------------

    def _on_state(self, data, info):
        if len(data) < 12:  # random bytes
            return
        written, stamp = self._client.time_of(info['source_timestamp']), stamp_of(data)
        self.latency.sent(written, stamp)
        if abs(written - self._client.time_of(stamp)) < 0.5 * STATE_TIMEOUT:
            self._written.append(written)

    def _on_answer(self, data, info):
        self.latency.answer(self._client.time_of(info['source_timestamp']), stamp_of(data))

    def _on_diagnostics(self, diagnostics):
        self.accounting.diagnosed(
            diagnostics['state machine']['state'],
            int(diagnostics['joint states'].get('accepted', 0)),
            int(diagnostics['output']['commands']),
        )
