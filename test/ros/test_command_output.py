"""The command topic over DDS: silent until enabled, ramped, limited, and stopped in order."""

import functools
import itertools
import signal
import time

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
from support.processes import Diagnostics, PATIENCE
from support.robots import ARM7, HOLD, PENDULUM

TOPIC = 'forward_effort_controller/commands'
ARM = RobotModel.from_urdf(ARM7)
HELD = [pytest.approx(HOLD)]


@pytest.fixture(scope='module')
def shared_parameters():
    return {'robot_description_file': PENDULUM, 'state_timeout': 0.5}


@pytest.fixture
def start(start):
    """Start the node with a timeout for a busy machine."""
    return functools.partial(start, state_timeout=0.5)


def efforts_of(client):
    """Return the recorded efforts of the pendulum, N m."""
    return np.array([effort for _, [effort] in client.commands])


def ended(client, process, action, timeout=6.0):
    """Wait for the end of the node, which must leave zero; return exit code and output."""
    client.until(lambda: process.process.poll() is not None, action, timeout=timeout)
    client.during(0.2)
    assert client.command in (None, [0.0])
    return process.wait()


def assert_ramped_to_zero(efforts):
    assert efforts[-1] == 0.0
    assert (np.diff(efforts) <= 0).all()
    assert np.abs(np.diff(efforts)).max() < 0.2 * HOLD


def check_cycle(client, publish):
    """Check the output from off to ACTIVE to off."""
    client.until(lambda: client.node.count_publishers(TOPIC) and client.outputs, publish)
    client.commands.clear(), client.outputs.clear()
    client.during(1.0, publish)
    assert client.commands == []
    client.activate(publish)
    client.until(lambda: client.command == HELD, publish)
    efforts = efforts_of(client)
    assert efforts[0] < 0.2 * HOLD
    assert (np.diff(efforts) >= 0).all()

    client.commands.clear()
    assert client.enable(False, publish).success
    client.until_output('READY', publish)
    client.until(lambda: client.command == [0.0], publish)
    assert_ramped_to_zero(efforts_of(client))
    duration = client.commands[-1][0] - client.commands[0][0]
    assert duration == pytest.approx(1.0, abs=0.4)
    states = [output.name for output in client.outputs]
    assert states == ['STARTING', 'ACTIVE', 'STOPPING', 'READY']
    client.commands.clear()
    client.during(0.5, publish)
    assert client.commands == []


def check_silence(client, publish):
    """Check that an ACTIVE output ends in a fault by the ramp when the joint states end."""
    # A shorter timeout takes effect at once.
    assert client.set_node_parameter('state_timeout', 0.1, publish).successful
    client.commands.clear()
    client.until_output('FAULT', timeout=5.0)
    client.until(lambda: client.command == [0.0])
    assert_ramped_to_zero(efforts_of(client))
    assert 'joint_states stale: last 0.1' in client.reason
    assert 'limit 0.100 s' in client.reason
    # States alone do not clear it; a request does.
    client.during(0.3, publish)
    assert client.output == 'FAULT'
    assert client.set_node_parameter('state_timeout', 0.5, publish).successful
    client.activate(publish)


def test_nothing_is_published_until_enabled_then_it_ramps_up_and_down(shared, drive_shared, level):
    check_cycle(shared, level)


def test_stale_states_stop_by_the_ramp_and_latch_a_fault(shared, drive_shared, level):
    drive_shared()
    check_silence(shared, level)


def test_the_same_holds_for_states_that_rclpy_deserializes(client, start, publish):
    start(robot_description_file=PENDULUM, options=['--no-raw-states'])
    client.record_commands()
    check_cycle(client, publish)
    client.activate(publish)
    check_silence(client, publish)


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


def test_only_states_of_all_chosen_joints_keep_the_output_on(client, start):
    chosen, q = list(ARM.joint_names[:2]), ARM.neutral_position
    process = start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]')
    diagnostics = Diagnostics(client)
    client.record_commands()
    client.activate(lambda: client.publish(ARM.joint_names, q))
    client.until(
        lambda: 'taken where last seen: upper_arm_roll' in diagnostics.text,
        lambda: client.publish(chosen, q[:2]),
    )
    assert client.output == 'ACTIVE'
    client.until_output('FAULT', lambda: client.publish(chosen[:1], q[:1]))
    assert 'joint_states stale: last 0.5' in client.reason
    _, output = process.end()
    assert (
        'joint_states do not contain upper_arm_roll, elbow_pitch, forearm_roll, wrist_pitch, '
        'wrist_roll, left_finger_slide: the efforts take such a joint where it was last measured'
    ) in output
    assert output.count('do not contain') == 1


