"""The public library: names, shapes, batches, errors."""

from dynamics_node import ArgumentError, RobotDescriptionError, RobotModel, SingularMassMatrixError
from dynamics_node.codegen import worker
import numpy as np
import pytest
from support.robots import PENDULUM, random_state, random_urdf


@pytest.fixture(scope='module')
def robot():
    return RobotModel.from_urdf(random_urdf(7, joints=5, with_mimic=False))


def test_a_path_and_its_text_give_the_same_robot():
    text = PENDULUM.read_text()
    for source in (PENDULUM, str(PENDULUM), text, text.encode()):
        assert RobotModel.from_urdf(source).mass_matrix([0.3]) == (
            RobotModel.from_urdf(PENDULUM).mass_matrix([0.3])
        )


def test_joint_names_are_in_the_order_of_the_urdf():
    text = random_urdf(7, joints=5, with_mimic=False)
    places = [
        text.index(f'<joint name="{name}"') for name in RobotModel.from_urdf(text).joint_names
    ]
    assert places == sorted(places)


def test_batches_have_leading_axes(robot):
    rng = np.random.default_rng(0)
    q, qd, x = rng.normal(size=(3, 2, 4, 5))
    D, C, G = robot.dynamics(q, qd)
    assert (D.shape, C.shape, G.shape) == ((2, 4, 5, 5), (2, 4, 5, 5), (2, 4, 5))
    assert robot.mass_matrix(q).shape == (2, 4, 5, 5)
    assert robot.kinetic_energy(q, qd).shape == robot.potential_energy(q).shape == (2, 4)
    tau, qdd = robot.inverse_dynamics(q, qd, x), robot.forward_dynamics(q, qd, x)
    for i in range(2):
        for j in range(4):
            one = robot.dynamics(q[i, j], qd[i, j])
            for batched, single in zip((D, C, G), one, strict=True):
                np.testing.assert_array_equal(batched[i, j], single)
            np.testing.assert_allclose(
                tau[i, j], robot.inverse_dynamics(q[i, j], qd[i, j], x[i, j]), rtol=1e-13
            )
            np.testing.assert_allclose(
                qdd[i, j], robot.forward_dynamics(q[i, j], qd[i, j], x[i, j]), rtol=1e-9
            )


def test_batch_axes_broadcast(robot):
    q = np.zeros((3, 5))
    qd = np.ones(5)
    C = robot.coriolis_matrix(q, qd)
    assert C.shape == (3, 5, 5)
    np.testing.assert_array_equal(C[0], robot.coriolis_matrix(q[0], qd))
    assert robot.mass_matrix(np.zeros((0, 5))).shape == (0, 5, 5)


def test_arguments_of_any_layout_are_taken_and_left_alone(robot):
    q = np.asfortranarray(np.random.default_rng(1).normal(size=(4, 5)))
    before = q.copy()
    expected = robot.gravity_torque(np.ascontiguousarray(q))
    q.flags.writeable = False
    np.testing.assert_array_equal(robot.gravity_torque(q), expected)
    np.testing.assert_array_equal(robot.gravity_torque(q.tolist()), expected)
    np.testing.assert_array_equal(q, before)
    assert robot.mass_matrix([0, 0, 0, 0, 0]).dtype == float


def test_answers_belong_to_the_caller(robot):
    D = robot.mass_matrix(np.zeros(5))
    D[:] = 0.0
    assert robot.mass_matrix(np.zeros(5)).any()


def test_the_model_cannot_be_changed(robot):
    for array in (robot.gravity, robot.effort_limits, robot.tree.inertia, robot.tree.axis):
        with pytest.raises(ValueError, match='read-only'):
            array[...] = 0.0


def test_another_gravity_makes_another_model(robot):
    q = np.full(5, 0.3)
    moon = robot.with_gravity([0, 0, -1.62])
    np.testing.assert_allclose(
        moon.gravity_torque(q), robot.gravity_torque(q) * 1.62 / 9.81, rtol=1e-13
    )
    np.testing.assert_array_equal(moon.mass_matrix(q), robot.mass_matrix(q))
    assert robot.gravity[2] == -9.81
    assert not robot.with_gravity([0, 0, 0]).gravity_torque(q).any()


