"""
Faults between a simulated arm and the node, over DDS: reports of the node, motion of the arm.

One robot, one relay and, for equal parameters, one node serve all tests.

"""

import bisect
import contextlib
import math
import signal

from dynamics_node.safety.effort_output import MAX_RAMP_STEP
import numpy as np
import pytest
from sensor_msgs.msg import JointState
from soak.expected_sag import expected_sag
from soak.rig import COMMAND_TOPIC, Rig
from std_msgs.msg import Float64MultiArray
from support.controller import Controller

# Ramps shorter than by default, for short tests; a longer timeout, for a busy machine.
TIMEOUT, START_RAMP, STOP_RAMP = 0.5, 0.2, 0.5
# Largest motion of a held arm after a message that is nearly correct, rad.
HELD = math.radians(1.0)
# Largest delay that the real-time simulation catches up, s; see demo/timing.py.
CATCHES_UP = 0.05


@pytest.fixture(scope='module')
def shared():
    """Return the rig of all tests."""
    rig = Rig(state_timeout=TIMEOUT, start_ramp=START_RAMP, stop_ramp=STOP_RAMP)
    yield rig
    rig.during(0.2)
    rig.client.settle(everything=True)
    rig.close()
    assert rig.client.judge.violations == []


@pytest.fixture
def rig(shared):
    """Return the rig with a node as it is by default, the arm ACTIVE and floating."""
    shared.use_node()
    shared.float()
    yield shared
    check_commands(shared)


def check_commands(rig):
    """Check that every command was within the limits of the arm."""
    rig.client.settle()
    assert rig.client.judge.violations == []


def newest_stop(rig):
    """Return when the newest stop began and ended, s."""
    client = rig.client
    index = max(i for i, output in enumerate(client.outputs) if output.name == 'STOPPING')
    begin = client.output_times[index]
    return begin, ([*client.output_times, begin + STOP_RAMP][index + 1])


def assert_it_sank_by_the_ramp(rig):
    """
    Compare the commands with the ramp, and the motion of the arm with MuJoCo under that ramp.

    The arm was held at rest before. A drop, or a push by a wrong effort, would be far faster.

    """
    begin, end = newest_stop(rig)
    assert end - begin > 0.95 * STOP_RAMP
    check_fading(rig, begin)
    time, position, velocity, effort = rig.client.truth_between(begin, end)
    # Never faster; a simulation that lags, and a command that comes late, make it slower.
    expected_time, _, expected = expected_sag(
        rig.urdf_text, position[0], effort[0], STOP_RAMP, end - begin + CATCHES_UP
    )
    speed = np.abs(velocity).max(axis=1)
    allowed = 1.1 * np.interp(time - begin + CATCHES_UP, expected_time, expected) + 0.02
    assert speed.tolist() == np.minimum(speed, allowed).tolist()
    if np.diff(time).max(initial=0.0) < CATCHES_UP and end - time[-1] < CATCHES_UP:
        assert speed[-1] > 0.2  # it did sink: the effort is gone, and not held


def check_fading(rig, begin):
    """Check that the commands of a stop stay below its ramp, and end at zero."""
    # The state comes on another topic, and may be here before the last command is.
    rig.until(lambda: not np.any(rig.client.commands[-1][1]))
    times, commands = zip(*rig.client.commands)
    first = bisect.bisect(times, begin)
    held = np.array(commands[first - 1])
    assert np.abs(held).max() > 10.0
    # A command was computed after the one before it had been written. Of a pause of the process
    # the ramp counts a tenth of a second; less is asked for here, because a writing time says
    # only about when a command was computed.
    written = np.maximum(np.array(times[first - 1 : -1]) - begin, 0.0)
    passed = np.cumsum(np.minimum(np.diff(written, prepend=0.0), 0.8 * MAX_RAMP_STEP))
    left = np.clip(1.0 - passed / STOP_RAMP, 0.0, 1.0)
    faded = np.array(commands[first:])
    assert (np.abs(faded) <= left[:, None] * np.abs(held) + 1e-9).all()


def assert_it_is_still_held(rig, since, fault=''):
    """Check that the arm has moved no further than a nearly correct message explains."""
    _, position, velocity, _ = rig.client.truth_between(since, rig.client.now)
    assert rig.client.output == 'ACTIVE', f'{fault}: {rig.explain()}'
    assert np.abs(position - position[0]).max() < HELD, fault
    assert np.abs(velocity).max() < 0.5, fault


# Harmless faults -----------------------------------------------------------------------------

