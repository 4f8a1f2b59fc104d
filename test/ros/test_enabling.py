"""The reasons against enabling, and events during the query of the controllers."""

import time
from types import SimpleNamespace

from dynamics_node import RobotModel
from dynamics_node.kernels.warm_up import warm_up
from dynamics_node.ros.context import NodeContext
from dynamics_node.ros.node import effort_limiter
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
from dynamics_node.ros.torque_path.enabling import Enabling
from dynamics_node.safety import OutputSettings, TorquePath
import pytest
from std_srvs.srv import SetBool
from support.robots import PENDULUM


class Output:
    """A command output without ROS."""

    topic = '/efforts'
    publisher = None

    def __init__(self):
        self.path = TorquePath(OutputSettings(60.0, 1.0, 1.0, 'ramp_to_zero'))
        self.errors = []
        self.on_internal_error = self.errors.append

    def has_listener(self):
        return True

    def enable(self):
        return self.path.enable(time.monotonic())


class Controllers:
    """Controllers whose answers the test controls."""

    def __init__(self):
        self.queries, self.waits = 0, True
        self.mismatches, self.pending, self.listeners = [], [], {}

    def ask_again(self):
        self.queries += 1

    def update(self):
        pass

    def is_waiting(self):
        return self.waits

    def refusals(self, joint_names):
        return self.mismatches

    def notes(self):
        return self.pending

    def has_listener(self):
        return True


class Parts(SimpleNamespace):
    """An `Enabling` and what it uses."""

    @property
    def robot(self):
        return self.context.robot

    def use(self, model, joints=()):
        self.context.robot = ActiveRobot(model, joints)
        self.output.path.use(self.robot.buffer)
        self.output.path.configure(
            time.monotonic(),
            OutputSettings(60.0, 1.0, 1.0, 'ramp_to_zero'),
            self.robot.compensation(self.parameters.values),
            effort_limiter(self.robot, self.parameters.values),
            self.robot.motion_limits(()),
        )

    def use_text(self, old, new, joints=()):
        """Use a changed pendulum, and its state."""
        text = PENDULUM.read_text()
        assert old in text
        self.use(RobotModel.from_urdf(text.replace(old, new)), joints)
        self.fresh()

    def set(self, **changes):
        self.parameters.values = check_all(
            {
                **self.parameters.values,
                **{name.replace('__', '.'): value for name, value in changes.items()},
            }
        )

    def fresh(self, velocities=(0.0,), **message):
        # Level: the gravity torque is 10.3 N m, at a limit of 20.
        self.robot.buffer.update(
            time.monotonic(), list(self.robot.joint_names), [0.0], velocities=velocities, **message
        )

    def begin(self):
        """Ask for the output; return the task that will have the answer."""
        task = self.client.executor.create_task(self.enabling.enable)
        self.client.during(0.1)
        return task

    def answer(self, task):
        """Have the controllers answer; return the result of a task."""
        self.controllers.waits = False
        self.client.until(task.done)
        return task.result()

    def enable(self):
        """Ask for the output with controllers that answer at once; return the answer."""
        self.controllers.waits = False
        return self.answer(self.begin())


@pytest.fixture
def parts(client):
    warm_up()  # a kernel that is compiled while the controllers are asked takes longer than 10 s

    class Parameters:
        values = check_all({'state_timeout': 10.0})

        def __getitem__(self, name):
            return self.values[name]

    parameters = Parameters()
    parts = Parts(
        client=client,
        context=NodeContext(client.node, parameters),
        output=Output(),
        controllers=Controllers(),
        conflicts=[],
        descriptions=[],
        parameters=parameters,
    )
    parts.use(RobotModel.from_urdf(PENDULUM))
    parts.enabling = Enabling(
        parts.context,
        parts.output,
        SimpleNamespace(
            conflicts=lambda: parts.conflicts, description_conflicts=lambda: parts.descriptions
        ),
        parts.controllers,
        SimpleNamespace(offer_pending=lambda: None),
    )
    parts.fresh()
    return parts


def test_the_output_starts_when_the_controllers_have_answered(parts):
    task = parts.begin()
    assert parts.controllers.queries == 1
    assert not task.done()
    assert parts.output.path.state.name == 'READY'
    assert parts.answer(task) == (
        True,
        'enabled: full effort in 0.5 s (start_ramp), on /efforts; release brakes '
        'when ~/state is ACTIVE, not before',
    )
    assert parts.output.path.state.name == 'STARTING'
    assert parts.enable() == (True, 'already enabled: STARTING')


@pytest.mark.parametrize(
    'changes, reason, confirmation',
    [
        (
            {'effort_limits': [4.0]},
            'the arm cannot hold itself where it is, gravity torque is above the effort limit: '
            'hinge: 10.3005, limit 4',
            {'compensate__gravity': False},
        ),
        (
            {'gravity': [0.0, 0.0, 9.81]},
            'points up in the frame of',
            {'allow_upward_gravity': True},
        ),
        (
            {'effort_limits': [200.0]},
            'effort_limits of hinge: 200, in the URDF 20: lower it, or set '
            'allow_limits_above_urdf',
            {'allow_limits_above_urdf': True},
        ),
        (
            {'velocity_limits': [30.0]},
            'velocity_limits of hinge: 30, in the URDF 20: lower it, or set '
            'allow_limits_above_urdf',
            {'allow_limits_above_urdf': True},
        ),
    ],
    ids=['too heavy', 'upward gravity', 'effort limits', 'velocity limits'],
)
def test_dangerous_parameters_are_refused_until_confirmed(parts, changes, reason, confirmation):
    parts.set(**changes)
    success, message = parts.enable()
    assert not success
    assert reason in message
    parts.set(**confirmation)
    assert parts.enable()[0]