def test_inverse_dynamics_is_the_equation_of_motion(robot):
    rng = np.random.default_rng(2)
    q, qd = random_state(rng, robot)
    qdd = rng.normal(size=5)
    D, C, G = robot.dynamics(q, qd)
    np.testing.assert_allclose(
        robot.inverse_dynamics(q, qd, qdd), D @ qdd + C @ qd + G, rtol=1e-13
    )


@pytest.mark.parametrize(
    'call, message',
    [
        (
            lambda r: r.mass_matrix(np.zeros(4)),
            r'q: expected shape \(..., 5\) for joints .*\(4,\)',
        ),
        (lambda r: r.mass_matrix(0.0), r'q: expected shape \(..., 5\)'),
        (lambda r: r.dynamics(np.zeros(5), np.zeros(6)), r'qd: expected shape .* got \(6,\)'),
        (lambda r: r.dynamics(np.zeros((2, 5)), np.zeros((3, 5))), r'batch axes that fit'),
        (lambda r: r.with_gravity([0, 0]), r'gravity: expected three finite numbers'),
        (lambda r: r.with_gravity([0, 0, np.nan]), r'gravity: expected three finite numbers'),
    ],
)
def test_a_wrong_argument_is_refused_with_the_expected_form(robot, call, message):
    with pytest.raises(ArgumentError, match=message):
        call(robot)


def test_nan_in_is_nan_out(robot):
    assert np.isnan(robot.gravity_torque([np.nan, 0, 0, 0, 0])).any()


def test_a_joint_that_moves_nothing_has_no_acceleration():
    robot = RobotModel.from_urdf(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>'
    )
    assert 'moving links without mass' in robot.warnings[0]
    with pytest.raises(SingularMassMatrixError, match='inertia behind every joint'):
        robot.forward_dynamics([0.0], [0.0], [1.0])


def test_a_robot_without_joints_has_empty_matrices():
    robot = RobotModel.from_urdf('<robot name="r"><link name="a"/></robot>')
    assert robot.joint_names == ()
    D, C, G = robot.dynamics([], [])
    assert (D.shape, C.shape, G.shape) == ((0, 0), (0, 0), (0,))


def test_limits_and_neutral_position_come_from_the_urdf():
    robot = RobotModel.from_urdf(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        '<limit lower="0.5" upper="2" effort="7" velocity="3"/></joint>'
        '<joint name="k" type="continuous"><parent link="b"/><child link="c"/>'
        '<axis xyz="0 0 1"/></joint></robot>'
    )
    np.testing.assert_array_equal(robot.position_limits, [[0.5, 2.0], [-np.inf, np.inf]])
    np.testing.assert_array_equal(robot.effort_limits, [7.0, np.nan])
    np.testing.assert_array_equal(robot.velocity_limits, [3.0, np.nan])
    np.testing.assert_array_equal(robot.neutral_position, [0.5, 0.0])


def test_a_missing_file_is_named():
    expected = r"cannot read 'no_such\.urdf'.*looked in .*absolute"
    with pytest.raises(RobotDescriptionError, match=expected):
        RobotModel.from_urdf('no_such.urdf')


def test_repr_describes_the_robot(robot):
    assert repr(robot).startswith('RobotModel(5 joints, ')


def test_without_compile_the_numbers_are_equal_and_no_compiler_starts(monkeypatch):
    started = []
    monkeypatch.setattr(worker, 'start', lambda packed: started.append(packed))
    text = random_urdf(4711, joints=4)
    model = RobotModel.from_urdf(text, (0.0, 1.0, -9.0), compile=False)
    q = np.random.default_rng(1).normal(size=(30_000, len(model.joint_names)))
    for _ in range(3):
        answer = model.gravity_torque(q)
        model.with_payload(model.tip_link, 2.0).gravity_torque(q)
    assert not started
    assert not model.specialize() and not model.is_specialized
    expected = RobotModel.from_urdf(text, (0.0, 1.0, -9.0)).gravity_torque(q)
    np.testing.assert_allclose(answer, expected, atol=1e-10)