def test_efforts_are_clamped_to_the_limit_and_not_for_long(shared, drive_shared, level):
    # Nearly upright the arm can hold itself; it is then moved to where it cannot.
    drive_shared(lambda: shared.publish(['hinge'], [1.3], [0.0]), effort_limits=[4.0])
    for i in range(130):
        shared.during(0.01, lambda q=1.3 - 0.01 * i: shared.publish(['hinge'], [q], [0.0]))
    shared.during(0.3, level)
    assert max(effort for _, [effort] in shared.commands) == 4.0
    shared.until_output('FAULT', level)
    assert shared.reason == ('effort above its limit for 2 s: hinge: 10.3005 limited to 4')
    assert shared.command == [0.0]


def test_garbage_while_active_never_reaches_the_command(shared, drive_shared, level):
    drive_shared()
    torques = shared.listen(JointState, '/dynamics_node/gravity_torque')
    garbage = [
        (['hinge'], []),
        (['hinge'], [0.5, 0.5]),
        (['hinge', 'hinge'], [0.5, 0.5]),
        (['hinge'], [np.nan]),
        (['hinge'], [np.inf]),
        (['hinge'], [0.5], [1.0, 2.0]),
        ([], []),
    ]
    # One at a time: the queue has one place, so of several at once only the last arrives.
    sequence = itertools.cycle(
        action
        for state in garbage
        for action in (level, lambda state=state: shared.publish(*state))
    )
    # ACTIVE may be heard before the last command of the ramp: they are two topics.
    shared.until(lambda: torques and shared.command == HELD, level)
    shared.commands.clear()
    shared.during(0.6, lambda: next(sequence)())
    assert shared.output == 'ACTIVE'
    assert len(shared.commands) > 10
    assert all(command == HELD for _, command in shared.commands)

    # Garbage alone is silence: the watchdog stops.
    only_garbage = itertools.cycle(garbage)
    shared.until_output('FAULT', lambda: shared.publish(*next(only_garbage)))
    torques.clear()
    shared.during(0.3, lambda: shared.publish(*next(only_garbage)))
    assert torques == []
    shared.until(lambda: shared.command == [0.0])
    assert np.isfinite([command for _, command in shared.commands]).all()


@pytest.mark.parametrize(
    'numbers',
    [
        # A closed terminal.
        [signal.SIGHUP],
        [signal.SIGQUIT],
        # As `ros2 launch` without a terminal sends them: the second must not cut the stop short.
        [signal.SIGINT, signal.SIGINT],
    ],
    ids=lambda numbers: '+'.join(number.name for number in numbers),
)
def test_a_signal_while_active_ramps_down_and_exits_with_0(client, drive, publish, numbers):
    if signal.getsignal(numbers[0]) == signal.SIG_IGN:
        pytest.skip('these tests run under nohup, which the node respects')
    process = drive()
    client.commands.clear()
    for number in numbers:
        process.send(number)
        client.during(0.05, publish)
    code, _ = ended(client, process, publish)
    assert code == 0
    assert_ramped_to_zero(efforts_of(client))


def test_the_command_follows_the_order_of_joints_and_hold_keeps_the_last_effort(client, start):
    chosen = [ARM.joint_names[i] for i in (3, 0, 1)]
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]', stop_behavior='hold')
    client.record_commands()
    q = np.clip(np.full(len(ARM.joint_names), 0.5), *ARM.position_limits.T)
    # Before the output is on: the first call loads the kernels, and the watchdog would notice.
    expected = ARM.gravity_torque(q)[[3, 0, 1]]

    def publish():
        client.publish(ARM.joint_names, q)

    client.activate(publish)
    client.during(0.2, publish)
    np.testing.assert_allclose(client.command, expected, rtol=1e-12, atol=1e-12)
    client.until_output('HOLDING')  # silence
    client.during(0.2)
    np.testing.assert_allclose(client.command, expected, rtol=1e-12, atol=1e-12)
    answer = client.enable(False, publish)
    assert answer.message == 'releasing the efforts in force'
    client.until_output('FAULT', publish)  # that of the silence
    client.during(0.2, publish)
    assert client.command == [0.0, 0.0, 0.0]
    client.activate(publish)
    client.enable(False, publish)  # a request does not hold
    client.until_output('READY', publish)
    assert client.command == [0.0, 0.0, 0.0]


