"""The momentum observer estimates external efforts, and zero without them."""

import functools
import math

import dynamics_node
from dynamics_node import ArgumentError, MomentumObserver, RobotModel
from hypothesis import given
from hypothesis import strategies as st
import mujoco
import numpy as np
import pytest
from support.free_swing import free_arm
from support.mujoco_oracle import MujocoOracle
from support.pushed_motion import halved, irregular_times, Motion, PushedRobot, tip
from support.random_payload import with_payload_link
from support.robots import ARM7, PENDULUM, public_robot, random_urdf

GAIN = 100.0
SECONDS, BEGINS = 0.4, 0.2
WRENCH = np.array([10.0, -20.0, 15.0, 1.0, -2.0, 1.5])  # N and N m
# N m s/rad, N m, rad/s; or N s/m, N, m/s.
VISCOUS, DRY, SMOOTHING = FRICTION = 2.0, 1.0, 0.5
# Of the largest effort that its motors make, at a mean step of 2 ms.
ERROR = 1e-3

ROBOTS = {
    'arm7': ARM7.read_text(),
    'Panda': public_robot('panda_description/urdf/panda.urdf').read_text(),
    'UR5': public_robot('ur_description/urdf/ur5_robot.urdf').read_text(),
    # Branches, prismatic and mimic joints.
    'tree 3': random_urdf(3),
    'tree 8': random_urdf(8),
    'only prismatic': random_urdf(5, joints=4, prismatic=1.0),
}

# A carriage of 2 kg on a level rail.
CARRIAGE = (
    '<robot name="carriage"><link name="rail"/><link name="carriage"><inertial>'
    '<mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    '</inertial></link><joint name="slide" type="prismatic"><parent link="rail"/>'
    '<child link="carriage"/><limit lower="-9" upper="9" effort="9" velocity="9"/>'
    '</joint></robot>'
)


@functools.cache
def moved(name, is_pushed):
    """Return the model of a robot, and its motion at irregular times and at twice as many."""
    model = RobotModel.from_urdf(ROBOTS[name]).with_friction(*FRICTION)
    robot = PushedRobot(ROBOTS[name], model.joint_names, FRICTION)
    times = irregular_times(np.random.default_rng(1), SECONDS, 0.002, [BEGINS])
    wrench = WRENCH if is_pushed else 0 * WRENCH

    def external(t, q):
        return robot.wrench_on_tip(q, wrench)

    return model, [robot.run(steps, external, GAIN, BEGINS) for steps in (times, halved(times))]


def observe(observer, motion, chosen=slice(None)):
    """Return the estimate at every time, shape (k, m)."""
    return np.array(
        [
            observer.update(t, q, qd, effort[chosen])
            for t, q, qd, effort in zip(
                motion.time, motion.q, motion.qd, motion.effort, strict=True
            )
        ]
    )


# Against MuJoCo ------------------------------------------------------------------------------


@pytest.mark.parametrize('name', ROBOTS)
@pytest.mark.parametrize('is_pushed', [True, False], ids=['pushed', 'not pushed'])
def test_it_estimates_a_push_on_a_moving_robot(name, is_pushed):
    model, motions = moved(name, is_pushed)
    errors = []
    for motion in motions:
        estimate = observe(MomentumObserver(model, GAIN), motion)
        errors.append(np.abs(estimate - motion.lagged).max())
    motion = motions[0]
    assert np.abs(motion.qd).max() > 3.0  # it does move
    assert errors[0] < ERROR * np.abs(motion.effort).max()
    # Nothing is wrong but that it sees the motion in steps: half the step, a fourth of the error.
    assert errors[1] < 0.3 * errors[0]
    if is_pushed:
        assert np.abs(motion.lagged[-1]).max() > 100 * errors[0]


