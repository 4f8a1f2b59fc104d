"""The node over DDS: joint states in, gravity torque and dynamics out."""

import signal
from types import SimpleNamespace

from diagnostic_msgs.msg import DiagnosticArray
from dynamics_interfaces.msg import JointDynamics
from dynamics_interfaces.srv import GetGravityTorque
from dynamics_node import RobotModel
from dynamics_node.ros.node import DynamicsNode
import numpy as np
import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.processes import LATCHED
from support.robots import ARM7, PENDULUM
import yaml

HOLD = 0.5 * 3 * 0.7 * 9.81  # the pendulum's gravity torque at 0, N m
GRAVITY_TORQUE = '/dynamics_node/gravity_torque'


@pytest.fixture(scope='module')
def arm():
    model = RobotModel.from_urdf(ARM7)
    # The node finds the machine code too: equal to the last bit needs the same code.
    model.specialize()
    return model


def measured(names, q):
    """Return names and positions backwards and with a joint that the robot does not have."""
    return ['unknown', *reversed(names)], [9.9, *reversed(list(q))]


def assert_same(actual, expected):
    """Compare two answers: one may come from machine code, the other from the general kernel."""
    np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-13)


def test_gravity_torque_is_by_name_whatever_the_order(client, start, arm):
    start(robot_description_file=ARM7)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    q = np.clip(np.linspace(0.3, -0.9, 8), *arm.position_limits.T)
    names, positions = measured(arm.joint_names, q)
    client.until(lambda: torques, lambda: client.publish(names, positions))
    assert tuple(torques[-1].name) == arm.joint_names
    np.testing.assert_array_equal(torques[-1].position, q)
    assert_same(torques[-1].effort, arm.gravity_torque(q))
    stamp = torques[-1].header.stamp
    assert stamp.sec > 0

    def forward():
        client.publish(arm.joint_names, q)

    torques.clear()
    client.until(lambda: len(torques) > 2, forward)
    assert_same(torques[-1].effort, arm.gravity_torque(q))


def test_partial_messages_are_merged_and_nothing_is_computed_before_all_joints_came(
    client, start, arm
):
    start(robot_description_file=ARM7)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    q = np.clip(np.full(8, 0.2), *arm.position_limits.T)
    client.until(lambda: client.states.get_subscription_count())
    client.until(lambda: client.node.count_publishers(GRAVITY_TORQUE))
    client.during(0.5, lambda: client.publish(arm.joint_names[:5], q[:5]))
    assert torques == []

    def halves():
        client.publish(arm.joint_names[:5], q[:5])
        client.publish(arm.joint_names[5:], q[5:])

    client.until(lambda: torques, halves)
    assert_same(torques[-1].effort, arm.gravity_torque(q))


def test_chosen_joints_come_in_the_chosen_order(client, start, arm):
    chosen = (arm.joint_names[3], arm.joint_names[1])
    start(robot_description_file=ARM7, joints=f'[{", ".join(chosen)}]')
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: torques, lambda: client.publish(chosen, [-0.7, 0.5]))
    assert tuple(torques[-1].name) == chosen
    q = arm.neutral_position
    q[[3, 1]] = -0.7, 0.5
    assert_same(torques[-1].effort, arm.gravity_torque(q)[[3, 1]])


def test_dynamics_are_published_and_coriolis_is_left_out_without_velocity(client, start, arm):
    start(robot_description_file=ARM7)
    received = client.listen(JointDynamics, '/dynamics_node/dynamics')
    q = np.clip(np.linspace(-0.4, 0.9, 8), *arm.position_limits.T)
    qd = np.linspace(1.0, -1.0, 8)
    D, C, G = arm.dynamics(q, qd)
    client.until(lambda: received, lambda: client.publish(arm.joint_names, q, qd))
    message = received[-1]
    assert tuple(message.joint_names) == arm.joint_names
    assert message.header.frame_id == arm.tree.root
    assert_same(np.reshape(message.mass_matrix, (8, 8)), D)
    assert_same(np.reshape(message.coriolis_matrix, (8, 8)), C)
    np.testing.assert_allclose(message.coriolis_torque, C @ qd, rtol=1e-13, atol=1e-15)
    assert_same(message.gravity_torque, G)

    for velocity in ((), [*qd[:7], np.nan]):
        received.clear()
        client.until(
            lambda: received and not len(received[-1].velocity),
            lambda velocity=velocity: client.publish(arm.joint_names, q, velocity),
        )
        message = received[-1]
        assert len(message.coriolis_matrix) == len(message.coriolis_torque) == 0
        assert_same(message.gravity_torque, G)