HARMLESS = {
    'permuted': None,
    'parts': None,
    'no_stamp': None,
    'unknown_names/7': None,
    'flood': None,
    'duplicated': None,
    'frozen/7': 'old stamp',
    'nan/7': 'not finite',
    'length/7': 'length',
    'name_twice/7': 'name twice',
    'jump/20': 'jump',
    'old_stamp/7': 'stamp',
    'future_stamp/7': 'stamp',
    'many_names/20': 'too many names',
    'garbage/7': 'unreadable',
}


@pytest.fixture
def unhurried(rig):
    """Return the rig; the node has a longer timeout, for pauses of a busy machine."""
    rig.client.set_state_timeout(4 * TIMEOUT)
    yield rig
    rig.client.set_state_timeout(TIMEOUT)


def test_bad_messages_among_good_ones_are_counted_and_do_not_move_the_arm(unhurried):
    rig, client = unhurried, unhurried.client
    before = dict(client.diagnostics['joint states'])

    def is_counted(kind):
        key = f'rejected: {kind}'
        return kind is None or client.number('joint states', key) > float(before.get(key, 0))

    # Once each; again for faults whose messages were all replaced by newer ones, or lost.
    todo = dict(HARMLESS)
    for _ in range(5):
        for fault in todo:
            begin = client.now
            client.set_fault(fault)
            rig.during(0.25)
            assert_it_is_still_held(rig, begin, fault)
        client.set_fault('none')
        client.until_diagnosed()
        todo = {fault: kind for fault, kind in todo.items() if not is_counted(kind)}
        if not todo:
            return
    raise AssertionError(f'not counted: {todo}')


def test_a_short_freeze_of_the_relay_is_bridged(unhurried):
    rig, begin = unhurried, unhurried.client.now
    rig.processes.send('relay', signal.SIGSTOP)
    rig.during(TIMEOUT)
    rig.processes.send('relay', signal.SIGCONT)
    rig.during(0.2)
    assert_it_is_still_held(rig, begin)


# Faults that stop the output -----------------------------------------------------------------


@pytest.mark.parametrize(
    'fault, reason, is_immediate',
    [
        ('silent', 'joint_states stale: last ', False),
        ('jump', '3 times in a row', True),
        ('too_fast', 'runaway: shoulder_yaw at 50', True),
    ],
)
def test_a_fault_of_the_joint_states_stops_the_output_by_the_ramp(
    rig, fault, reason, is_immediate
):
    before = rig.client.now
    rig.client.set_fault(fault)
    assert reason in rig.until_fault()
    if is_immediate:  # and not when the states are stale
        assert newest_stop(rig)[0] - before < TIMEOUT
    assert_it_sank_by_the_ramp(rig)


def test_only_fresh_states_keep_the_output_on(rig):
    # Together longer than the timeout, each shorter.
    faults = 'frozen bag_loop half all_nan old_stamp future_stamp name_twice unknown_names'
    for fault in faults.split():
        rig.client.set_fault(fault)
        rig.during(0.1)
    assert 'joint_states stale: last ' in rig.until_fault()
    assert_it_sank_by_the_ramp(rig)


def test_a_suspended_relay_stops_the_output_by_the_ramp(rig):
    rig.processes.send('relay', signal.SIGSTOP)
    reason = rig.until_fault()
    rig.processes.send('relay', signal.SIGCONT)
    assert 'joint_states stale: last ' in reason
    assert_it_sank_by_the_ramp(rig)


@pytest.mark.parametrize(
    'kind, topic, reasons',
    [
        # As joint_state_publisher does it, with zeros; the arm stands far from zero.
        (JointState, '/joint_states', ('2 publishers on /joint_states', '3 times in a row')),
        (Float64MultiArray, COMMAND_TOPIC, (f'1 other publisher(s) on {COMMAND_TOPIC}',)),
    ],
    ids=['joint states', 'efforts'],
)
def test_a_conflicting_publisher_stops_the_output(rig, kind, topic, reasons):
    node, names = rig.client.node, rig.arm.names
    conflicting = node.create_publisher(kind, topic, 1)
    zeros = JointState(name=names, position=[0.0] * len(names))
    timer = node.create_timer(0.1, lambda: kind is JointState and conflicting.publish(zeros))
    try:
        reason = rig.until_fault()
    finally:
        node.destroy_timer(timer)
        node.destroy_publisher(conflicting)
    assert any(text in reason for text in reasons)
    assert_it_sank_by_the_ramp(rig)


