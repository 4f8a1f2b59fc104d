"""The command topic over DDS: silent until enabled, ramped, limited, and stopped in order."""

import functools
import itertools
import signal
import time

from diagnostic_msgs.msg import DiagnosticArray
from dynamics_interfaces.srv import GetDynamics
from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.node import effort_limiter
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.ros.torque_path.command_output import CommandOutput, output_settings
from dynamics_node.safety.effort_output import MAX_RAMP_STEP
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import SetBool
from support.processes import PATIENCE
from support.robots import ARM7, PENDULUM

TOPIC = 'forward_effort_controller/commands'
HOLD = 0.5 * 3 * 0.7 * 9.81  # the pendulum's gravity torque at 0, N m


@pytest.fixture
def start(start):
    """Start the node with a timeout for a busy machine."""
    return functools.partial(start, state_timeout=0.5)


@pytest.fixture
def publish(client):
    """Return an action that publishes the pendulum at rest, level."""
    return lambda: client.publish(['hinge'], [0.0], [0.0])


@pytest.fixture
def drive(client, start, publish):
    """Return a function that starts a node with a pendulum and enables its output."""

    def drive(action=publish, **parameters):
        process = start(robot_description_file=PENDULUM, **parameters)
        client.record_commands()
        enabled(client, action)
        return process

    return drive


def efforts_of(client):
    """Return the recorded efforts of the pendulum, N m."""
    return np.array([effort for _, [effort] in client.commands])


def ended(client, process, action, timeout=6.0):
    """Wait for the end of the node, which must leave zero; return exit code and output."""
    client.until(lambda: process.process.poll() is not None, action, timeout=timeout)
    client.during(0.2)
    assert not client.commands or client.commands[-1][1] == [0.0]
    return process.wait()


def assert_ramped_to_zero(efforts):
    """Check that the efforts end at zero, without a step."""
    assert efforts[-1] == 0.0
    assert np.abs(np.diff(efforts)).max() < 0.2 * HOLD


def enabled(client, action):
    """Enable the output and wait until it is ACTIVE; again if states came too late for that."""
    client.until_heard(action)
    client.until(lambda: became_active(client, action), action)
    client.until(lambda: client.commands, action)


def became_active(client, action):
    """Enable the output; return whether it became ACTIVE, or False if states were late."""
    before = len(client.outputs)
    answer = client.enable(True, action)
    # A busy machine may stop this process for a tenth of a second.
    if not answer.success and 'no joint state within' in answer.message:
        return False
    assert answer.success, answer.message
    is_active = client.output_is('ACTIVE')

    def faults():
        return [output.reason for output in client.outputs[before:] if output.name == 'FAULT']

    client.until(lambda: is_active() or faults(), action)
    assert all('joint_states stale' in reason for reason in faults()), faults()
    return is_active()


@pytest.mark.parametrize('options', [(), ('--no-raw-states',)])
def test_nothing_is_published_until_enabled_then_it_ramps_up_and_down(
    client, start, publish, options
):
    start(robot_description_file=PENDULUM, options=options)
    client.record_commands()
    client.until(lambda: client.node.count_publishers(TOPIC), publish)
    client.during(1.0, publish)
    assert client.commands == []
    enabled(client, publish)
    client.during(0.2, publish)
    efforts = efforts_of(client)
    assert efforts[0] < 0.2 * HOLD
    assert (np.diff(efforts) >= 0).all()
    assert efforts[-1] == pytest.approx(HOLD)

    client.commands.clear()
    assert client.enable(False, publish).success
    client.until(client.output_is('READY'), publish)
    client.during(0.3, publish)
    efforts = efforts_of(client)
    assert (np.diff(efforts) <= 0).all()
    assert np.abs(np.diff(efforts)).max() < 0.2 * HOLD
    assert efforts[-1] == 0.0
    duration = client.commands[-1][0] - client.commands[0][0]
    assert duration == pytest.approx(1.0, abs=0.4)
    states = [output.name for output in client.outputs]
    assert states == ['READY', 'STARTING', 'ACTIVE', 'STOPPING', 'READY']
    client.commands.clear()
    client.during(0.5, publish)
    assert client.commands == []