@pytest.mark.parametrize(
    'plugin, is_refused',
    [
        ('ur_robot_driver/URPositionHardwareInterface', True),
        ('mock_components/GenericSystem', False),
    ],
)
def test_an_arm_that_compensates_itself_is_refused(parts, plugin, is_refused):
    parts.use_text(
        '</robot>',
        f'<ros2_control name="a" type="system"><hardware><plugin>{plugin}</plugin></hardware>'
        '</ros2_control></robot>',
    )
    success, message = parts.enable()
    assert success != is_refused
    if is_refused:
        assert f'{plugin} (a Universal Robots arm), which compensates gravity itself' in message
        assert 'allow_self_compensating_arm' in message
        parts.set(allow_self_compensating_arm=True)
        assert parts.enable()[0]


FLAP = (
    '<link name="tool"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" '
    'iyz="0" izz="1"/></inertial></link><joint name="flap" type="revolute"><parent link="rod"/>'
    '<child link="tool"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/>'
    '</joint></robot>'
)


@pytest.mark.parametrize(
    'prepare, note',
    [
        (
            lambda parts: parts.use_text('velocity="20"', ''),
            'jumps and runaway of hinge are not detected: the URDF has no velocity limit there; '
            'set velocity_limits',
        ),
        (
            lambda parts: parts.fresh(velocities=()),
            'joint_states have no velocity of hinge: a runaway is detected only',
        ),
        (
            lambda parts: parts.use_text('</robot>', FLAP, ['hinge']),
            'taken where last measured, or neutral if never: flap',
        ),
        (
            lambda parts: parts.fresh(efforts=[-9.5]),
            'joint_states report efforts that this node has not sent (hinge: -9.5): if a '
            'controller still holds them',
        ),
        (
            lambda parts: setattr(parts.robot, 'refused_since', 'it is not XML'),
            'a newer robot description was refused (it is not XML)',
        ),
    ],
    ids=['velocity limit', 'velocity', 'unmeasured joint', 'effort', 'description'],
)
def test_what_the_node_cannot_check_is_named_in_the_answer(parts, prepare, note):
    prepare(parts)
    success, message = parts.enable()
    assert success
    assert note in message


def test_every_reason_is_listed_at_once(parts):
    parts.conflicts.append('1 other publisher')
    parts.descriptions.append('2 publishers on /robot_description')
    parts.robot.buffer.forget()
    parts.robot.buffer.rejected['stamp'] = 7
    assert parts.enable() == (
        False,
        (
            'refused: no joint state within 10 s for hinge (dropped so far: 7 for stamp); '
            '1 other publisher; 2 publishers on /robot_description'
        ),
    )
    assert parts.controllers.queries == 0


def test_a_mass_matrix_that_is_not_positive_definite_is_refused(parts):
    parts.robot.is_mass_matrix_positive_definite = lambda: False
    assert parts.enable()[1].startswith('refused: the mass matrix is not positive definite')


def test_a_mismatch_of_the_controllers_and_a_failing_query_are_refused(parts):
    parts.controllers.mismatches.append('another order')
    assert parts.enable() == (False, 'refused: another order')

    def fail():
        raise RuntimeError('no graph')

    parts.controllers.update = fail
    task = parts.client.executor.create_task(
        parts.enabling._requested, SetBool.Request(data=True), SetBool.Response()
    )
    parts.client.until(task.done)
    assert not task.result().success
    assert task.result().message == 'internal error: no graph'
    assert parts.output.errors == ['internal error in ~/enable: no graph']
    assert parts.output.path.state.name == 'READY'


def test_a_robot_that_changes_during_the_query_is_refused(parts):
    task = parts.begin()
    parts.use_text('"hinge"', '"pivot"')
    assert parts.answer(task) == (
        False,
        ('refused: the robot description has changed while the controllers were asked: ask again'),
    )
    assert parts.enable()[0]


def test_simultaneous_requests_get_one_answer_each(parts):
    tasks = [parts.begin(), parts.begin(), parts.begin()]
    assert parts.controllers.queries == 1
    parts.controllers.waits = False
    parts.client.until(lambda: all(task.done() for task in tasks))
    answers = [task.result() for task in tasks]
    assert all(success for success, _ in answers)
    assert sum(message.startswith('enabled') for _, message in answers) == 1


def test_a_request_to_disable_cancels_the_enabling(parts):
    task = parts.begin()
    assert parts.enabling.disable() == (True, 'already off: READY')
    assert parts.answer(task) == (False, 'disabled on request before it was enabled')
    assert parts.output.path.state.name == 'READY'


def test_enabling_is_refused_during_the_shutdown(parts):
    task = parts.begin()
    parts.output.path.close(time.monotonic(), 'SIGTERM', 2.5)
    assert parts.answer(task) == (False, 'refused: the node is shutting down')


def test_efforts_that_an_inactive_controller_may_hold_cannot_be_released(parts):
    assert parts.enable()[0]
    path = parts.output.path
    for after in (0.0, 0.01):
        now = time.monotonic() + after
        command = path.process_joint_state(now, ['hinge'], [0.0], [0.0], 0, 1)
        path.published(now)
    assert command.any()
    path.lose_controller(time.monotonic(), '/c is inactive')
    parts.controllers.listeners['/c'] = SimpleNamespace(inactive=lambda: ['/c is inactive'])
    success, message = parts.enabling.disable()
    assert not success
    assert 'the last efforts may be in force at the hardware (hinge: ' in message
    parts.controllers.listeners.clear()
    assert parts.enabling.disable() == (True, 'releasing the efforts in force')
