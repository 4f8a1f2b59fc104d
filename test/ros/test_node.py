"""The node over DDS: joint states in, gravity torque and dynamics out."""

import functools
from types import SimpleNamespace

from dynamics_interfaces.msg import JointDynamics
from dynamics_interfaces.srv import GetGravityTorque
from dynamics_node import RobotModel
from dynamics_node.ros.node import DynamicsNode
import numpy as np
import pytest
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.processes import Diagnostics, LATCHED
from support.robots import ARM7, HOLD, PENDULUM
import yaml

GRAVITY_TORQUE = '/dynamics_node/gravity_torque'


@pytest.fixture(scope='module')
def arm():
    model = RobotModel.from_urdf(ARM7)
    # The node finds the machine code too: equal to the last bit needs the same code.
    model.specialize()
    return model


def assert_same(actual, expected):
    """Compare two answers: one may come from machine code, the other from the general kernel."""
    np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-13)


def test_gravity_torque_is_by_name_whatever_the_order(shared, arm):
    torques = shared.listen(JointState, GRAVITY_TORQUE)
    q = np.clip(np.linspace(0.3, -0.9, 8), *arm.position_limits.T)
    # Backwards, with a joint that the robot does not have; then forwards.
    backwards = ['unknown', *reversed(arm.joint_names)], [9.9, *reversed(q)]
    for state in (backwards, (arm.joint_names, q)):
        torques.clear()
        shared.until(lambda: len(torques) > 2, functools.partial(shared.publish, *state))
        assert tuple(torques[-1].name) == arm.joint_names
        np.testing.assert_array_equal(torques[-1].position, q)
        assert_same(torques[-1].effort, arm.gravity_torque(q))
        assert torques[-1].header.stamp.sec > 0


def test_partial_messages_are_merged_and_nothing_is_computed_before_all_joints_came(shared, arm):
    torques = shared.listen(JointState, GRAVITY_TORQUE)
    q = np.clip(np.full(8, 0.2), *arm.position_limits.T)
    shared.until(lambda: shared.states.get_subscription_count())
    shared.until(lambda: shared.node.count_publishers(GRAVITY_TORQUE))

    def halves():
        shared.publish(arm.joint_names[:5], q[:5])
        shared.publish(arm.joint_names[5:], q[5:])

    shared.during(1.1)  # until the states of other tests are too old
    torques.clear()
    shared.during(0.5, lambda: shared.publish(arm.joint_names[:5], q[:5]))
    assert torques == []
    shared.until(lambda: torques, halves)
    assert_same(torques[-1].effort, arm.gravity_torque(q))


def test_dynamics_are_published_and_coriolis_is_left_out_without_velocity(shared, arm):
    received = shared.listen(JointDynamics, '/dynamics_node/dynamics')
    q = np.clip(np.linspace(-0.4, 0.9, 8), *arm.position_limits.T)
    qd = np.linspace(1.0, -1.0, 8)
    D, C, G = arm.dynamics(q, qd)
    shared.until(lambda: received, lambda: shared.publish(arm.joint_names, q, qd))
    message = received[-1]
    assert tuple(message.joint_names) == arm.joint_names
    assert message.header.frame_id == arm.tree.root
    assert_same(np.reshape(message.mass_matrix, (8, 8)), D)
    assert_same(np.reshape(message.coriolis_matrix, (8, 8)), C)
    np.testing.assert_allclose(message.coriolis_torque, C @ qd, rtol=1e-13, atol=1e-15)
    assert_same(message.gravity_torque, G)

    for velocity in ((), [*qd[:7], np.nan]):
        received.clear()
        shared.until(
            lambda: received and not len(received[-1].velocity),
            lambda velocity=velocity: shared.publish(arm.joint_names, q, velocity),
        )
        message = received[-1]
        assert len(message.coriolis_matrix) == len(message.coriolis_torque) == 0
        assert_same(message.gravity_torque, G)


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


def test_the_description_comes_from_the_topic_and_bad_ones_are_refused(client, start, publish):
    start()
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: client.description.get_subscription_count())
    for text in ('', '<robot', '<robot name="r"/>', 'no xml \x00'):
        client.description.publish(String(data=text))
        client.during(0.1)
    client.description.publish(String(data=PENDULUM.read_text()))
    client.until(lambda: torques, publish)
    # A worse one later: the model stays.
    client.description.publish(String(data='<robot name="r"/>'))
    client.during(0.3)
    torques.clear()
    client.until(lambda: torques, publish)
    assert torques[-1].effort[0] == pytest.approx(HOLD)