def test_bad_joint_states_are_dropped_and_the_node_continues(client, start):
    start(robot_description_file=PENDULUM)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: torques, lambda: client.publish(['hinge'], [0.5]))
    client.during(0.3)
    torques.clear()

    def garbage():
        client.publish(['hinge'], [])
        client.publish(['hinge'], [0.5, 0.5])
        client.publish(['hinge', 'hinge'], [0.5, 0.5])
        client.publish(['hinge'], [np.nan])
        client.publish(['hinge'], [np.inf])
        client.publish(['hinge'], [0.5], [1.0, 2.0])
        client.publish([], [])

    client.during(0.5, garbage)
    assert torques == []
    client.until(lambda: torques, lambda: client.publish(['hinge'], [0.0]))
    assert torques[-1].effort[0] == pytest.approx(HOLD)


def test_an_incompatible_publisher_of_joint_states_is_logged(client, start):
    process = start(
        robot_description_file=PENDULUM,
        **{'qos_overrides./joint_states.subscription.reliability': 'reliable'},
    )
    client.node.create_publisher(JointState, 'joint_states', qos_profile_sensor_data)
    client.until(lambda: client.node.count_subscribers('/joint_states'))
    client.during(7.5)
    process.send(signal.SIGINT)
    code, output = process.wait()
    assert code == 0
    assert 'no joint state on /joint_states for hinge' in output
    assert 'the quality of service of /test_client does not fit' in output


def test_a_latched_joint_state_is_received_with_the_parameters_for_it(client, start):
    latched = client.node.create_publisher(JointState, 'joint_states', LATCHED)
    latched.publish(JointState(name=['hinge'], position=[0.5]))
    start(
        robot_description_file=PENDULUM,
        state_timeout=10.0,
        **{
            'qos_overrides./joint_states.subscription.durability': 'transient_local',
            # Without it DDS sends nothing that was published before.
            'qos_overrides./joint_states.subscription.reliability': 'reliable',
        },
    )
    answers: list = []
    client.until(
        lambda: answers and answers[-1].success,
        lambda: answers.append(client.ask(GetGravityTorque)),
    )
    assert answers[-1].position[0] == 0.5


def test_the_description_comes_from_the_topic_and_bad_ones_are_refused(client, start):
    start()
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: client.description.get_subscription_count())
    for text in ('', '<robot', '<robot name="r"/>', 'no xml \x00'):
        client.description.publish(String(data=text))
        client.during(0.1)
    client.description.publish(String(data=PENDULUM.read_text()))
    client.until(lambda: torques, lambda: client.publish(['hinge'], [0.0]))
    # A worse one later: the model stays.
    client.description.publish(String(data='<robot name="r"/>'))
    client.during(0.3)
    torques.clear()
    client.until(lambda: torques, lambda: client.publish(['hinge'], [0.0]))
    assert torques[-1].effort[0] == pytest.approx(HOLD)


def test_a_description_refused_for_a_parameter_is_accepted_after_its_correction(client, start):
    start(**{'payload.link': 'nose', 'payload.mass': 1.0})
    statuses = client.listen(DiagnosticArray, '/diagnostics')
    client.description.publish(String(data=ARM7.read_text()))
    client.until(lambda: statuses)
    client.during(1.0)

    def model():
        return newest_diagnostics(statuses)[1].get('model', '')

    assert client.set_node_parameter('payload.link', 'chin').successful
    statuses.clear()
    client.until(lambda: 'no robot description' in model())
    assert client.set_node_parameter('payload.link', 'hand').successful
    client.until(lambda: model() == 'ok')


