"""The topic ~/external_torque over DDS: when it speaks, when it begins anew, what it says."""

from functools import partial
import math
import time
import types

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.publishers.external_torque import ExternalTorque
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.safety import RejectedStateError
import numpy as np
import pytest
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from sensor_msgs.msg import JointState
from support.robots import ARM7, PENDULUM

TOPIC = '/dynamics_node/external_torque'
WEIGHT = 0.5 * 3 * 0.7 * 9.81  # N m, of the pendulum at 0


@pytest.fixture
def pendulum(client, start):
    """Return the node with a pendulum, what it publishes and its diagnostics."""

    def start_pendulum(**parameters):
        parameters.setdefault('publish_external_torque', 'true')
        process = start(robot_description_file=PENDULUM, state_timeout=1.0, **parameters)
        return process, client.listen(JointState, TOPIC), Health(client)

    return start_pendulum


def gravity_torque(robot):
    """Return G of the chosen joints at the newest state."""
    return robot.model.gravity_torque(robot.buffer.position)[robot.selection.index]


class Health:
    """What the diagnostics say of the external torque."""

    def __init__(self, client):
        """Listen."""
        self._received = client.listen(DiagnosticArray, '/diagnostics')

    @property
    def newest(self):
        """The newest status, or None."""
        found = [
            status
            for message in self._received[-1:]
            for status in message.status
            if status.name == 'dynamics_node: external torque'
        ]
        return found[0] if found else None

    def says(self, text):
        """Tell whether the newest status contains a text."""
        return self.newest is not None and text in self.newest.message

    def value(self, key):
        """Return a number of the newest status, -1 if it is not there."""
        values = self.newest.values if self.newest else ()
        return int({item.key: item.value for item in values}.get(key, -1))


def held(client, effort=WEIGHT, velocity=(0.0,)):
    """Publish the pendulum at rest, with an effort or none."""
    client.publish(['hinge'], [0.0], velocity, [] if effort is None else [effort])


def set_parameter(client, name, action, **value):
    """Set a parameter of the node."""
    [result] = client.call(
        SetParameters,
        '/dynamics_node/set_parameters',
        SetParameters.Request(parameters=[Parameter(name=name, value=ParameterValue(**value))]),
        action,
    ).results
    assert result.successful, result.reason


def switch(client, value, action):
    """Switch the topic on or off."""
    set_parameter(
        client,
        'publish_external_torque',
        action,
        type=ParameterType.PARAMETER_BOOL,
        bool_value=value,
    )


def newest(received):
    """Return the newest estimate of the first joint, NaN if there is none."""
    return received[-1].effort[0] if received else math.nan


def test_it_says_what_the_motors_do_not_hold(client, pendulum):
    _, received, health = pendulum()
    action = partial(held, client, 0.6 * WEIGHT)
    client.until(lambda: newest(received) == pytest.approx(0.4 * WEIGHT, rel=1e-3), action)
    message = received[-1]
    assert list(message.name) == ['hinge']
    assert list(message.position) == [0.0] and list(message.velocity) == [0.0]
    assert message.header.stamp.sec > 0
    client.until(lambda: health.says('on'), action)
    assert health.newest.level == DiagnosticStatus.OK
    client.until(lambda: health.value('published') > 0, action)


def test_it_is_off_by_default_and_may_be_switched_at_any_time(client, pendulum):
    _, received, health = pendulum(publish_external_torque='false')
    action = partial(held, client, 0.0)
    client.until_heard(action)
    client.until(lambda: client.node.count_publishers(TOPIC))
    client.until(lambda: health.says('off'), action)
    client.during(0.3, action)
    assert received == []
    switch(client, True, action)
    client.until(lambda: newest(received) == pytest.approx(WEIGHT, rel=1e-3), action)
    switch(client, False, action)
    client.during(0.1, action)
    received.clear()
    client.during(0.3, action)
    assert received == []
    # What was observed before is not gone on with.
    switch(client, True, partial(held, client))
    client.until(lambda: received, partial(held, client))
    assert abs(received[0].effort[0]) < 1e-6


def test_the_gain_says_how_fast(client, pendulum):
    _, received, _ = pendulum(**{'external_torque.gain': 0.5})
    action = partial(held, client, 0.0)
    client.until(lambda: len(received) > 20, action)
    slow = received[-1].effort[0]
    assert 0.0 < slow < 0.5 * WEIGHT
    set_parameter(
        client,
        'external_torque.gain',
        action,
        type=ParameterType.PARAMETER_DOUBLE,
        double_value=200.0,
    )
    client.until(lambda: newest(received) == pytest.approx(WEIGHT, rel=1e-3), action)