def test_a_description_refused_for_a_parameter_is_accepted_after_its_correction(client, start):
    start(**{'payload.link': 'nose', 'payload.mass': 1.0})
    diagnostics = Diagnostics(client)
    refused = client.listen(Log, '/rosout')
    client.until(lambda: client.description.get_subscription_count())
    client.description.publish(String(data=ARM7.read_text()))
    client.until(lambda: any("'nose' is not a link" in log.msg for log in refused))
    assert client.set_node_parameter('payload.link', 'chin').successful
    client.until(lambda: 'no robot description' in diagnostics.message('model'))
    assert client.set_node_parameter('payload.link', 'hand').successful
    client.until(lambda: diagnostics.message('model') == 'ok')


def test_the_description_may_be_a_parameter_of_a_file(client, start, publish, tmp_path):
    path = tmp_path / 'parameters.yaml'
    parameters = {'robot_description': PENDULUM.read_text()}
    path.write_text(yaml.safe_dump({'/**': {'ros__parameters': parameters}}))
    start(parameters_file=path)
    torques = client.listen(JointState, GRAVITY_TORQUE)
    client.until(lambda: torques, publish)
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
        (
            {'robot_description_file': ARM7, 'payload.mass': 1.0},
            'payload.link: expected the link that carries payload.mass',
        ),
        (
            {'robot_description_file': ARM7, 'payload.mass': 1.0, 'payload.link': 'nose'},
            "payload.link: 'nose' is not a link of the robot; expected one of base",
        ),
        (
            {
                'robot_description_file': PENDULUM,
                'payload.mass': 1.0,
                'payload.link': 'rod',
                'payload.inertia': '[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]',
            },
            'inertia is not physical',
        ),
        (
            {'robot_description_file': ARM7, 'rotor_inertia': '[0.1]'},
            'rotor_inertia: expected 8 numbers for shoulder_yaw',
        ),
        ({'friction.coulomb': '[-1.0]'}, 'friction.coulomb: expected a number >= 0 and <= 1e+06'),
    ]
    processes = [(start(**parameters), text) for parameters, text in cases]
    for process, text in processes:
        code, output = process.wait()
        assert code == 1
        assert text in output


def test_parameters_change_at_run_time_and_wrong_ones_change_nothing(client, start, publish):
    start(robot_description_file=PENDULUM)
    torques = client.listen(JointState, GRAVITY_TORQUE)

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


def test_diagnostics_report_model_states_output_and_state_machine(client, start, publish):
    diagnostics = Diagnostics(client)
    values = diagnostics.values
    start(robot_description_file=PENDULUM)
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

    kinds = {'rejected: not finite', 'rejected: length'}
    client.until(lambda: kinds <= set(values('joint states')), bad, period=0.05)
    assert int(values('joint states')['rejected']) >= 2
    client.until(lambda: diagnostics.message('joint states') == 'stale: hinge')

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
    assert 'synchronize the clocks of both machines' in process.end()[1]


def test_every_service_except_enable_is_in_the_service_group(client):
    node = DynamicsNode(context=client.context)
    try:
        groups = {True: set(), False: set()}
        for service in node.services:
            is_waiting = service.callback_group is node.service_group
            groups[is_waiting].add(service.srv_name.rpartition('/')[2])
    finally:
        node.destroy_node()
    waiting, others = groups[True], groups[False]
    assert {'get_mass_matrix', 'set_payload', 'set_parameters', 'get_parameters'} <= waiting
    # rclpy's own get_type_description is made without `create_service`.
    assert others - {'get_type_description'} == {'enable'}


def test_an_exception_on_the_torque_path_stops_the_output_but_not_the_node(client, publish, capfd):
    # In this process, where the model can be broken.
    parameters = {
        'robot_description_file': str(PENDULUM),
        'state_timeout': 0.5,
        'start_ramp': 0.0,
        'stop_ramp': 0.1,
    }
    node = DynamicsNode(
        context=client.context,
        parameter_overrides=[Parameter(name, value=value) for name, value in parameters.items()],
    )
    client.executor.add_node(node)
    client.record_commands()

    def fault_of(torques):
        """Return the reason of the fault that broken torques cause."""
        client.activate(publish)
        client.until(lambda: client.command == [pytest.approx(HOLD)], publish)
        compensation = node.path.compensation
        node.path.compensation = SimpleNamespace(torques=torques, needs_velocity=False)
        client.until_output('FAULT', publish)
        node.path.compensation = compensation
        return client.reason

    try:
        reason = fault_of(lambda q, qd: 1 / 0)
        assert reason == 'internal error in _received: division by zero'
        assert client.command == [0.0]
        assert 'ZeroDivisionError' in capfd.readouterr().err
        bad = np.array([np.nan])
        reason = fault_of(lambda q, qd: (bad, bad))
        assert reason.startswith('invalid effort: expected finite efforts')
        assert np.isfinite([command for _, command in client.commands]).all()
    finally:
        client.executor.remove_node(node)
        node.destroy_node()
