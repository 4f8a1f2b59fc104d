"""The effort guard over DDS, in a process of its own: node, guard and controller."""

import functools
import signal
import subprocess
import sys
import time

from diagnostic_msgs.msg import DiagnosticArray
from dynamics_interfaces.msg import OutputState
from dynamics_node.errors import ParameterError
from dynamics_node.ros.effort_guard.parameters import check_all
from dynamics_node.ros.support.process import SAME_SIGNAL
from dynamics_node.safety.effort_guard import LONGEST_STEP
import numpy as np
import pytest
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
from std_srvs.srv import Trigger
from support.controller import Controller
from support.processes import Client
from support.robots import PENDULUM

INPUT, OUTPUT = '/effort_guard/commands', '/forward_effort_controller/commands'
MODULE = 'dynamics_node.ros.effort_guard.main'
# Longer than by default, for a busy machine, which must not begin a fade; the ramp is shorter.
TIMEOUT, RAMP = 0.5, 0.4
# What a busy machine may be late, s.
LATE = 3.0
FULL, ZERO = (20.0, -4.0), (0.0, 0.0)
LARGEST_STEP = FULL[0] * LONGEST_STEP / RAMP + 1e-9


class Bench(Client):
    """A source of commands and a controller beside a guard in a process of its own."""

    def __init__(self, is_source=True):
        super().__init__()
        if is_source:
            self.source = self.node.create_publisher(Float64MultiArray, INPUT, 1)
        self.guard_states = self.listen(OutputState, '/effort_guard/state', latched=True)
        self.received = []  # by the controllers: (time, efforts)

    def add_controller(self, *arguments, **parameters):
        """Start an effort controller."""
        controller = Controller(self, *arguments, **parameters)
        controller.received = self.received
        return controller

    def send(self, efforts=FULL):
        self.source.publish(Float64MultiArray(data=[float(effort) for effort in efforts]))

    def until_connected(self):
        """Wait until source, guard and controller have found each other, and nothing moves."""
        # Zeros start no effort; their arrival shows the connection.
        self.until(lambda: self.received, lambda: self.send(ZERO))
        self.until_guard('READY')

    def start(self, efforts=FULL, ramp=0.2):
        """Send what the node sends when it is enabled, and go on until all of it arrives."""
        begin = time.monotonic()

        def send():
            part = min((time.monotonic() - begin) / ramp, 1.0)
            self.send([part * effort for effort in efforts])

        self.until(lambda: self.last == list(efforts), send)

    def until_guard(self, name, action=None):
        """Wait until the guard is in a state."""
        self.until(lambda: self.guard == name, action)

    def until_reason(self, *texts, action=None, **options):
        """Wait until the reason of the guard contains one of some texts."""
        self.until(lambda: any(text in self.guard_reason for text in texts), action, **options)

    def joints(self, action=None):
        """Return the joints of the controller, mirrored by the guard."""
        request = GetParameters.Request(names=['joints'])
        values = self.call(GetParameters, '/effort_guard/get_parameters', request, action).values
        return list(values[0].string_array_value) if values else []

    def fade(self, start=FULL):
        """Return what was received since the last effort of the start."""
        return [item for item in self.received if item[1] != list(start)]

    def steps(self, begin):
        """Return the steps of the first effort, from a beginning."""
        return np.diff([begin, *(efforts[0] for _, efforts in self.received)])

    @property
    def last(self):
        return self.received[-1][1] if self.received else None

    @property
    def guard(self):
        return self.guard_states[-1].name if self.guard_states else ''

    @property
    def guard_reason(self):
        return self.guard_states[-1].reason if self.guard_states else ''


@pytest.fixture
def bench():
    bench = Bench()
    yield bench
    bench.close()


@pytest.fixture
def guard(start):
    return start(module=MODULE, timeout=TIMEOUT, stop_ramp=RAMP)


@pytest.fixture
def active(bench, guard):
    bench.add_controller()
    bench.until_connected()
    bench.start()
    return bench


def assert_ramp(received, start, ramp=RAMP):
    """Check that the commands go from a start to zero in proportion, in small steps, in time."""
    times, efforts = [time for time, _ in received], np.array([efforts for _, efforts in received])
    factors = efforts[:, 0] / start[0]
    assert efforts == pytest.approx(np.outer(factors, start))
    assert (np.diff(factors) <= 0.0).all() and factors[-1] == 0.0
    steps = -np.diff(factors, prepend=1.0)
    assert steps.max() <= LONGEST_STEP / ramp + 1e-9
    assert times[-1] - times[0] < ramp + LATE


# Commands that pass --------------------------------------------------------------------------


def test_commands_pass_with_their_layout_and_nothing_is_sent_without_them(bench, guard):
    controller = bench.add_controller()
    bench.until_guard('READY')
    whole = []
    controller.node.create_subscription(Float64MultiArray, OUTPUT, whole.append, 10)
    bench.until(
        lambda: bench.source.get_subscription_count() and controller.node.count_publishers(OUTPUT)
    )
    bench.during(0.3)
    assert bench.received == []
    bench.until_connected()
    bench.start()
    message = Float64MultiArray(data=[1.0, 2.0])
    message.layout.dim.append(MultiArrayDimension(label='joints', size=2, stride=2))
    bench.until(lambda: whole[-1] == message, lambda: bench.source.publish(message))
    assert bench.guard == 'ACTIVE'


