"""The topic ~/external_torque: estimates, missing inputs and restarts, over DDS and directly."""

from functools import partial
import math
import time
import types

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from dynamics_node import RobotModel
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.publishers.external_torque import ExternalTorque
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.safety import RejectedStateError
import numpy as np
import pytest
from sensor_msgs.msg import JointState
from support.processes import Diagnostics
from support.robots import ARM7, HOLD, PENDULUM

TOPIC = '/dynamics_node/external_torque'
SWITCH = 'publish_external_torque'
ARM = RobotModel.from_urdf(ARM7)
PART = 'external torque'  # of the diagnostics


@pytest.fixture(scope='module')
def shared_parameters():
    return {
        'robot_description_file': PENDULUM,
        'publish_external_torque': 'true',
        'state_timeout': 1.0,
        'payload.link': 'rod',
        'payload.com': '[0.3, 0.0, 0.0]',
    }


@pytest.fixture
def received(shared):
    return shared.listen(JointState, TOPIC)


@pytest.fixture
def own(client, start):
    """Return the process of an own node, its estimates and its diagnostics."""
    process = start(
        robot_description_file=PENDULUM, publish_external_torque='true', state_timeout=1.0
    )
    return process, client.listen(JointState, TOPIC), Diagnostics(client)


def gravity_torque(robot):
    """Return G of the chosen joints at the newest state."""
    return robot.model.gravity_torque(robot.buffer.position)[robot.selection.index]


def held(client, effort=HOLD, velocity=(0.0,)):
    """Return an action that publishes the pendulum at rest, with an effort or none."""
    efforts = [] if effort is None else [effort]
    return partial(client.publish, ['hinge'], [0.0], velocity, efforts)


def newest(received):
    """Return the newest estimate of the first joint, NaN if there is none."""
    return received[-1].effort[0] if received else math.nan


def settle(client, received, expected, action):
    """Wait for an estimate."""
    client.until(lambda: newest(received) == pytest.approx(expected, rel=1e-3), action)


def test_the_estimate_is_the_torque_that_the_motors_do_not_hold(client, own):
    _, received, diagnostics = own
    action = held(client, 0.6 * HOLD)
    settle(client, received, 0.4 * HOLD, action)
    message = received[-1]
    assert list(message.name) == ['hinge']
    assert list(message.position) == [0.0] and list(message.velocity) == [0.0]
    assert message.header.stamp.sec > 0
    client.until(lambda: 'on' in diagnostics.message(PART), action)
    assert diagnostics.status(PART).level == DiagnosticStatus.OK
    client.until(lambda: int(diagnostics.values(PART).get('published', 0)) > 0, action)


def test_the_topic_is_switched_at_any_time(shared, received, change):
    action, diagnostics = held(shared, 0.0), Diagnostics(shared)
    change(SWITCH, False, action)
    shared.until(lambda: 'off' in diagnostics.message(PART), action)
    shared.until(lambda: shared.node.count_publishers(TOPIC))
    received.clear()
    shared.during(0.3, action)
    assert received == []
    change(SWITCH, True, action)
    settle(shared, received, HOLD, action)
    change(SWITCH, False, action)
    shared.during(0.1, action)
    received.clear()
    shared.during(0.3, action)
    assert received == []
    # The observation before does not count.
    change(SWITCH, True, held(shared))
    shared.until(lambda: received, held(shared))
    assert abs(received[0].effort[0]) < 1e-6


def test_the_gain_sets_the_speed(shared, received, change):
    action = held(shared, 0.0)
    change('external_torque.gain', 0.5, held(shared))
    shared.until(lambda: abs(newest(received)) < 1e-6, held(shared))
    received.clear()
    shared.until(lambda: len(received) > 20, action)
    assert 0.0 < newest(received) < 0.5 * HOLD
    change('external_torque.gain', 200.0, action)
    settle(shared, received, HOLD, action)