def simulate(model, text, seconds=0.5, step=1e-4):
    """Return the Motion of a robot in MuJoCo's own integrator, with its forces at a body."""
    oracle = MujocoOracle(text)
    simulation, data = oracle.model, oracle.data
    simulation.opt.timestep, simulation.opt.integrator = step, mujoco.mjtIntegrator.mjINT_RK4
    rows = [simulation.joint(name).dofadr[0] for name in model.joint_names]
    n, jacobian = len(rows), np.zeros((6, simulation.nv))
    simulation.dof_damping[rows] = VISCOUS
    motors, hand = np.zeros(simulation.nv), np.random.default_rng(0).normal(0.0, 5.0, n)
    motors[rows] = np.linspace(20.0, -5.0, n)  # N m: constant, so that every sample is true
    data.qfrc_applied[:], lagged, samples = motors, np.zeros(n), []
    while data.time < seconds:
        if data.time > 0.2:
            data.xfrc_applied[tip(simulation)] = WRENCH
            data.qfrc_applied[rows] = motors[rows] + hand
        mujoco.mj_forward(simulation, data)
        mujoco.mj_jacBodyCom(simulation, data, jacobian[:3], jacobian[3:], tip(simulation))
        external = (jacobian.T @ data.xfrc_applied[tip(simulation)] + data.qfrc_applied - motors)[
            rows
        ]
        samples.append(
            (data.time, data.qpos[rows], data.qvel[rows], motors[rows], external, lagged)
        )
        lagged = lagged + (1 - math.exp(-GAIN * step)) * (external - lagged)
        mujoco.mj_step(simulation, data)
    return Motion(*(np.array(column) for column in zip(*samples, strict=True)))


def test_it_finds_a_push_in_a_mujoco_simulation():
    text = free_arm('arm7')
    model = RobotModel.from_urdf(text).with_friction(VISCOUS, 0.0)
    motion = simulate(model, text)
    # A state at the begin of the push: efforts count as constant between two states.
    begin = int(np.argmax(np.abs(motion.external).max(axis=1) > 0.0))
    chosen = np.cumsum(np.random.default_rng(2).integers(2, 9, 1300))
    errors = []
    for places in (2 * chosen, chosen):
        places = np.union1d(places[places < len(motion.time)], [begin])
        seen = Motion(*(column[places] for column in motion))
        estimate = observe(MomentumObserver(model, GAIN), seen)
        errors.append(np.abs(estimate - seen.lagged).max())
    assert np.abs(motion.qd).max() > 2.0
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < ERROR * np.abs(motion.lagged).max()


LOAD = {'mass': 2.0, 'com': [0.05, 0.02, 0.1], 'inertia': np.diag([0.01, 0.02, 0.015])}
ROTORS = 0.1  # kg m²


@functools.cache
def laden():
    """Return the arm with nothing, and the motion of one with payload, friction and rotors."""
    plain = RobotModel.from_urdf(ARM7).with_friction(0.0, 0.0)
    robot = PushedRobot(
        with_payload_link(ROBOTS['arm7'], 'hand', **LOAD), plain.joint_names, FRICTION
    )
    for name in plain.joint_names:
        robot.oracle.model.dof_armature[robot.oracle.model.joint(name).dofadr] = ROTORS
    times = irregular_times(np.random.default_rng(3), BEGINS, 0.002)
    return plain, robot.run(times, lambda t, q: np.zeros(robot.n), GAIN)


@pytest.mark.parametrize('unknown', ['payload', 'friction', 'rotors', 'nothing'])
def test_effects_missing_from_the_model_count_as_external(unknown):
    model, motion = laden()
    if unknown != 'payload':
        model = model.with_payload('hand', **LOAD)
    if unknown != 'friction':
        model = model.with_friction(*FRICTION)
    if unknown != 'rotors':
        model = model.with_rotor_inertia(ROTORS)
    largest = np.abs(observe(MomentumObserver(model, GAIN), motion)).max()
    assert (largest < 0.02) == (unknown == 'nothing')
    assert (largest > 1.0) == (unknown != 'nothing')


# Closed forms --------------------------------------------------------------------------------


@given(gain=st.floats(0.1, 1e4), seed=st.integers(0, 1000))
def test_a_step_appears_with_first_order_lag_for_any_time_steps(gain, seed):
    model = RobotModel.from_urdf(CARRIAGE)
    force, mass = 3.0, 2.0
    observer = MomentumObserver(model, gain)
    for t in irregular_times(np.random.default_rng(seed), 0.2, 0.01):
        estimate = observer.update(t, [0.5 * force / mass * t * t], [force / mass * t], [0.0])
        assert estimate[0] == pytest.approx(force * (1 - math.exp(-gain * t)), rel=1e-9, abs=1e-9)
    assert observer.observed == pytest.approx(0.2)