@pytest.mark.parametrize(
    'velocity, effort, text, to_do',
    [
        ((), WEIGHT, 'no velocity in joint_states of hinge', 'velocity state interface'),
        ((0.0,), None, 'no effort in joint_states of hinge', 'effort state interface'),
        ((0.0,), math.nan, 'no effort in joint_states of hinge', 'effort state interface'),
    ],
    ids=['no velocity', 'no effort', 'effort is NaN'],
)
def test_what_is_not_known_is_said_and_nothing_is_published(
    client, pendulum, velocity, effort, text, to_do
):
    process, received, health = pendulum()
    torques = client.listen(JointState, '/dynamics_node/gravity_torque')
    action = partial(held, client, effort, velocity)
    client.until(lambda: health.says(text), action)
    assert health.newest.level == DiagnosticStatus.WARN
    assert received == []
    # The torque does not need it.
    client.until(lambda: newest(torques) == pytest.approx(WEIGHT), action)
    client.until(lambda: received, partial(held, client))
    process.close()
    _, output = process.wait()
    warnings = [line for line in output.splitlines() if '~/external_torque is not' in line]
    assert len(warnings) == 1  # however many states came
    assert text in warnings[0] and to_do in warnings[0]


@pytest.mark.parametrize(
    'name, value',
    [
        (
            'gravity',
            {
                'type': ParameterType.PARAMETER_DOUBLE_ARRAY,
                'double_array_value': [0.0, 0.0, -4.905],
            },
        ),
        ('payload.mass', {'type': ParameterType.PARAMETER_DOUBLE, 'double_value': 1.0}),
    ],
    ids=['gravity', 'payload'],
)
def test_another_model_counts(client, pendulum, name, value):
    _, received, health = pendulum(**{'payload.link': 'rod', 'payload.com': '[0.3, 0.0, 0.0]'})
    action = partial(held, client, 0.0)
    client.until(lambda: newest(received) == pytest.approx(WEIGHT, rel=1e-3), action)
    client.until(lambda: health.says('on'), action)
    set_parameter(client, name, action, **value)
    loaded = RobotModel.from_urdf(PENDULUM).with_payload('rod', 1.0, (0.3, 0.0, 0.0))
    expected = 0.5 * WEIGHT if name == 'gravity' else loaded.gravity_torque([0.0])[0]
    assert expected != pytest.approx(WEIGHT, rel=0.1)
    client.until(lambda: newest(received) == pytest.approx(expected, rel=1e-3), action)


def test_states_that_are_too_rare_are_said(client, pendulum):
    process, received, health = pendulum()

    def seldom():
        held(client)
        time.sleep(0.15)

    client.until(lambda: health.says('joint states come more than 0.1 s apart'), seldom)
    assert health.newest.level == DiagnosticStatus.WARN
    assert received == []
    client.until(lambda: received and health.says('on'), partial(held, client))
    process.close()
    _, output = process.wait()
    assert 'more than 0.1 s apart: ~/external_torque is not published; raise the rate' in output


def test_a_gap_begins_anew(client, pendulum):
    _, received, health = pendulum()
    action = partial(held, client, 0.0)
    client.until(lambda: newest(received) == pytest.approx(WEIGHT, rel=1e-3), action)
    client.during(0.3)
    received.clear()
    client.until(lambda: received, partial(held, client))
    assert abs(received[0].effort[0]) < 1e-6
    client.until(lambda: health.value('begun') >= 2, partial(held, client))


def test_parts_of_a_state_are_put_together(client, start):
    # Arm and gripper have a broadcaster each; what is not measured at the same time is no state.
    start(
        robot_description_file=ARM7,
        publish_external_torque='true',
        state_timeout=1.0,
        allow_several_state_publishers='true',
    )
    received = client.listen(JointState, TOPIC)
    model = RobotModel.from_urdf(ARM7)
    names, n = list(model.joint_names), len(model.joint_names)
    q = np.clip(np.full(n, 0.3), *model.position_limits.T)
    outside = np.linspace(1.0, -2.0, n)
    effort = model.gravity_torque(q) - outside

    def halves():
        stamp = client.node.get_clock().now().to_msg()
        for part in (slice(0, 5), slice(5, n)):
            message = JointState(
                name=names[part],
                position=q[part].tolist(),
                velocity=[0.0] * len(names[part]),
                effort=effort[part].tolist(),
            )
            message.header.stamp = stamp
            client.states.publish(message)

    client.until(lambda: received and np.allclose(received[-1].effort, outside, atol=1e-3), halves)
    stamps = [
        message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in received
    ]
    assert len(set(stamps)) == len(stamps)