def test_a_new_description_waits_until_the_output_is_off(client, start, publish):
    process = start()
    client.record_commands()
    text = PENDULUM.read_text()
    client.description.publish(String(data=text))
    client.until_output('READY', publish)
    client.activate(publish)
    heavier = text.replace('<mass value="3"/>', '<mass value="5"/>')
    client.description.publish(String(data=heavier))
    client.during(0.5, publish)
    assert client.command == HELD
    client.enable(False, publish)
    client.until_output('READY', publish)
    client.commands.clear()
    client.activate(publish)
    client.during(0.2, publish)
    assert client.command == [pytest.approx(5 / 3 * HOLD)]
    process.send(signal.SIGINT)
    _, output = ended(client, process, publish, PATIENCE)
    assert 'waits until the output is off' in output


def test_enabling_is_refused_with_every_reason(client, start):
    process = start()
    for answer in (client.enable(True), client.ask(GetDynamics)):
        assert not answer.success
    assert 'no robot description yet' in client.enable(True).message
    assert 'publish robot_description' in answer.message
    assert len(answer.mass_matrix) == len(answer.gravity_torque) == 0
    answer = client.enable(False)
    assert (answer.success, answer.message) == (True, 'already off: READY')
    text = PENDULUM.read_text().replace('<limit effort="20" velocity="20"/>', '')
    client.description.publish(String(data=text))
    client.until(lambda: 'no robot' not in (message := client.enable(True).message) and message)
    answer = client.enable(True)
    assert not answer.success
    assert 'no joint state within 0.5 s for hinge' in answer.message
    assert 'no effort limit for hinge: set the parameter effort_limits' in answer.message
    # A signal while idle ends the process at once.
    code, _ = process.end(timeout=5.0)
    assert code == 0


def test_enabling_is_refused_while_others_publish(client, start, publish):
    start(robot_description_file=PENDULUM)
    client.until_heard(publish)
    conflicting = client.node.create_publisher(Float64MultiArray, TOPIC, 1)
    second = client.node.create_publisher(JointState, 'joint_states', 1)
    client.until(second.get_subscription_count, publish)
    client.during(0.5, publish)
    answer = client.enable(True, publish)
    assert not answer.success
    assert f'1 other publisher(s) on /{TOPIC}' in answer.message
    assert '2 publishers on /joint_states' in answer.message
    client.node.destroy_publisher(conflicting)
    client.node.destroy_publisher(second)
    client.until(lambda: client.node.count_publishers(f'/{TOPIC}') == 1, publish)
    answers = []
    # The node may hear of it a moment later than this client.
    client.until(
        lambda: answers.append(client.enable(True, publish)) or answers[-1].success, publish
    )
    assert 'but nothing listens there' in answers[-1].message


def test_enabling_on_start_waits_until_all_checks_pass(client, start, publish):
    start(robot_description_file=PENDULUM, enable_on_start='true')
    client.record_commands()
    client.until(client.states.get_subscription_count)
    client.until_output('READY')
    client.until_output('ACTIVE', publish)
    answer = client.enable(True, publish)
    assert answer.success
    assert 'already enabled' in answer.message


def test_a_request_to_disable_overrides_enable_on_start(client, start, publish):
    start(robot_description_file=PENDULUM, enable_on_start='true')
    client.record_commands()
    assert client.enable(False).success
    client.until(client.states.get_subscription_count)
    client.during(2.5, publish)
    assert client.commands == []
    assert client.output == 'READY'


def test_two_broadcasters_at_the_same_moment_do_not_starve_each_other(client, start):
    start(robot_description_file=ARM7, allow_several_state_publishers='true')
    client.record_commands()
    gripper = client.node.create_publisher(JointState, 'joint_states', 1)

    def publish():
        client.publish(ARM.joint_names[:7], ARM.neutral_position[:7])
        gripper.publish(JointState(name=['left_finger_slide'], position=[0.01]))

    client.until(gripper.get_subscription_count, publish)
    client.activate(publish)
    client.during(1.0, publish)
    assert client.output == 'ACTIVE'


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
    assert client.output == 'ACTIVE'
    process.send(signal.SIGINT)
    code, output = ended(client, process, publish, PATIENCE)
    assert code == 0
    assert 'error in rclpy' in output
    process.expects_traceback = True