def test_at_rest_the_estimate_is_the_missing_motor_effort():
    model = RobotModel.from_urdf(PENDULUM)
    held = model.gravity_torque([0.4])[0]
    observer = MomentumObserver(model, 50.0)
    for step in range(100):
        estimate = observer.update(0.01 * step, [0.4], [0.0], [0.75 * held])
    # Something else carries the rest of its weight.
    assert estimate[0] == pytest.approx(0.25 * held)


# A choice of joints --------------------------------------------------------------------------


def test_selected_joints_in_any_order_are_independent():
    model, [motion, _] = moved('arm7', True)
    names = model.joint_names
    chosen = [5, 0, 3]
    whole = observe(MomentumObserver(model, GAIN), motion)
    observer = MomentumObserver(model, GAIN, [names[i] for i in chosen])
    assert observer.joint_names == tuple(names[i] for i in chosen)
    # The others move too.
    np.testing.assert_allclose(
        observe(observer, motion, chosen), whole[:, chosen], rtol=1e-12, atol=1e-10
    )


def test_unknown_velocities_of_other_joints_count_as_zero():
    model, [motion, _] = moved('arm7', True)
    chosen, others = [2, 1], [0, 3, 4, 5, 6, 7]
    unknown, resting = motion.qd.copy(), motion.qd.copy()
    unknown[:, others], resting[:, others] = np.nan, 0.0
    names = [model.joint_names[i] for i in chosen]
    np.testing.assert_array_equal(
        *(
            observe(MomentumObserver(model, GAIN, names), motion._replace(qd=qd), chosen)
            for qd in (unknown, resting)
        )
    )


# Beginning anew ------------------------------------------------------------------------------


@pytest.fixture
def carriage():
    """Return an observer of a carriage that was pushed for 0.1 s with 3 N."""
    observer = MomentumObserver(RobotModel.from_urdf(CARRIAGE), 100.0)
    for t in np.linspace(0.0, 0.1, 11):
        observer.update(t, [0.75 * t * t], [1.5 * t], [0.0])
    assert observer.estimate[0] == pytest.approx(3.0, rel=1e-3)
    return observer


@pytest.mark.parametrize('time', [0.1, 0.05, -1.0, 0.21, 1e9])
def test_a_time_that_does_not_increase_or_jumps_restarts_the_observer(carriage, time):
    assert carriage.update(time, [5.0], [2.0], [0.0]) == 0.0
    assert carriage.observed == 0.0
    # From there it goes on, and a carriage of constant speed is not pushed.
    assert carriage.update(time + 0.01, [5.02], [2.0], [0.0]) == 0.0


def test_the_longest_step_may_be_chosen():
    observer = MomentumObserver(RobotModel.from_urdf(CARRIAGE), 1.0, longest_step=2.0)
    observer.update(0.0, [0.0], [0.0], [0.0])
    assert observer.update(1.5, [1.0], [1.0], [0.0])[0] > 0.0


@pytest.mark.parametrize('is_pushed', [True, False], ids=['pushed', 'not pushed'])
def test_a_change_of_model_neither_adds_nor_hides_external_effort(is_pushed):
    # The model has a wrong payload at first and the right one from the middle on.
    plain, motion = laden()
    right = plain.with_payload('hand', **LOAD).with_friction(*FRICTION).with_rotor_inertia(ROTORS)
    effort = motion.effort - (5.0 if is_pushed else 0.0)
    observer = MomentumObserver(right, GAIN)
    for i, (t, q, qd) in enumerate(zip(motion.time, motion.q, motion.qd, strict=True)):
        # Another gravity that makes no difference to the momentum, and back, every other state.
        observer.follow(right.with_gravity((0.0, 1e-6 * (i % 2), -9.81)))
        observer.update(t, q, qd, effort[i])
    expected = 5.0 if is_pushed else 0.0
    assert observer.estimate == pytest.approx(np.full(len(observer.estimate), expected), abs=0.02)
    assert observer.observed == pytest.approx(motion.time[-1] - motion.time[0])
    before = observer.estimate
    observer.follow(right.with_payload('hand', 3.0))
    assert observer.estimate is before
    # The moment at which the momentum of the moving arm is another one is no blow.
    observer.follow(right)
    blow = right.mass_matrix(motion.q[-1]) - plain.mass_matrix(motion.q[-1])
    assert np.abs(GAIN * blow @ motion.qd[-1]).max() > 20.0
    observer = MomentumObserver(plain, GAIN)
    estimates = []
    for i, (t, q, qd) in enumerate(zip(motion.time, motion.q, motion.qd, strict=True)):
        if i == len(motion.time) // 2:
            wrong = np.abs(estimates).max()
            observer.follow(right)
        estimates.append(observer.update(t, q, qd, motion.effort[i]))
    assert np.abs(estimates).max() < 1.05 * wrong
    assert np.abs(estimates[-1]).max() < 0.1 * wrong