def test_chosen_joints_come_in_the_chosen_order(client, start):
    model = RobotModel.from_urdf(ARM7)
    chosen = [model.joint_names[i] for i in (3, 1)]
    start(
        robot_description_file=ARM7,
        joints=f'[{", ".join(chosen)}]',
        state_timeout=1.0,
        publish_external_torque='true',
    )
    received = client.listen(JointState, TOPIC)
    q = model.neutral_position
    q[[3, 1]] = -0.7, 0.5
    expected = model.gravity_torque(q)[[3, 1]] - [1.0, 2.0]
    client.until(
        lambda: received and np.allclose(received[-1].effort, expected, atol=1e-3),
        lambda: client.publish(chosen, [-0.7, 0.5], [0.0, 0.0], [1.0, 2.0]),
    )
    assert list(received[-1].name) == chosen


def test_without_stamps_the_arrival_counts(client, pendulum):
    _, received, _ = pendulum()

    def publish():
        client.states.publish(
            JointState(name=['hinge'], position=[0.0], velocity=[0.0], effort=[0.0])
        )

    client.until(lambda: newest(received) == pytest.approx(WEIGHT, rel=1e-3), publish)
    assert abs(received[-1].header.stamp.sec - time.time()) < 60.0
    assert received[-1].header.stamp != Time()


def test_efforts_that_can_hardly_be_torques_are_doubted(client, pendulum):
    process, received, health = pendulum()
    current = 0.1 * WEIGHT
    client.until(lambda: health.says('hinge reports'), partial(held, client, current))
    assert health.newest.level == DiagnosticStatus.WARN
    assert f'hinge reports {current:.4g} at rest' in health.newest.message
    assert f'{WEIGHT:.4g} holds it' in health.newest.message
    assert received  # said, and published all the same
    client.until(lambda: health.says('on'), partial(held, client))
    process.close()
    _, output = process.wait()
    assert 'can hardly be torque: hinge reports' in output and 'docs/arms.md' in output


# What begins anew, in this process -----------------------------------------------------------

SECOND = 1_000_000_000
NEEDLE = (
    PENDULUM.read_text()
    .replace('type="continuous"', 'type="revolute"')
    .replace('<limit ', '<limit lower="-9" upper="9" ')
)


class Direct:
    """The publisher and a robot, and states that are put into its buffer."""

    def __init__(self, client, urdf=NEEDLE, joints=()):
        self.robot = ActiveRobot(RobotModel.from_urdf(urdf), joints)
        self.parameters = {'publish_external_torque': True, 'external_torque.gain': 100.0}
        self.messages = []
        publisher = types.SimpleNamespace(publish=self.messages.append)
        node = types.SimpleNamespace(
            get_logger=client.node.get_logger, create_publisher=lambda *_, **__: publisher
        )
        self.unit = ExternalTorque(NodeContext(node, self.parameters))
        assert self.unit.configure()

    def state(self, time, position=0.0, effort=0.0):
        """Take a state of the needle; see `take`."""
        return self.take(time, ['hinge'], [position], [0.0], [effort])

    def take(self, time, names, position, velocity, effort):
        """Take a state of a time, s, and return how many messages came of it."""
        before, stamp = self.unit.published, round((1000 + time) * SECOND)
        self.robot.buffer.follow_clock(stamp)
        try:
            self.robot.buffer.update(time, list(names), position, velocity, stamp, stamp, effort)
        except RejectedStateError:
            return 0
        if not self.robot.buffer.is_complete:
            return 0
        self.unit.on_state(self.robot, Time(), gravity_torque(self.robot))
        return self.unit.published - before

    @property
    def estimate(self):
        """The newest estimate that was published."""
        return list(self.messages[-1].effort)

    @property
    def begun(self):
        """How often the observer has begun."""
        return int(self.unit.health()[1]['begun'])


@pytest.fixture
def direct(client):
    """Return a publisher that has observed some states."""
    direct = Direct(client)
    assert [direct.state(0.01 * i) for i in range(5)] == [0, 1, 1, 1, 1]
    assert direct.begun == 1
    return direct


def jump(direct):
    # Further than the joint can have moved, three times: then the new place is believed.
    assert [direct.state(0.05 + 0.001 * i, position=8.0) for i in range(3)] == [0, 0, 0]


def other_robot(direct):
    direct.robot = ActiveRobot(RobotModel.from_urdf(NEEDLE), ())


def other_gain(direct):
    direct.parameters['external_torque.gain'] = 50.0


def off_and_on(direct):
    for value in (False, True):
        direct.parameters['publish_external_torque'] = value
        assert direct.unit.configure() == value


def unknown_effort(direct):
    assert direct.state(0.05, effort=math.nan) == 0