def test_silence_and_invalid_commands_end_in_a_fade(active):
    active.received.clear()
    active.until_guard('FAULT', lambda: active.send((float('nan'), 0.0)))
    active.until(lambda: active.last == list(ZERO))
    assert_ramp(active.fade(), FULL)
    assert 'not finite' in active.guard_reason
    # Commands that continue with the whole effort pass only after a reset.
    active.received.clear()
    active.until_reason('too far from zero', 'under way', action=active.send)
    assert active.received == []
    assert active.call(Trigger, '/effort_guard/reset', action=active.send).success
    active.until(lambda: active.last == list(FULL), active.send)
    assert max(active.steps(0.0)) <= LARGEST_STEP


def test_a_guard_that_was_suspended_makes_no_step(active, guard):
    other = (-20.0, 4.0)
    guard.send(signal.SIGSTOP)
    active.during(0.5, lambda: active.send(other))
    active.received.clear()
    guard.send(signal.SIGCONT)
    active.until(lambda: active.last == list(other), lambda: active.send(other))
    assert np.abs(active.steps(20.0)).max() <= LARGEST_STEP
    assert any('stood still' in state.reason for state in active.guard_states)


# Signals -------------------------------------------------------------------------------------


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_fades_and_ends_with_0(active, guard, number):
    if signal.getsignal(number) == signal.SIG_IGN:
        pytest.skip('these tests run under nohup, which the guard respects')
    active.received.clear()
    guard.send(number)
    guard.send(number)  # as launch does it
    active.until(lambda: guard.process.poll() is not None, active.send)
    assert guard.wait()[0] == 0
    active.until(lambda: active.last == list(ZERO))
    assert_ramp(active.fade(), FULL)
    assert active.guard == 'READY' and number.name in active.guard_reason


def test_a_second_signal_is_faster(bench, start):
    guard = start(module=MODULE, timeout=TIMEOUT, stop_ramp=10.0)
    bench.add_controller()
    bench.until_connected()
    bench.start()
    guard.send(signal.SIGTERM)
    bench.until_guard('STOPPING', bench.send)
    bench.during(SAME_SIGNAL + 0.1, bench.send)
    assert bench.last[0] > 10.0
    bench.received.clear()
    guard.send(signal.SIGINT)
    bench.until(lambda: bench.last == list(ZERO), bench.send)
    assert len(bench.received) > 10
    steps = -np.diff([efforts[0] for _, efforts in bench.received])
    assert max(steps) > 1.2 * 20.0 * LONGEST_STEP / 2.5  # the first signal allows 2.5 s
    assert guard.wait()[0] == 0


# With the node -------------------------------------------------------------------------------


@pytest.fixture
def floating(guard, start):
    """Return a bench on which the node holds a pendulum through the guard, and the node."""
    node = start(
        robot_description_file=PENDULUM, command_topic=INPUT, state_timeout=10.0, start_ramp=0.2
    )
    bench = Bench(is_source=False)
    bench.record_commands()
    bench.add_controller(joints=['hinge'], interface_name='effort')
    bench.state = functools.partial(bench.publish, ['hinge'], [0.5], [0.0])
    bench.until_heard(bench.state)
    bench.until(lambda: bench.joints(bench.state), bench.state)
    # Commands right after the discovery of the node do not pass.
    bench.during(3 * TIMEOUT, bench.state)
    bench.activate(bench.state)
    bench.until_guard('ACTIVE', bench.state)
    bench.during(0.2, bench.state)
    bench.full = bench.last
    assert abs(bench.full[0]) > 5.0
    bench.received.clear()
    yield bench, node
    bench.close()


def assert_fades(bench):
    """Wait until the guard is in FAULT, and check the ramp to zero."""
    bench.until_guard('FAULT', bench.state)
    bench.until(lambda: bench.last == [0.0])
    assert_ramp(bench.fade(bench.full), bench.full)


def test_the_death_of_the_node_ends_in_a_ramp(floating):
    bench, node = floating
    node.process.kill()
    killed = time.monotonic()
    assert_fades(bench)
    assert bench.received[-1][0] - killed < TIMEOUT + RAMP + LATE
    assert 'no command for 0.5' in bench.guard_reason


def test_a_node_that_hangs_ends_in_a_ramp_and_its_return_makes_no_step(floating):
    bench, node = floating
    node.send(signal.SIGSTOP)
    assert_fades(bench)
    bench.received.clear()
    node.send(signal.SIGCONT)
    # It stops by itself after its suspension, or on request; the guard is ready after that.
    bench.until(lambda: bench.enable(False, bench.state).success, bench.state)
    bench.until_guard('READY', bench.state)
    assert not any(any(efforts) for _, efforts in bench.received)
    bench.received.clear()
    bench.until(lambda: bench.enable(True, bench.state).success, bench.state)
    bench.until(lambda: bench.last == bench.full, bench.state)
    assert bench.guard == 'ACTIVE'
    assert abs(bench.received[0][1][0]) < 0.5 * abs(bench.full[0])


