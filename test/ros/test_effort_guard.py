"""The effort guard over DDS, in a process of its own: node, guard and controller."""

import itertools
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
import rclpy
from rclpy.parameter import Parameter
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
from std_srvs.srv import Trigger
from support.processes import Client
from support.robots import PENDULUM

INPUT, OUTPUT = '/effort_guard/commands', '/forward_effort_controller/commands'
MODULE = 'dynamics_node.ros.effort_guard.main'
# Longer than by default, for a busy machine, which must not begin a fade; the ramp is shorter.
TIMEOUT, RAMP = 0.5, 0.4
# What a busy machine may be late, s.
LATE = 3.0
FULL = (20.0, -4.0)


class Bench(Client):
    """A source of commands and a controller beside a guard in a process of its own."""

    def __init__(self, is_source=True):
        super().__init__()
        if is_source:
            self.command = self.node.create_publisher(Float64MultiArray, INPUT, 1)
        self.guard_states = self.listen(OutputState, '/effort_guard/state', latched=True)
        self.received = []
        self._controllers = []

    def add_controller(self, name='forward_effort_controller', topic=OUTPUT, **parameters):
        """Begin to listen as an effort controller does; `received` has time and efforts."""
        controller = rclpy.create_node(name, context=self.context)
        for key, value in parameters.items():
            controller.declare_parameter(key, value)
        controller.create_subscription(
            Float64MultiArray,
            topic,
            lambda message: self.received.append((time.monotonic(), list(message.data))),
            1000,
        )
        self.executor.add_node(controller)
        self._controllers.append(controller)
        return controller

    def remove(self, controller):
        """Let a controller end."""
        self.executor.remove_node(controller)
        self._controllers.remove(controller)
        controller.destroy_node()

    def send(self, efforts=FULL):
        self.command.publish(Float64MultiArray(data=[float(effort) for effort in efforts]))

    def until_connected(self):
        """Wait until source, guard and controller have found each other, and nothing moves."""
        # Zeros start nothing, and show the way.
        self.until(lambda: self.received, lambda: self.send((0.0, 0.0)))
        self.until(self.is_in('READY'))

    def start(self, efforts=FULL, ramp=0.2):
        """Send what the node sends when it is enabled, and go on until all of it arrives."""
        begin = time.monotonic()

        def send():
            part = min((time.monotonic() - begin) / ramp, 1.0)
            self.send([part * effort for effort in efforts])

        self.until(lambda: self.last == list(efforts), send)

    def is_in(self, name):
        """Return a condition: the guard is in a state."""
        return lambda: bool(self.guard_states) and self.guard_states[-1].name == name

    @property
    def last(self):
        return self.received[-1][1] if self.received else None

    @property
    def reason(self):
        return self.guard_states[-1].reason

    def close(self):
        for controller in list(self._controllers):
            self.remove(controller)
        super().close()


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
    """The commands go from a start to zero in proportion, in steps, within the time."""
    times, efforts = [time for time, _ in received], np.array([efforts for _, efforts in received])
    factors = efforts[:, 0] / start[0]
    assert efforts == pytest.approx(np.outer(factors, start))
    assert (np.diff(factors) <= 0.0).all() and factors[-1] == 0.0
    steps = -np.diff(factors, prepend=1.0)
    assert steps.max() <= LONGEST_STEP / ramp + 1e-9
    assert times[-1] - times[0] < ramp + LATE


# Passing -------------------------------------------------------------------------------------


def test_commands_pass_with_their_layout_and_nothing_is_sent_without_them(bench, guard):
    controller = bench.add_controller()
    bench.until(bench.is_in('READY'))
    whole = []
    controller.create_subscription(Float64MultiArray, OUTPUT, whole.append, 10)
    bench.until(
        lambda: bench.command.get_subscription_count() and controller.count_publishers(OUTPUT)
    )
    bench.during(0.3)
    assert bench.received == []
    bench.until_connected()
    bench.start()
    message = Float64MultiArray(data=[1.0, 2.0])
    message.layout.dim.append(MultiArrayDimension(label='joints', size=2, stride=2))
    bench.until(lambda: whole[-1] == message, lambda: bench.command.publish(message))
    assert bench.is_in('ACTIVE')()