def test_a_flood_of_calls_does_not_delay_the_commands(shared, drive_shared, level):
    published, answers = [], []

    def count_and_publish():
        level()
        published.append(1)

    drive_shared(count_and_publish)
    service = shared.node.create_client(GetDynamics, '/dynamics_node/get_dynamics')
    shared.until(service.service_is_ready, count_and_publish)

    def ask(future=None):
        if future is not None:
            answers.append(future.result().success)
        service.call_async(
            GetDynamics.Request(joint_names=['hinge'] * (len(answers) % 3))
        ).add_done_callback(ask)

    for _ in range(20):  # in flight at any time
        ask()
    shared.during(0.3, count_and_publish)
    shared.commands.clear(), published.clear(), answers.clear()
    shared.during(1.5, count_and_publish)
    assert shared.output == 'ACTIVE'
    assert len(answers) > 2 * len(published)
    assert set(answers) == {True, False}
    assert len(shared.commands) > 0.8 * len(published)


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
    assert client.command == [0.0]
    assert 'second signal: the efforts go to zero within 0.3 s; now hinge: ' in output


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
    assert client.command == [0.0]


def test_a_process_that_was_suspended_continues_with_a_fault_and_without_a_step(
    shared, drive_shared, level
):
    drive_shared()
    process = shared.process
    shared.until(lambda: shared.command == HELD, level)
    process.send(signal.SIGSTOP)
    # The arm is moved meanwhile: upright, it needs no effort.
    upright = np.pi / 2

    def moved():
        shared.publish(['hinge'], [upright], [0.0])

    shared.during(1.0, moved)
    shared.commands.clear()
    process.send(signal.SIGCONT)
    shared.until_output('FAULT', moved)
    efforts = np.array([HOLD, *efforts_of(shared)])
    assert np.abs(np.diff(efforts)).max() < 0.1 * HOLD
    assert efforts[-1] == 0.0


def test_active_is_published_with_the_full_effort(shared, drive_shared, level):
    drive_shared(effort_rate_limits=[8.0])
    assert shared.enable(False, level).success
    shared.until_output('READY', level)
    shared.outputs.clear(), shared.commands.clear()
    answer = shared.enable(True, level)
    assert 'full effort in 0.5 s (start_ramp)' in answer.message
    assert 'release brakes when ~/state is ACTIVE, not before' in answer.message
    shared.during(0.8, level)
    assert shared.output == 'STARTING'
    shared.until_output('ACTIVE', level)
    # They are two topics: the last command may be heard a moment after the state.
    shared.until(lambda: shared.command == HELD, level)
    count = sum(command == HELD for _, command in shared.commands)
    assert count <= 5


def test_a_change_while_active_is_blended_over_the_start_ramp(shared, drive_shared, change, level):
    drive_shared()
    shared.until(lambda: shared.command == HELD, level)
    shared.commands.clear()
    change('compensate.gravity', False, level)
    shared.until(lambda: shared.command == [pytest.approx(0.0)], level)
    efforts = efforts_of(shared)
    # A pause of a busy machine counts as a fifth of this ramp at most.
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * HOLD
    assert np.sum((efforts > 0.05 * HOLD) & (efforts < 0.95 * HOLD)) >= 4


def test_an_offset_is_part_of_the_command_and_fades_with_it(client, drive, publish):
    offset = 0.25 * HOLD
    drive(effort_scale='[0.5]', effort_offset=f'[{offset}]')
    full = 0.5 * HOLD + offset
    client.until(lambda: client.command == [pytest.approx(full)], publish)
    efforts = efforts_of(client)
    # The start ramp fades it in: no step, and not one command that begins with it.
    assert efforts[0] < 0.2 * full
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * full
    client.commands.clear()
    assert client.set_node_parameter('effort_offset', [-offset], publish).successful
    client.until(lambda: client.command == [pytest.approx(full - 2 * offset)], publish)
    efforts = efforts_of(client)
    assert np.abs(np.diff(efforts)).max() <= (MAX_RAMP_STEP / 0.5 + 0.02) * 2 * offset + 1e-9
    assert len(np.unique(efforts)) >= 4
    client.commands.clear()
    assert client.enable(False, publish).success
    client.until_output('READY', publish)
    client.during(0.3, publish)
    assert_ramped_to_zero(efforts_of(client))