def test_the_description_may_be_a_parameter_of_a_file(client, start, tmp_path):
    path = tmp_path / 'parameters.yaml'
    path.write_text(
        yaml.safe_dump({'/**': {'ros__parameters': {'robot_description': PENDULUM.read_text()}}})
    )
    start(parameters_file=path)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: torques, lambda: client.publish(['hinge'], [0.0]))
    assert torques[-1].effort[0] == pytest.approx(HOLD)


def test_an_impossible_start_is_one_clear_line_and_exit_code_1(start):
    cases = [
        ({'robot_description_file': 'no_such.urdf'}, "cannot read 'no_such.urdf'"),
        ({'gravity': '[0.0, 0.0]'}, 'gravity: expected 3 numbers, got [0.0, 0.0]'),
        (
            {'robot_description_file': PENDULUM, 'joints': '[elbow]'},
            "joints: 'elbow' is not a joint that can be moved; available: hinge",
        ),
        (
            {'robot_description_file': PENDULUM, 'effort_limits': '[1.0, 2.0]'},
            'effort_limits: expected 1 numbers for hinge, or none; got 2',
        ),
        ({'gravity': '[0.0, '}, "Couldn't parse parameter override rule"),
    ]
    processes = [(start(**parameters), text) for parameters, text in cases]
    for process, text in processes:
        code, output = process.wait()
        assert code == 1
        assert text in output


def test_parameters_change_at_run_time_and_wrong_ones_change_nothing(client, start):
    start(robot_description_file=PENDULUM)
    torques = client.listen(JointState, GRAVITY_TORQUE)

    def publish():
        client.publish(['hinge'], [0.0])

    def set_parameters(**values):
        parameters = [
            Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]
        return client.ask(SetParametersAtomically, publish, parameters=parameters).result

    for values, reason in (
        ({'gravity': [0.0, 0.0, float('nan')]}, 'gravity: expected a number >= -20'),
        ({'gravity': [0.0, 19.0, 19.0]}, 'gravity: expected at most 20 m/s^2, got 26.87'),
        ({'gravity': 'down'}, 'gravity: expected a list of numbers'),
        ({'gravity': [0.0, 0.0, -1.62], 'state_timeout': 0.0}, 'state_timeout: expected'),
        ({'stop_behavior': 'faint'}, 'one of ramp_to_zero, hold, zero'),
        ({'effort_limits': [1.0, 2.0]}, 'expected 1 numbers for hinge'),
        ({'command_topic': 'other'}, 'read-only'),
    ):
        answer = set_parameters(**values)
        assert not answer.successful
        assert reason in answer.reason
    torques.clear()
    client.until(lambda: torques, publish)
    assert torques[-1].effort[0] == pytest.approx(HOLD)

    assert set_parameters(gravity=[0.0, 0.0, -1.62]).successful
    client.until(lambda: torques[-1].effort[0] == pytest.approx(0.5 * 3 * 0.7 * 1.62), publish)


def newest_diagnostics(received):
    """Return the values of the newest diagnostics by status, and the messages."""
    if not received:
        return {}, {}
    newest = {
        status.name.removeprefix('dynamics_node: '): status for status in received[-1].status
    }
    return (
        {
            name: {value.key: value.value for value in status.values}
            for name, status in newest.items()
        },
        {name: status.message for name, status in newest.items()},
    )


def test_diagnostics_report_model_states_output_and_state_machine(client, start):
    received = client.listen(DiagnosticArray, '/diagnostics')
    start(robot_description_file=PENDULUM)

    def publish():
        client.publish(['hinge', 'x'], [0.0, 0.0])

    def values(part):
        return newest_diagnostics(received)[0].get(part, {})

    client.until(lambda: float(values('joint states').get('rate [Hz]', 0.0)) > 10, publish)
    assert values('model')['joints'] == 'hinge'
    assert values('model')['moving mass [kg]'] == '3'
    assert values('joint states')['publishers'] == '1'
    assert float(values('joint states')['age [s]']) < 1.0
    assert values('state machine') == {
        'state': 'READY',
        'reason': 'output is off until it is enabled',
        'latched fault': '',
    }
    assert values('output')['topic'] == '/forward_effort_controller/commands'
    assert values('output')['commands'] == '0'

    # Dropped states are counted by reason.
    def bad():
        client.publish(['hinge'], [np.nan])
        client.during(0.01)
        client.publish(['hinge'], [])

    client.until(
        lambda: {'rejected: not finite', 'rejected: length'} <= set(values('joint states')),
        bad,
        period=0.05,
    )
    assert int(values('joint states')['rejected']) >= 2
    client.until(lambda: newest_diagnostics(received)[1]['joint states'] == 'stale: hinge')

    # A latched fault and its reason.
    client.until_heard(publish)
    assert client.enable(True, publish).success
    client.until(lambda: values('output')['commands'] != '0', publish)
    client.until(lambda: values('state machine')['state'] == 'FAULT', timeout=5.0)
    assert 'stale' in values('state machine')['latched fault']


