"""The faults of a soak: injection, duration and expected output state."""

from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
import signal

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import Trigger

from .rig import COMMAND_TOPIC

# state_timeout of the node, s: long, so that a busy machine alone does not exceed it.
STATE_TIMEOUT = 0.5


@dataclass(frozen=True)
class Fault:
    """
    One kind of fault.

    Attributes
    ----------
    name : str
    inflict : callable(rig) -> context manager
        The fault lasts as long as the context.
    stops : bool
        Whether the output must end in FAULT, or stay ACTIVE.
    reason : str
        Part of the reason of that FAULT.
    longest : float
        Longest duration, s; the shortest is a third of it.
    weight : float
        Relative frequency.
    breaks_accounting : bool
        Whether states cannot be counted meanwhile: each of two publishers numbers its own.

    """

    name: str
    inflict: Callable
    stops: bool
    reason: str = ''
    longest: float = 1.0
    weight: float = 1.0
    breaks_accounting: bool = False


def _of_the_link(kind, **options):
    @contextmanager
    def inflict(rig):
        rig.client.set_fault(kind)
        yield
        rig.client.set_fault('none')

    return Fault(kind, inflict, **options)


@contextmanager
def _stopped(rig):
    rig.processes.send('relay', signal.SIGSTOP)
    yield
    rig.processes.send('relay', signal.SIGCONT)


@contextmanager
def _killed(rig):
    rig.processes.end('relay', signal.SIGKILL)
    yield


@contextmanager
def _node_stopped(rig):
    # A stopped process reports its FAULT only after it has been continued.
    rig.processes.send('node', signal.SIGSTOP)
    try:
        rig.during(2 * STATE_TIMEOUT)
    finally:
        rig.processes.send('node', signal.SIGCONT)
    yield


@contextmanager
def _second_state_publisher(rig):
    publisher = rig.client.node.create_publisher(JointState, 'joint_states', 1)
    yield
    rig.client.node.destroy_publisher(publisher)


@contextmanager
def _second_source_of_efforts(rig):
    publisher = rig.client.node.create_publisher(Float64MultiArray, COMMAND_TOPIC, 1)
    yield
    rig.client.node.destroy_publisher(publisher)


@contextmanager
def _pushed(rig):
    rig.client.call(Trigger, '/simulated_robot/push')
    yield


STALE = 'joint_states stale'
UNTIL_STALE = 3 * (STATE_TIMEOUT + 0.2)

FAULTS = [
    *[
        _of_the_link(kind, stops=False)
        for kind in (
            'permuted',
            'parts',
            'duplicated',
            'no_stamp',
            'frozen/5',
            'nan/5',
            'length/5',
            'name_twice/5',
            'unknown_names/5',
            'jump/30',
            'old_stamp/5',
            'future_stamp/5',
            'bag_loop/5',
            'garbage/5',
            'flood',
            'many_names/30',
            'million_names/200',
        )
    ],
    *[
        _of_the_link(kind, stops=True, reason=STALE, longest=UNTIL_STALE)
        for kind in (
            'silent',
            'frozen',
            'half',
            'all_nan',
            'length',
            'name_twice',
            'unknown_names',
            'old_stamp',
            'future_stamp',
            'bag_loop',
        )
    ],
    _of_the_link('jump', stops=True, reason='times in a row'),
    _of_the_link('too_fast', stops=True, reason='runaway'),
    Fault('line stopped briefly', _stopped, stops=False, longest=0.3, weight=2.0),
    Fault('line stopped', _stopped, stops=True, reason=STALE, longest=UNTIL_STALE),
    Fault('line killed', _killed, stops=True, reason=STALE, weight=0.3, breaks_accounting=True),
    # Detected by the watchdog or by the next state, the first one after the pause.
    Fault(
        'node stopped',
        _node_stopped,
        stops=True,
        reason=f', limit {STATE_TIMEOUT:.3f} s',
        longest=UNTIL_STALE,
        breaks_accounting=True,
    ),
    Fault(
        'second publisher of states',
        _second_state_publisher,
        stops=True,
        reason='publishers on',
        breaks_accounting=True,
    ),
    Fault(
        'second source of efforts', _second_source_of_efforts, stops=True, reason='other publisher'
    ),
    Fault('pushed', _pushed, stops=False),
]