def test_the_node_sees_the_controller_behind_the_guard(bench, start):
    start(module=MODULE, output_topic='elbow_controller/commands')
    start(robot_description_file=PENDULUM, command_topic=INPUT, state_timeout=10.0)
    bench.node.destroy_publisher(bench.source)  # which the node would refuse
    bench.add_controller('elbow_controller', joints=['elbow'], interface_name='position')

    state = functools.partial(bench.publish, ['hinge'], [0.5], [0.0])
    bench.until_heard(state)

    def is_refused_for_joints():
        answer = bench.enable(True, state)
        assert not answer.success or bench.enable(False, state).success
        return answer.message if 'parameter joints' in answer.message else ''

    message = bench.until(is_refused_for_joints, state)
    assert (
        '/effort_guard has another number or names of the joints: its parameter joints is '
        '[elbow], here it is [hinge]'
    ) in message
    assert '/effort_guard drives position, expected effort' in message
    # Mirrored parameters of the controller cannot be set at the guard.
    request = SetParameters.Request(
        parameters=[Parameter('joints', value=['hinge']).to_parameter_msg()]
    )
    [result] = bench.call(SetParameters, '/effort_guard/set_parameters', request, state).results
    assert not result.successful and 'those of the controller' in result.reason


def test_controllers_that_contradict_each_other_are_both_named(bench, guard):
    bench.add_controller(joints=['a', 'b'])
    other = bench.add_controller('other_controller', OUTPUT, joints=['b', 'a'])
    both = ['/forward_effort_controller: a b', '/other_controller: b a']
    bench.until(lambda: bench.joints() == both)
    other.close()
    bench.until(lambda: bench.joints() == ['a', 'b'])
    # A guard without effort ends at once.
    bench.until_guard('READY')
    assert guard.end(signal.SIGTERM)[0] == 0


# Conflicting publishers ----------------------------------------------------------------------


def test_nothing_starts_without_a_listener_or_with_another_source(bench, guard):
    bench.until(lambda: bench.source.get_subscription_count())
    bench.during(3 * TIMEOUT)
    bench.until_reason('nothing listens on /forward_effort_controller', action=bench.send)
    assert bench.guard == 'FAULT'
    conflicting = bench.node.create_publisher(Float64MultiArray, OUTPUT, 1)
    bench.add_controller()
    bench.until_connected()
    bench.until_reason(f'1 other publisher(s) on {OUTPUT} (/test_client)')
    bench.received.clear()
    bench.until_guard('FAULT', bench.send)
    assert bench.received == []
    bench.node.destroy_publisher(conflicting)
    bench.until_connected()
    bench.until(lambda: 'other publisher' not in bench.guard_reason)
    bench.start()


def test_a_second_source_and_slow_commands_are_reported(active):
    health = active.listen(DiagnosticArray, '/diagnostics')
    second = active.node.create_publisher(Float64MultiArray, INPUT, 1)
    active.until_reason(f'2 publishers on {INPUT} (/test_client)', action=active.send)
    active.node.destroy_publisher(second)
    active.until_reason('commands come too slowly', action=active.send, period=0.2)
    assert active.guard in ('ACTIVE', 'STARTING')
    active.until(
        lambda: any(
            value.key == 'slow period [s]'
            for message in health
            for status in message.status
            for value in status.values
        ),
        active.send,
        period=0.2,
    )


# Parameters and imports ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ('given', 'words'),
    [
        ({'timeout': 0.0}, 'timeout: expected a number >= 0.01 and <= 1, got 0.0'),
        ({'stop_ramp': 60.0}, 'stop_ramp: expected a number >= 0.1 and <= 10, got 60.0'),
        ({'rate_limits': [1.0], 'effort_limits': [1.0, 2.0]}, 'got 1 and 2'),
        ({'rate_limits': [-1]}, 'rate_limits: expected a finite number > 0'),
        ({'output_topic': ''}, 'output_topic: expected the name of a topic'),
    ],
)
def test_wrong_parameters_are_refused_with_a_reason(given, words):
    with pytest.raises(ParameterError) as error:
        check_all(given)
    assert words in str(error.value)


def test_a_guard_with_one_topic_for_both_does_not_start(start):
    code, output = start(module=MODULE, output_topic=INPUT).wait(30.0)
    assert code == 1 and f'both are {INPUT}' in output and 'Traceback' not in output


def test_the_guard_imports_no_dynamics():
    code = (
        'import sys\n'
        f'import {MODULE}, dynamics_node.ros.effort_guard.node\n'
        'heavy = {"numba", "llvmlite", "scipy", "yourdfpy", "dynamics_node.dynamics"}\n'
        'print(sorted(heavy & set(sys.modules)))'
    )
    run = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert run.stdout == '[]\n'