def test_silence_and_invalid_commands_end_in_a_fade(active):
    active.received.clear()
    active.until(active.is_in('FAULT'), lambda: active.send((float('nan'), 0.0)))
    active.until(lambda: active.last == [0.0, 0.0])
    fade = [item for item in active.received if item[1] != list(FULL)]
    assert_ramp(fade, FULL)
    assert 'not finite' in active.reason
    # Commands that continue with the whole effort pass only after a reset.
    active.received.clear()
    active.until(
        lambda: 'too far from zero' in active.reason or 'under way' in active.reason, active.send
    )
    assert active.received == []
    answer = active.call(Trigger, '/effort_guard/reset', action=active.send)
    assert answer.success
    active.until(lambda: active.last == list(FULL), active.send)
    efforts = [0.0] + [efforts[0] for _, efforts in active.received]
    assert max(b - a for a, b in itertools.pairwise(efforts)) <= 20.0 * LONGEST_STEP / RAMP + 1e-9


def test_a_guard_that_was_suspended_makes_no_step(active, guard):
    other = (-20.0, 4.0)
    guard.send(signal.SIGSTOP)
    active.during(0.5, lambda: active.send(other))
    active.received.clear()
    guard.send(signal.SIGCONT)
    active.until(lambda: active.last == list(other), lambda: active.send(other))
    efforts = [20.0] + [efforts[0] for _, efforts in active.received]
    steps = [b - a for a, b in itertools.pairwise(efforts)]
    assert max(map(abs, steps)) <= 20.0 * LONGEST_STEP / RAMP + 1e-9
    assert any('stood still' in state.reason for state in active.guard_states)


# Its own end ---------------------------------------------------------------------------------


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_fades_and_ends_with_0(active, guard, number):
    if signal.getsignal(number) == signal.SIG_IGN:
        pytest.skip('these tests run under nohup, which the guard respects')
    active.received.clear()
    guard.send(number)
    guard.send(number)  # as launch does it
    active.until(lambda: guard.process.poll() is not None, active.send)
    assert guard.wait()[0] == 0
    active.until(lambda: active.last == [0.0, 0.0])
    assert_ramp([item for item in active.received if item[1] != list(FULL)], FULL)
    assert active.is_in('READY')() and number.name in active.reason


def test_a_second_signal_is_faster(bench, start):
    guard = start(module=MODULE, timeout=TIMEOUT, stop_ramp=10.0)
    bench.add_controller()
    bench.until_connected()
    bench.start()
    guard.send(signal.SIGTERM)
    bench.until(bench.is_in('STOPPING'), bench.send)
    bench.during(SAME_SIGNAL + 0.1, bench.send)
    assert bench.last[0] > 10.0
    bench.received.clear()
    guard.send(signal.SIGINT)
    bench.until(lambda: bench.last == [0.0, 0.0], bench.send)
    efforts = [efforts[0] for _, efforts in bench.received]
    assert len(efforts) > 10
    steps = [a - b for a, b in itertools.pairwise(efforts)]
    assert max(steps) > 1.2 * 20.0 * LONGEST_STEP / 2.5  # the first signal allows 2.5 s
    assert guard.wait()[0] == 0


def test_a_guard_without_effort_ends_at_once(bench, guard):
    bench.until(bench.is_in('READY'))
    guard.send(signal.SIGTERM)
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

    def state():
        bench.publish(['hinge'], [0.5], [0.0])

    bench.until_heard(state)
    bench.until(lambda: joints_of(bench, state), state)
    bench.during(3 * TIMEOUT, state)  # commands right after the discovery of the node do not pass
    answer = bench.enable(True, state)
    assert answer.success, answer.message
    bench.until(lambda: bench.output_is('ACTIVE')() and bench.is_in('ACTIVE')(), state)
    bench.during(0.2, state)
    bench.full = bench.last
    assert abs(bench.full[0]) > 5.0
    yield bench, node, state
    bench.close()


def fade_after(bench, condition, action=None):
    """Return what the controller receives until the guard is in FAULT and a condition holds."""
    bench.received.clear()
    bench.until(condition, action)
    bench.until(lambda: bench.last == [0.0])
    return [item for item in bench.received if item[1] != bench.full]