def test_impossible_stamps_yield_no_torque_and_are_named_in_the_refusal(client, start):
    process = start(robot_description_file=PENDULUM)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    message = JointState(name=['hinge'], position=[0.0])

    def stamped(offset, moves=True):
        def publish():
            now = client.node.get_clock().now().nanoseconds if moves else 0
            stamp = now + round(offset * 1e9)
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
            client.states.publish(message)

        return publish

    # In time, and without a stamp: arrival counts.
    for good in (stamped(-0.02), stamped(0, moves=False)):
        torques.clear()
        client.until(lambda: len(torques) > 3, good)
    frozen = client.node.get_clock().now().nanoseconds * 1e-9
    for bad in (stamped(-5.0), stamped(5.0), stamped(frozen, moves=False)):
        client.during(0.2, bad)  # longer than a state is fresh
        assert 'no joint state' in client.enable(True, bad).message
        torques.clear()
        client.during(0.2, bad)
        assert torques == []
    answer = client.enable(True, stamped(-5.0))
    assert 'dropped so far: ' in answer.message
    assert ' for stamp' in answer.message
    process.send(signal.SIGINT)
    assert 'synchronize the clocks of both machines' in process.wait()[1]


def test_every_service_except_enable_is_in_the_service_group(client):
    node = DynamicsNode(context=client.context)
    try:
        waiting = {
            service.srv_name.rpartition('/')[2]
            for service in node.services
            if service.callback_group is node.service_group
        }
        others = {
            service.srv_name
            for service in node.services
            if service.callback_group is not node.service_group
        }
        assert {'get_mass_matrix', 'set_payload', 'set_parameters', 'get_parameters'} <= waiting
        # rclpy's own get_type_description is made without `create_service`.
        assert {name.rpartition('/')[2] for name in others} - {'get_type_description'} == {
            'enable'
        }
    finally:
        node.destroy_node()


def test_an_exception_on_the_torque_path_stops_the_output_but_not_the_node(client, capfd):
    # In this process, where the model can be broken.
    node = DynamicsNode(
        context=client.context,
        parameter_overrides=[
            Parameter(name, value=value)
            for name, value in (
                ('robot_description_file', str(PENDULUM)),
                ('state_timeout', 0.5),
                ('start_ramp', 0.0),
                ('stop_ramp', 0.1),
            )
        ],
    )
    client.executor.add_node(node)
    client.record_commands()

    def publish():
        client.publish(['hinge'], [0.0])

    def active():
        client.until_heard(publish)
        assert client.enable(True, publish).success
        client.until(client.output_is('ACTIVE'), publish)
        client.until(
            lambda: client.commands and client.commands[-1][1] == [pytest.approx(HOLD)], publish
        )

    try:
        active()
        compensation = node.path.compensation
        node.path.compensation = SimpleNamespace(torques=lambda q, qd: 1 / 0, needs_velocity=False)
        client.until(client.output_is('FAULT'), publish)
        assert client.outputs[-1].reason == ('internal error in _received: division by zero')
        assert client.commands[-1][1] == [0.0]
        assert 'ZeroDivisionError' in capfd.readouterr().err
        node.path.compensation = compensation
        active()
        bad = np.array([np.nan])
        node.path.compensation = SimpleNamespace(
            torques=lambda q, qd: (bad, bad), needs_velocity=False
        )
        client.until(client.output_is('FAULT'), publish)
        assert client.outputs[-1].reason.startswith('invalid effort: expected finite efforts')
        assert np.isfinite([command for _, command in client.commands]).all()
    finally:
        client.executor.remove_node(node)
        node.destroy_node()