@pytest.mark.parametrize('options', [(), ('--no-raw-states',)])
def test_stale_states_stop_by_the_ramp_and_latch_a_fault(client, drive, publish, options):
    drive(state_timeout=0.1, options=options)
    client.commands.clear()
    client.until(client.output_is('FAULT'))  # the joint states have ended
    client.during(0.2)
    assert_ramped_to_zero(efforts_of(client))
    assert 'joint_states stale: last 0.1' in client.outputs[-1].reason
    assert 'limit 0.100 s' in client.outputs[-1].reason
    # States alone do not clear it; a request does.
    client.during(0.3, publish)
    assert client.outputs[-1].name == 'FAULT'
    enabled(client, publish)


def test_a_shorter_timeout_takes_effect_at_once(client, drive, publish):
    drive(state_timeout=10.0)
    assert client.set_node_parameter('state_timeout', 0.2, publish).successful
    client.until(client.output_is('FAULT'), timeout=5.0)
    assert 'limit 0.200 s' in client.outputs[-1].reason


def test_a_new_listener_is_noticed_at_once_but_not_its_end(client):
    output = CommandOutput(NodeContext(client.node, check_all({})), lambda: None)
    first = client.node.create_subscription(Float64MultiArray, TOPIC, lambda _: None, 1)
    client.until(output.has_new_listener)
    client.during(0.1)
    assert not output.has_new_listener()
    client.node.destroy_subscription(first)
    client.until(lambda: not output.has_listener())
    client.during(0.1)
    assert not output.has_new_listener()
    client.node.create_subscription(Float64MultiArray, TOPIC, lambda _: None, 1)
    client.until(output.has_new_listener)


def test_repeated_parameter_changes_do_not_postpone_the_watchdog(client):
    robot = ActiveRobot(RobotModel.from_urdf(PENDULUM), ())
    values = check_all({})
    output = CommandOutput(NodeContext(client.node, values), lambda: None)
    output.path.use(robot.buffer)
    output.path.configure(
        time.monotonic(),
        output_settings(values),
        robot.compensation(values),
        effort_limiter(robot, values),
        robot.motion_limits(()),
    )
    robot.buffer.update(time.monotonic(), ['hinge'], [0.0])
    output.enable()
    next_tick = output._watchdog.time_until_next_call
    while (planned := next_tick()) > 5e6:
        pass
    output.configured()
    assert next_tick() < planned
    output.path.restart_from_zero(time.monotonic(), 'a controller has begun to listen')
    assert next_tick() < planned
    client.until(lambda: output.path.state.name == 'FAULT')
    assert 'stale' in output.path.output.machine.reason


def test_states_of_some_joints_do_not_keep_the_output_on(client, start):
    arm = RobotModel.from_urdf(ARM7)
    start(robot_description_file=ARM7)
    client.record_commands()
    q = arm.neutral_position
    enabled(client, lambda: client.publish(arm.joint_names, q))
    client.until(client.output_is('FAULT'), lambda: client.publish(arm.joint_names[:5], q[:5]))
    assert 'joint_states stale: last 0.5' in client.outputs[-1].reason