def test_a_controller_with_another_order_of_joints_is_not_driven(rig):
    client = rig.client
    client.set_brakes(True)
    assert client.enable(False).success
    client.until_output('READY')
    order = list(reversed(rig.arm.driven_names))
    other = Controller(client, 'other_controller', COMMAND_TOPIC, joints=order)

    def refusal():
        answer = client.enable(True)
        if answer.success:  # it has not been found yet
            client.enable(False)
            client.until_output('READY')
        return answer.message if not answer.success else ''

    with contextlib.closing(other):
        message = rig.until(refusal)
    assert '/other_controller' in message
    assert ', '.join(order) in message and ', '.join(rig.arm.driven_names) in message


# Processes that end --------------------------------------------------------------------------


def assert_a_signal_lets_the_arm_sink(rig, number):
    """Check the exit code after a signal, and that the arm sinks by the ramp."""
    rig.processes.send('node', number)
    rig.until(lambda: not rig.processes.is_running('node'))
    rig.client.set_brakes(True)
    assert rig.processes.end('node') == 0
    assert_it_sank_by_the_ramp(rig)


def test_sigterm_to_the_node_lets_the_arm_sink_by_the_ramp(rig):
    assert_a_signal_lets_the_arm_sink(rig, signal.SIGTERM)


@pytest.fixture
def patient(shared):
    """
    Return the rig with a node that allows several publishers of joint states.

    DDS removes a killed process only after 20 s: until then there are two.

    """
    shared.use_node(allow_several_state_publishers='true')
    shared.float()
    yield shared
    check_commands(shared)


def test_another_relay_may_take_over_after_the_death_of_the_first(patient):
    patient.processes.end('relay', signal.SIGKILL)
    assert 'joint_states stale: last ' in patient.until_fault()
    assert_it_sank_by_the_ramp(patient)
    patient.float()  # on another line
    begin = patient.client.now
    patient.during(0.2)
    assert_it_is_still_held(patient, begin)


def test_the_death_of_the_robot_ends_in_silence(patient):
    patient.processes.end('robot', signal.SIGKILL)
    patient.until(lambda: patient.client.output == 'FAULT')
    assert 'joint_states stale: last ' in patient.client.outputs[-1].reason
    check_fading(patient, newest_stop(patient)[0])


def test_sigint_to_the_node_lets_the_arm_sink_by_the_ramp(patient):
    assert_a_signal_lets_the_arm_sink(patient, signal.SIGINT)


# Simulated time ------------------------------------------------------------------------------


@pytest.fixture
def simulated(shared):
    """Return the rig with a node on simulated time, hearing reliably and patient."""
    shared.use_node(
        **{
            'use_sim_time': 'true',
            'state_timeout': 10.0,
            'allow_several_state_publishers': 'true',
            'qos_overrides./joint_states.subscription.reliability': 'reliable',
        }
    )
    yield shared
    shared.client.set_clock_offset(math.nan)
    check_commands(shared)


def floating(rig):
    """Have the arm float on simulated time; return since when."""
    rig.client.set_clock_offset(-1000.0)
    rig.float()
    return rig.client.now


def test_simulated_time_may_jump(simulated):
    rig, client = simulated, simulated.client
    rig.during(0.3)
    refused = client.enable(True)
    assert not refused.success and 'no joint state' in refused.message
    begin = floating(rig)
    # Back: measured states are dropped, and the effort goes on from where it is.
    client.set_clock_offset(-1100.0)
    rig.until(lambda: client.output == 'STARTING')
    assert 'clock went back by' in client.outputs[-1].reason
    rig.until(lambda: client.output == 'ACTIVE')
    assert_it_is_still_held(rig, begin)
    # Ahead: stamps and clock go on together, so the states are fresh.
    client.set_clock_offset(-900.0)
    rig.during(0.3)
    assert_it_is_still_held(rig, begin)


def test_a_million_names_are_refused_unread(simulated):
    # A reliable connection delivers the sixteen megabytes that a best-effort one loses.
    rig, client = simulated, simulated.client
    begin = floating(rig)
    client.set_fault('million_names/200')
    rig.until(lambda: client.number('joint states', 'rejected: too many names') > 0)
    client.set_fault('none')
    assert_it_is_still_held(rig, begin)


def test_the_death_of_the_node_leaves_the_last_effort(simulated):
    # See the safety section of the README. The last test, because DDS removes the node late.
    rig, client = simulated, simulated.client
    begin = floating(rig)
    rig.processes.end('node', signal.SIGKILL)
    rig.during(0.1)
    after = client.now
    rig.during(0.4)
    _, position, _, _ = client.truth_between(begin, client.now)
    assert np.abs(position - position[0]).max() < HELD
    _, _, _, effort = client.truth_between(after, client.now)
    assert np.abs(effort[0]).max() > 10.0
    assert (effort == effort[0]).all()