def test_a_model_of_other_joints_is_refused(carriage):
    with pytest.raises(ArgumentError, match='expected the joints slide, got hinge'):
        carriage.follow(RobotModel.from_urdf(PENDULUM))


def test_reset_restarts_the_observer(carriage):
    carriage.reset()
    assert carriage.estimate == 0.0 and carriage.observed == 0.0
    assert carriage.update(0.11, [9.0], [9.0], [9.0]) == 0.0


@pytest.mark.parametrize(
    'state',
    [
        (0.11, [math.nan], [0.0], [0.0]),
        (0.11, [0.0], [math.nan], [0.0]),
        (0.11, [0.0], [0.0], [math.nan]),
        (0.11, [0.0], [math.inf], [0.0]),
        (math.nan, [0.0], [0.0], [0.0]),
    ],
    ids=['position', 'velocity', 'effort', 'infinite', 'time'],
)
def test_a_nonfinite_state_restarts_the_observer(carriage, state):
    assert np.isnan(carriage.update(*state)).all()
    assert carriage.update(0.12, [0.0], [0.0], [0.0]) == 0.0
    assert carriage.observed == 0.0


def test_a_nonfinite_estimate_restarts_the_observer(carriage):
    # The momentum is finite; its rate over a nanosecond overflows.
    assert np.isnan(carriage.update(0.1 + 1e-9, [0.0], [1e300], [0.0])).all()
    assert np.isfinite(carriage.estimate).all() and carriage.observed == 0.0
    assert carriage.update(0.11, [0.0], [0.0], [0.0]) == 0.0
    assert carriage.update(0.12, [0.0], [0.0], [0.0]) == 0.0


def test_a_returned_estimate_is_never_changed(carriage):
    before = carriage.estimate
    kept = before.copy()
    carriage.update(0.11, [0.0], [0.0], [0.0])
    np.testing.assert_array_equal(before, kept)
    with pytest.raises(ValueError, match='read-only'):
        carriage.estimate[0] = 1.0


# Wrong arguments -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    'arguments, message',
    [
        ({'gain': 0.0}, 'gain: expected a positive finite number, 1/s, got 0.0'),
        ({'gain': math.nan}, 'gain: expected a positive'),
        ({'gain': 'fast'}, "got 'fast'"),
        ({'gain': 1.0, 'longest_step': -1}, 'longest_step: expected a positive finite number, s'),
        ({'gain': 1.0, 'joints': ['hing']}, "'hing' is not a joint"),
    ],
    ids=str,
)
def test_wrong_arguments_are_refused_with_the_reason(arguments, message):
    with pytest.raises(ArgumentError, match=message):
        MomentumObserver(RobotModel.from_urdf(PENDULUM), **arguments)


@pytest.mark.parametrize(
    'q, qd, effort, message',
    [
        (
            [0.0],
            [0.0, 0.0],
            [0.0],
            r'qd: expected shape \(1,\), one state of all joints, got \(2,\)',
        ),
        ([[0.0]], [0.0], [0.0], r'q: expected shape \(1,\)'),
        ([0.0], [0.0], [], r'effort: expected shape \(1,\), one state of the chosen joints, got'),
    ],
)
def test_wrong_shapes_are_refused_and_the_state_stays(carriage, q, qd, effort, message):
    before = carriage.estimate
    with pytest.raises(ArgumentError, match=message):
        carriage.update(0.11, q, qd, effort)
    assert carriage.estimate is before


def test_the_observer_is_exported_by_the_package():
    assert dynamics_node.MomentumObserver is MomentumObserver