def test_joints_without_effort_are_named_when_their_states_end(client, start):
    arm = RobotModel.from_urdf(ARM7)
    process = start(robot_description_file=ARM7, joints='[shoulder_yaw, shoulder_pitch]')
    statuses = client.listen(DiagnosticArray, '/diagnostics')
    client.record_commands()
    q = arm.neutral_position
    enabled(client, lambda: client.publish(arm.joint_names, q))

    def is_named():
        return any(
            'taken where last seen: upper_arm_roll' in status.message
            for message in statuses
            for status in message.status
        )

    client.until(is_named, lambda: client.publish(arm.joint_names[:2], q[:2]))
    assert client.outputs[-1].name == 'ACTIVE'
    process.send(signal.SIGINT)
    _, output = process.wait()
    assert (
        'joint_states do not contain upper_arm_roll, elbow_pitch, forearm_roll, wrist_pitch, '
        'wrist_roll, left_finger_slide: the efforts take such a joint where it was last '
        'measured'
    ) in output
    assert output.count('do not contain') == 1


def test_efforts_are_clamped_to_the_limit_and_not_for_long(client, drive, publish):
    # Nearly upright the arm can hold itself; it is then moved to where it cannot.
    drive(lambda: client.publish(['hinge'], [1.3], [0.0]), effort_limits='[4]')
    for i in range(130):
        client.during(0.01, lambda q=1.3 - 0.01 * i: client.publish(['hinge'], [q], [0.0]))
    client.during(0.3, publish)
    assert max(effort for _, [effort] in client.commands) == 4.0
    client.until(client.output_is('FAULT'), publish)
    assert client.outputs[-1].reason == (
        'effort above its limit for 2 s: hinge: 10.3005 limited to 4'
    )
    assert client.commands[-1][1] == [0.0]


def test_garbage_while_active_never_reaches_the_command(client, drive, publish):
    drive()
    # One at a time: the queue has one place, so of several at once only the last arrives.
    sequence = itertools.cycle(
        [
            publish,
            lambda: client.publish(['hinge'], [np.nan]),
            publish,
            lambda: client.publish(['hinge'], [1.0, 2.0]),
            publish,
            lambda: client.publish(['hinge', 'hinge'], [1.0, 2.0]),
        ]
    )
    # ACTIVE may be heard before the last command of the ramp: they are two topics.
    client.until(lambda: client.commands[-1][1] == [pytest.approx(HOLD)], publish)
    client.commands.clear()
    client.during(0.6, lambda: next(sequence)())
    assert client.outputs[-1].name == 'ACTIVE'
    assert len(client.commands) > 10
    assert all(command == [pytest.approx(HOLD)] for _, command in client.commands)

    # Garbage alone is silence: the watchdog stops.
    client.until(client.output_is('FAULT'), lambda: client.publish(['hinge'], [np.nan]))
    assert client.commands[-1][1] == [0.0]
    assert np.isfinite([command for _, command in client.commands]).all()


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_active_ramps_down_and_exits_with_0(client, drive, publish, number):
    process = drive()
    client.commands.clear()
    process.send(number)
    code, _ = ended(client, process, publish)
    assert code == 0
    assert_ramped_to_zero(efforts_of(client))


def test_a_signal_while_idle_exits_with_0_at_once(client, start):
    process = start()
    client.until(lambda: client.node.count_publishers(TOPIC))
    process.send(signal.SIGINT)
    code, output = process.wait(5.0)
    assert code == 0
    assert 'Traceback' not in output


def test_the_command_follows_the_order_of_joints_and_hold_keeps_the_last_effort(client, start):
    arm = RobotModel.from_urdf(ARM7)
    chosen = [arm.joint_names[i] for i in (3, 0, 1)]
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]', stop_behavior='hold')
    client.record_commands()
    q = np.clip(np.full(len(arm.joint_names), 0.5), *arm.position_limits.T)
    # Before the output is on: the first call loads the kernels, and the watchdog would notice.
    expected = arm.gravity_torque(q)[[3, 0, 1]]

    def publish():
        client.publish(arm.joint_names, q)

    enabled(client, publish)
    client.during(0.2, publish)
    np.testing.assert_allclose(client.commands[-1][1], expected, rtol=1e-12, atol=1e-12)
    client.until(client.output_is('HOLDING'))  # silence
    client.during(0.2)
    np.testing.assert_allclose(client.commands[-1][1], expected, rtol=1e-12, atol=1e-12)
    answer = client.enable(False, publish)
    assert answer.message == 'releasing the efforts in force'
    client.until(client.output_is('FAULT'), publish)  # that of the silence
    client.during(0.2, publish)
    assert client.commands[-1][1] == [0.0, 0.0, 0.0]
    enabled(client, publish)
    client.enable(False, publish)  # a request does not hold
    client.until(client.output_is('READY'), publish)
    assert client.commands[-1][1] == [0.0, 0.0, 0.0]