def test_missing_inputs_are_reported_once_and_nothing_is_published(client, own):
    process, received, diagnostics = own
    torques = client.listen(JointState, '/dynamics_node/gravity_torque')
    cases = [
        (held(client, HOLD, ()), 'no velocity in joint_states of hinge'),
        (held(client, None), 'no effort in joint_states of hinge'),
        (held(client, math.nan), 'no effort in joint_states of hinge'),
    ]
    for action, text in cases:
        client.until(lambda: text in diagnostics.message(PART), action)  # noqa: B023
        assert diagnostics.status(PART).level == DiagnosticStatus.WARN
        received.clear(), torques.clear()
        # ~/gravity_torque does not need it.
        client.until(lambda: newest(torques) == pytest.approx(HOLD), action)
        assert received == []
        client.until(lambda: received and diagnostics.message(PART) == 'on', held(client))
    # Joint states at a too low rate.
    too_slow = 'joint states come more than 0.1 s apart'
    client.until(lambda: too_slow in diagnostics.message(PART), held(client), period=0.15)
    assert diagnostics.status(PART).level == DiagnosticStatus.WARN
    client.during(0.2)
    received.clear()
    client.during(0.5, held(client), period=0.15)
    assert received == []
    client.until(lambda: received and diagnostics.message(PART) == 'on', held(client))
    output = process.end()[1]
    for text, to_do in (
        (cases[0][1], 'velocity state interface'),
        (cases[1][1], 'effort state interface'),
        (too_slow, 'raise the rate'),
    ):
        [warning] = [line for line in output.splitlines() if text in line]
        assert '~/external_torque is not published' in warning and to_do in warning


@pytest.mark.parametrize('name, value', [('gravity', [0.0, 0.0, -4.905]), ('payload.mass', 1.0)])
def test_the_estimate_follows_a_change_of_the_model(shared, received, change, name, value):
    action = held(shared, 0.0)
    settle(shared, received, HOLD, action)
    change(name, value, action)
    loaded = RobotModel.from_urdf(PENDULUM).with_payload('rod', 1.0, (0.3, 0.0, 0.0))
    expected = 0.5 * HOLD if name == 'gravity' else loaded.gravity_torque([0.0])[0]
    assert expected != pytest.approx(HOLD, rel=0.1)
    settle(shared, received, expected, action)


def test_partial_states_are_combined_in_the_chosen_order(client, start):
    # Arm and gripper have a broadcaster each. Parts with different stamps are not one state.
    n = len(ARM.joint_names)
    order = [3, 1, *(i for i in range(n) if i not in (1, 3))]
    chosen = [ARM.joint_names[i] for i in order]
    start(
        robot_description_file=ARM7,
        publish_external_torque='true',
        state_timeout=1.0,
        allow_several_state_publishers='true',
        joints=f'[{", ".join(chosen)}]',
    )
    received = client.listen(JointState, TOPIC)
    q = np.clip(np.full(n, 0.3), *ARM.position_limits.T)
    outside = np.linspace(1.0, -2.0, n)
    effort = ARM.gravity_torque(q) - outside

    def halves():
        stamp = client.node.get_clock().now().to_msg()
        for part in (slice(0, 5), slice(5, n)):
            names = list(ARM.joint_names[part])
            message = JointState(
                name=names,
                position=q[part].tolist(),
                velocity=[0.0] * len(names),
                effort=effort[part].tolist(),
            )
            message.header.stamp = stamp
            client.states.publish(message)

    client.until(
        lambda: received and np.allclose(received[-1].effort, outside[order], atol=1e-3), halves
    )
    assert list(received[-1].name) == chosen
    stamps = {(message.header.stamp.sec, message.header.stamp.nanosec) for message in received}
    assert len(stamps) == len(received)


def test_the_arrival_replaces_a_missing_stamp(shared, received):
    state = JointState(name=['hinge'], position=[0.0], velocity=[0.0], effort=[0.0])
    settle(shared, received, HOLD, lambda: shared.states.publish(state))
    assert abs(received[-1].header.stamp.sec - time.time()) < 60.0
    assert received[-1].header.stamp != Time()


def test_implausible_efforts_are_reported(client, own):
    process, received, diagnostics = own
    current = 0.1 * HOLD
    text = f'hinge reports {current:.4g} at rest'
    client.until(lambda: text in diagnostics.message(PART), held(client, current))
    assert diagnostics.status(PART).level == DiagnosticStatus.WARN
    assert f'{HOLD:.4g} holds it' in diagnostics.message(PART)
    assert received  # published, too
    client.until(lambda: diagnostics.message(PART) == 'on', held(client))
    output = process.end()[1]
    assert 'can hardly be torque: hinge reports' in output and 'docs/arms.md' in output


# Restarts of the observer, in this process --------------------------------------------------

SECOND = 1_000_000_000
NEEDLE = (
    PENDULUM.read_text()
    .replace('type="continuous"', 'type="revolute"')
    .replace('<limit ', '<limit lower="-9" upper="9" ')
)