@pytest.mark.parametrize(
    'event, time, position',
    [
        (jump, 0.06, 8.0),
        (other_robot, 0.06, 0.0),
        (other_gain, 0.06, 0.0),
        (off_and_on, 0.06, 0.0),
        (unknown_effort, 0.06, 0.0),
        (lambda direct: None, 0.5, 0.0),
        (lambda direct: None, -9.0, 0.0),
    ],
    ids=['jump', 'description', 'gain', 'off and on', 'unknown effort', 'gap', 'clock back'],
)
def test_what_breaks_the_observation_begins_it_anew(direct, event, time, position):
    event(direct)
    assert direct.state(time, position) == 0
    assert direct.begun == 2
    assert direct.state(time + 0.01, position) == 1


def test_nothing_else_begins_it_anew(direct):
    for i in range(5, 50):
        assert direct.state(0.01 * i) == 1
    assert direct.begun == 1


def test_gravity_that_turns_with_every_state_hides_no_push(direct):
    # A base that tilts: without a weight of the motors' own, all of the weight is a push.
    for i in range(5, 60):
        y = 0.01 * i
        direct.robot.model = direct.robot.model.with_gravity((0.0, y, -9.81))
        assert direct.state(0.01 * i) == 1
    assert direct.begun == 1
    assert direct.estimate == pytest.approx([WEIGHT], rel=1e-3)


def test_parts_of_different_times_are_one_state_when_all_have_come(client):
    # Arm and wrist swing, by their own motors alone, and are measured 1 ms apart.
    model = RobotModel.from_urdf(ARM7)
    direct, names = Direct(client, ARM7), model.joint_names
    n = len(names)
    estimates = []
    for i in range(200):
        for part, late in ((slice(0, 5), 0.0), (slice(5, n), 0.001)):
            time = 0.01 * i + late
            q, qd, qdd = swing(time, model)
            effort = model.inverse_dynamics(q, qd, qdd) + model.friction_torque(qd)
            published = direct.take(time, names[part], q[part], qd[part], effort[part])
            assert published == (i > 0 and late > 0.0)
        if i:
            estimates.append(direct.estimate)
    # Twice the motion within one time and none within the next made 3 N m of it.
    assert np.abs(estimates).max() < 0.2


def swing(time, model):
    """Return position, velocity and acceleration of a slow swing within the limits."""
    size = np.minimum(0.3, 0.2 * np.ptp(model.position_limits, axis=1))
    phase = np.pi * time + np.arange(len(size))
    return (
        model.position_limits.mean(axis=1) + size * np.sin(phase),
        np.pi * size * np.cos(phase),
        -(np.pi**2) * size * np.sin(phase),
    )


def test_a_doubt_outlives_the_observer_that_began_before_it(direct):
    for i in range(5, 220):
        direct.state(0.01 * i)  # of an arm that reports zeros
    assert direct.unit.health()[0].startswith('hinge reports 0 at rest')
    other_gain(direct)
    direct.state(2.2)
    assert direct.unit.health()[0].startswith('hinge reports 0 at rest')
    other_robot(direct)  # its joints have the same names
    direct.state(2.21)
    assert direct.unit.health()[0].startswith('hinge reports 0 at rest')


def test_an_unknown_effort_begins_the_rest_anew(direct):
    for begin in (0.05, 1.6):
        assert direct.state(begin, effort=math.nan) == 0
        for i in range(1, 150):
            direct.state(begin + 0.01 * i)
        assert direct.unit.health()[0] == ''
    for i in range(1, 60):
        direct.state(3.1 + 0.01 * i)
    assert direct.unit.health()[0].startswith('hinge reports 0 at rest')


def test_the_chosen_joints_are_doubted_by_their_own_limits(client):
    # The wrist carries more of its small limit than the shoulder of its large one.
    chosen = ['wrist_pitch', 'shoulder_pitch']
    direct = Direct(client, ARM7, chosen)
    G = None
    for i in range(220):
        direct.take(0.01 * i, chosen, [1.2, 0.05], [0.0, 0.0], [0.0, 0.0])
        G = gravity_torque(direct.robot)
    limits = direct.robot.effort_limits(())
    most = chosen[int(np.argmax(np.abs(G) / limits))]
    assert most != chosen[int(np.argmax(np.abs(G)))]
    assert direct.unit.health()[0].startswith(f'{most} reports 0 at rest')


def test_an_error_in_it_leaves_the_torque_alone(direct, capfd):
    before = direct.unit.published
    direct.robot.buffer = None  # as nothing in the node does it
    direct.unit.on_state(direct.robot, Time(), None)
    assert direct.unit.published == before
    assert 'Traceback' in capfd.readouterr().err