def test_a_new_description_waits_until_the_output_is_off(client, start, publish):
    process = start()
    client.record_commands()
    text = PENDULUM.read_text()
    client.description.publish(String(data=text))
    client.until(client.output_is('READY'), publish)
    enabled(client, publish)
    heavier = text.replace('<mass value="3"/>', '<mass value="5"/>')
    client.description.publish(String(data=heavier))
    client.during(0.5, publish)
    assert client.commands[-1][1] == [pytest.approx(HOLD)]
    client.enable(False, publish)
    client.until(client.output_is('READY'), publish)
    client.commands.clear()
    enabled(client, publish)
    client.during(0.2, publish)
    assert client.commands[-1][1] == [pytest.approx(5 / 3 * HOLD)]
    process.send(signal.SIGINT)
    _, output = ended(client, process, publish, PATIENCE)
    assert 'waits until the output is off' in output


def test_enabling_is_refused_with_every_reason(client, start, tmp_path):
    text = PENDULUM.read_text().replace('<limit effort="20" velocity="20"/>', '')
    path = tmp_path / 'no_limit.urdf'
    path.write_text(text)
    start(robot_description_file=path)
    answer = client.enable(True)
    assert not answer.success
    assert 'no joint state within 0.5 s for hinge' in answer.message
    assert 'no effort limit for hinge: set the parameter effort_limits' in answer.message


def test_enabling_is_refused_while_others_publish(client, start, publish):
    start(robot_description_file=PENDULUM)
    client.until(client.states.get_subscription_count, publish)
    client.during(0.3, publish)
    rival = client.node.create_publisher(Float64MultiArray, TOPIC, 1)
    second = client.node.create_publisher(JointState, 'joint_states', 1)
    client.until(second.get_subscription_count, publish)
    client.during(0.5, publish)
    answer = client.enable(True, publish)
    assert not answer.success
    assert f'1 other publisher(s) on /{TOPIC}' in answer.message
    assert '2 publishers on /joint_states' in answer.message
    client.node.destroy_publisher(rival)
    client.node.destroy_publisher(second)
    client.until(lambda: client.node.count_publishers(f'/{TOPIC}') == 1, publish)
    answers = []
    # The node may hear of it a moment later than this client.
    client.until(
        lambda: answers.append(client.enable(True, publish)) or answers[-1].success, publish
    )
    assert 'but nothing listens there' in answers[-1].message


def test_without_a_robot_enabling_is_refused_and_disabling_is_answered(client, start):
    start()
    assert 'no robot description yet' in client.enable(True).message
    answer = client.enable(False)
    assert answer.success
    assert answer.message == 'already off: READY'


def test_enabling_on_start_waits_until_all_checks_pass(client, start, publish):
    start(robot_description_file=PENDULUM, enable_on_start='true')
    client.record_commands()
    client.until(client.states.get_subscription_count)
    client.until(client.output_is('READY'))
    client.until(client.output_is('ACTIVE'), publish)
    answer = client.enable(True, publish)
    assert answer.success
    assert 'already enabled' in answer.message