class Direct:
    """The publisher and a robot, with states written directly into its buffer."""

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
        """Take a state of a time, s; return the number of published messages."""
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
        """The newest published estimate."""
        return list(self.messages[-1].effort)

    @property
    def is_doubted(self):
        """Whether the health reports the zeros of the hinge."""
        return self.unit.health()[0].startswith('hinge reports 0 at rest')

    @property
    def begun(self):
        """Number of starts of the observer."""
        return int(self.unit.health()[1]['begun'])


@pytest.fixture
def direct(client):
    """Return a publisher after some observed states."""
    direct = Direct(client)
    assert [direct.state(0.01 * i) for i in range(5)] == [0, 1, 1, 1, 1]
    assert direct.begun == 1
    return direct


def jump(direct):
    # Further than the joint can move; after three of them the new position is accepted.
    assert [direct.state(0.05 + 0.001 * i, position=8.0) for i in range(3)] == [0, 0, 0]


def other_robot(direct):
    direct.robot = ActiveRobot(RobotModel.from_urdf(NEEDLE), ())


def other_gain(direct):
    direct.parameters['external_torque.gain'] = 50.0


def off_and_on(direct):
    for value in (False, True):
        direct.parameters['publish_external_torque'] = value
        assert direct.unit.configure() == value


@pytest.mark.parametrize(
    'event, time, position',
    [
        (jump, 0.06, 8.0),
        (other_robot, 0.06, 0.0),
        (other_gain, 0.06, 0.0),
        (off_and_on, 0.06, 0.0),
        (lambda direct: direct.state(0.05, effort=math.nan), 0.06, 0.0),
        (lambda direct: None, 0.5, 0.0),
        (lambda direct: None, -9.0, 0.0),
    ],
    ids=['jump', 'description', 'gain', 'off and on', 'unknown effort', 'gap', 'clock back'],
)
def test_a_break_restarts_the_observer(direct, event, time, position):
    event(direct)
    assert direct.state(time, position) == 0
    assert direct.begun == 2
    assert direct.state(time + 0.01, position) == 1


def test_gravity_that_changes_with_every_state_hides_no_push(direct):
    # A tilting base. The motors hold nothing: all of the weight is an external torque.
    for i in range(5, 60):
        y = 0.01 * i
        direct.robot.model = direct.robot.model.with_gravity((0.0, y, -9.81))
        assert direct.state(0.01 * i) == 1
    assert direct.begun == 1
    assert direct.estimate == pytest.approx([HOLD], rel=1e-3)


def test_parts_measured_at_different_times_are_one_complete_state(client):
    # Arm and wrist swing by their motors alone, and are measured 1 ms apart.
    direct, names = Direct(client, ARM7), ARM.joint_names
    n = len(names)
    estimates = []
    for i in range(200):
        for part, late in ((slice(0, 5), 0.0), (slice(5, n), 0.001)):
            time = 0.01 * i + late
            q, qd, qdd = swing(time, ARM)
            effort = ARM.inverse_dynamics(q, qd, qdd) + ARM.friction_torque(qd)
            published = direct.take(time, names[part], q[part], qd[part], effort[part])
            assert published == (i > 0 and late > 0.0)
        if i:
            estimates.append(direct.estimate)
    # 3 N m if two motions counted within one step and none within the next.
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


def test_a_doubt_survives_a_restart(direct):
    for i in range(5, 220):
        direct.state(0.01 * i)  # an arm that reports zeros
    assert direct.begun == 1  # regular states never restart it
    assert direct.is_doubted
    for begin, restart in ((2.2, other_gain), (2.21, other_robot)):  # of the same joint names
        restart(direct)
        direct.state(begin)
        assert direct.is_doubted


def test_an_unknown_effort_restarts_the_time_at_rest(direct):
    for begin in (0.05, 1.6):
        assert direct.state(begin, effort=math.nan) == 0
        for i in range(1, 150):
            direct.state(begin + 0.01 * i)
        assert direct.unit.health()[0] == ''
    for i in range(1, 60):
        direct.state(3.1 + 0.01 * i)
    assert direct.is_doubted


def test_chosen_joints_are_compared_with_their_own_limits(client):
    # The wrist carries a larger part of its limit than the shoulder.
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


def test_an_internal_error_is_only_logged(direct, capfd):
    before = direct.unit.published
    direct.robot.buffer = None  # a defect that the node does not have
    direct.unit.on_state(direct.robot, Time(), None)
    assert direct.unit.published == before
    assert 'Traceback' in capfd.readouterr().err