def test_the_death_of_the_node_ends_in_a_ramp(floating):
    bench, node, state = floating
    node.process.kill()
    killed = time.monotonic()
    fade = fade_after(bench, bench.is_in('FAULT'), state)
    assert_ramp(fade, bench.full)
    assert fade[-1][0] - killed < TIMEOUT + RAMP + LATE
    assert 'no command for 0.5' in bench.reason


def test_a_node_that_hangs_ends_in_a_ramp_and_its_return_makes_no_step(floating):
    bench, node, state = floating
    node.send(signal.SIGSTOP)
    assert_ramp(fade_after(bench, bench.is_in('FAULT'), state), bench.full)
    bench.received.clear()
    node.send(signal.SIGCONT)
    # It stops by itself after its suspension, or on request; the guard is ready after that.
    bench.until(lambda: bench.enable(False, state).success, state)
    bench.until(bench.is_in('READY'), state)
    assert not any(any(efforts) for _, efforts in bench.received)
    bench.received.clear()

    def is_enabled():
        return bench.enable(True, state).success

    bench.until(is_enabled, state)
    bench.until(lambda: bench.last == bench.full, state)
    assert bench.is_in('ACTIVE')()
    assert abs(bench.received[0][1][0]) < 0.5 * abs(bench.full[0])


def test_the_node_sees_the_controller_behind_the_guard(bench, start):
    start(module=MODULE, output_topic='elbow_controller/commands')
    start(robot_description_file=PENDULUM, command_topic=INPUT, state_timeout=10.0)
    bench.node.destroy_publisher(bench.command)  # which the node would refuse
    bench.add_controller(
        'elbow_controller',
        '/elbow_controller/commands',
        joints=['elbow'],
        interface_name='position',
    )

    def state():
        bench.publish(['hinge'], [0.5], [0.0])

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
    other = bench.add_controller('other_controller', joints=['b', 'a'])
    bench.until(
        lambda: joints_of(bench) == ['/forward_effort_controller: a b', '/other_controller: b a']
    )
    bench.remove(other)
    bench.until(lambda: joints_of(bench) == ['a', 'b'])


def joints_of(bench, action=None):
    """Return the joints of the controller, mirrored by the guard."""
    request = GetParameters.Request(names=['joints'])
    values = bench.call(GetParameters, '/effort_guard/get_parameters', request, action).values
    return list(values[0].string_array_value) if values else []


# Others --------------------------------------------------------------------------------------


def test_nothing_starts_without_a_listener_or_with_another_source(bench, guard):
    bench.until(lambda: bench.command.get_subscription_count())
    bench.during(3 * TIMEOUT)
    bench.until(
        lambda: (
            'nothing listens on /forward_effort_controller' in bench.reason
            if bench.guard_states
            else False
        ),
        bench.send,
    )
    assert bench.is_in('FAULT')()
    rival = bench.node.create_publisher(Float64MultiArray, OUTPUT, 1)
    bench.add_controller()
    bench.until_connected()
    bench.until(lambda: f'1 other publisher(s) on {OUTPUT} (/test_client)' in bench.reason)
    bench.received.clear()
    bench.until(bench.is_in('FAULT'), bench.send)
    assert bench.received == []
    bench.node.destroy_publisher(rival)
    bench.until_connected()
    bench.until(lambda: 'other publisher' not in bench.reason)
    bench.start()


def test_a_second_source_and_slow_commands_are_reported(active):
    health = active.listen(DiagnosticArray, '/diagnostics')
    second = active.node.create_publisher(Float64MultiArray, INPUT, 1)
    active.until(lambda: f'2 publishers on {INPUT} (/test_client)' in active.reason, active.send)
    active.node.destroy_publisher(second)
    active.until(lambda: 'commands come too slowly' in active.reason, active.send, period=0.2)
    assert active.is_in('ACTIVE')() or active.is_in('STARTING')()
    active.until(
        lambda: any(
            'slow period [s]' in {value.key for value in status.values}
            for message in health
            for status in message.status
        ),
        active.send,
        period=0.2,
    )


# Parameters, and what it is made of ----------------------------------------------------------


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