def test_two_broadcasters_at_the_same_moment_do_not_starve_each_other(client, start):
    arm = RobotModel.from_urdf(ARM7)
    start(robot_description_file=ARM7, allow_several_state_publishers='true')
    client.record_commands()
    gripper = client.node.create_publisher(JointState, 'joint_states', 1)

    def publish():
        client.publish(arm.joint_names[:7], arm.neutral_position[:7])
        gripper.publish(JointState(name=['left_finger_slide'], position=[0.01]))

    client.until(gripper.get_subscription_count, publish)
    enabled(client, publish)
    client.during(1.0, publish)
    assert client.outputs[-1].name == 'ACTIVE'


def test_a_parameter_of_an_unknown_type_does_not_end_the_process(client, drive, publish):
    # rclpy's own parameter service raises on it.
    process = drive()
    request = SetParameters.Request(
        parameters=[Parameter(name='gravity', value=ParameterValue(type=77))]
    )
    service = client.node.create_client(SetParameters, '/dynamics_node/set_parameters')
    client.until(service.service_is_ready, publish)
    service.call_async(request)
    client.during(0.5, publish)
    assert process.process.poll() is None
    assert client.outputs[-1].name == 'ACTIVE'
    process.send(signal.SIGINT)
    code, output = ended(client, process, publish, PATIENCE)
    assert code == 0
    assert 'error in rclpy' in output
    process.expects_traceback = True


def test_a_request_to_disable_overrides_enable_on_start(client, start, publish):
    start(robot_description_file=PENDULUM, enable_on_start='true')
    client.record_commands()
    assert client.enable(False).success
    client.until(client.states.get_subscription_count)
    client.during(2.5, publish)
    assert client.commands == []
    assert client.outputs[-1].name == 'READY'


def test_a_flood_of_calls_does_not_delay_the_commands(client, drive, publish):
    published, answers = [], []

    def count_and_publish():
        publish()
        published.append(1)

    drive(count_and_publish)
    service = client.node.create_client(GetDynamics, '/dynamics_node/get_dynamics')
    client.until(service.service_is_ready, count_and_publish)

    def ask(future=None):
        if future is not None:
            answers.append(future.result().success)
        service.call_async(
            GetDynamics.Request(joint_names=['hinge'] * (len(answers) % 3))
        ).add_done_callback(ask)

    for _ in range(20):  # in flight at any time
        ask()
    client.during(0.3, count_and_publish)
    client.commands.clear(), published.clear(), answers.clear()
    client.during(1.5, count_and_publish)
    assert client.outputs[-1].name == 'ACTIVE'
    assert len(answers) > 2 * len(published)
    assert set(answers) == {True, False}
    assert len(client.commands) > 0.8 * len(published)


def test_two_signals_right_after_each_other_are_one(client, drive, publish):
    # As `ros2 launch` without a terminal sends them: the second must not cut the stop short.
    process = drive()
    client.commands.clear()
    process.send(signal.SIGINT)
    client.during(0.05, publish)
    process.send(signal.SIGINT)
    code, _ = ended(client, process, publish)
    assert code == 0
    assert_ramped_to_zero(efforts_of(client))


def test_a_second_signal_sends_zero_sooner_and_logs_the_effort(client, drive, publish):
    process = drive(stop_ramp=60.0)
    process.send(signal.SIGTERM)
    client.during(0.8, publish)
    process.send(signal.SIGTERM)
    begin = time.monotonic()
    client.until(lambda: process.process.poll() is not None, publish, timeout=6.0)
    assert time.monotonic() - begin < 1.5
    code, output = ended(client, process, publish)
    assert code == 0
    assert client.commands[-1][1] == [0.0]
    assert 'second signal: the efforts go to zero within 0.3 s; now hinge: ' in output


@pytest.mark.parametrize('number', [signal.SIGHUP, signal.SIGQUIT])
def test_a_terminal_that_closes_stops_the_arm_like_sigterm(client, drive, publish, number):
    if signal.getsignal(number) == signal.SIG_IGN:
        pytest.skip('these tests run under nohup, which the node respects')
    process = drive(stop_ramp=0.3)
    process.send(number)
    code, _ = ended(client, process, publish)
    assert code == 0
    assert client.commands[-1][1] == [0.0]


def test_nothing_is_enabled_after_a_signal(client, drive, publish):
    process = drive(stop_ramp=0.2)
    service = client.node.create_client(SetBool, '/dynamics_node/enable')
    client.until(service.service_is_ready, publish)

    def ask(future=None):
        service.call_async(SetBool.Request(data=True)).add_done_callback(ask)

    for _ in range(4):  # in flight at any time
        ask()
    client.during(0.2, publish)
    process.send(signal.SIGTERM)
    code, _ = ended(client, process, publish, timeout=8.0)
    assert code == 0
    assert client.commands[-1][1] == [0.0]


def test_a_process_that_was_suspended_continues_with_a_fault_and_without_a_step(
    client, drive, publish
):
    process = drive()
    client.until(lambda: client.commands[-1][1] == [pytest.approx(HOLD)], publish)
    process.send(signal.SIGSTOP)
    # The arm is moved meanwhile: upright, it needs no effort.
    upright = np.pi / 2

    def moved():
        client.publish(['hinge'], [upright], [0.0])

    client.during(1.0, moved)
    client.commands.clear()
    process.send(signal.SIGCONT)
    client.until(client.output_is('FAULT'), moved)
    efforts = np.array([HOLD, *efforts_of(client)])
    assert np.abs(np.diff(efforts)).max() < 0.1 * HOLD
    assert efforts[-1] == 0.0


def test_active_is_published_with_the_full_effort(client, start, publish):
    start(robot_description_file=PENDULUM, effort_rate_limits='[8.0]')
    client.record_commands()
    client.until_heard(publish)
    answer = client.enable(True, publish)
    assert 'full effort in 0.5 s (start_ramp)' in answer.message
    assert 'release brakes when ~/state is ACTIVE, not before' in answer.message
    client.during(0.8, publish)
    assert client.outputs[-1].name == 'STARTING'
    client.until(client.output_is('ACTIVE'), publish)
    # They are two topics: the last command may be heard a moment after the state.
    client.until(lambda: client.commands[-1][1] == [pytest.approx(HOLD)], publish)
    count = sum(command == [pytest.approx(HOLD)] for _, command in client.commands)
    assert count <= 5


def test_a_change_while_active_is_blended_over_the_start_ramp(client, drive, publish):
    drive()
    client.until(lambda: client.commands[-1][1] == [pytest.approx(HOLD)], publish)
    client.commands.clear()
    assert client.set_node_parameter('compensate.gravity', False, publish).successful
    client.until(lambda: client.commands[-1][1] == [pytest.approx(0.0)], publish)
    efforts = efforts_of(client)
    # A pause of a busy machine counts as a fifth of this ramp at most.
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * HOLD
    assert np.sum((efforts > 0.05 * HOLD) & (efforts < 0.95 * HOLD)) >= 4


def test_an_offset_is_part_of_the_command_and_fades_with_it(client, drive, publish):
    offset = 0.25 * HOLD
    drive(effort_scale='[0.5]', effort_offset=f'[{offset}]')
    full = 0.5 * HOLD + offset
    client.until(lambda: client.commands[-1][1] == [pytest.approx(full)], publish)
    efforts = efforts_of(client)
    # The start ramp fades it in: no step, and not one command that begins with it.
    assert efforts[0] < 0.2 * full
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * full
    client.commands.clear()
    assert client.set_node_parameter('effort_offset', [-offset], publish).successful
    client.until(lambda: client.commands[-1][1] == [pytest.approx(full - 2 * offset)], publish)
    efforts = efforts_of(client)
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * 2 * offset + 1e-9
    assert len(np.unique(efforts)) >= 4
    client.commands.clear()
    assert client.enable(False, publish).success
    client.until(client.output_is('READY'), publish)
    client.during(0.3, publish)
    assert_ramped_to_zero(efforts_of(client))
