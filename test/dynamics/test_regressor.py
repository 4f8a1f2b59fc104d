"""The regressor: linear in the ten numbers of every body, by three routes."""

from dynamics_node import ArgumentError, RobotModel
import numpy as np
import pytest
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, public_robot, random_urdf

PUBLIC = [
    'panda_description/urdf/panda.urdf',
    'ur_description/urdf/ur10_robot.urdf',
    'tiago_description/robots/tiago.urdf',
]
TEXTS = {
    'arm7': ARM7.read_text(),
    **{name.split('/')[0]: public_robot(name).read_text() for name in PUBLIC},
    **{f'random {seed}': random_urdf(seed) for seed in range(12)},
}


@pytest.fixture(params=TEXTS, scope='module')
def robot(request):
    return RobotModel.from_urdf(TEXTS[request.param], compile=False), TEXTS[request.param]


def motions(model, count=5, seed=0):
    return np.random.default_rng(seed).normal(size=(3, count, len(model.joint_names)))


def test_regressor_times_parameters_is_inverse_dynamics(robot):
    model, _ = robot
    q, qd, qdd = motions(model)
    Y = model.regressor(q, qd, qdd)
    tau = model.inverse_dynamics(q, qd, qdd)
    scale = np.abs(Y) @ np.abs(model.inertial_parameters)
    assert (np.abs(Y @ model.inertial_parameters - tau) <= 1e-13 * scale + 1e-300).all()


def test_regressor_agrees_with_pinocchio(robot):
    model, text = robot
    oracle = PinocchioOracle(text)
    for q, qd, qdd in zip(*motions(model), strict=True):
        Y = model.regressor(q, qd, qdd)
        expected = oracle.regressor(model.joint_names, model.tree.moving_joint_names, q, qd, qdd)
        np.testing.assert_allclose(Y, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_the_columns_of_a_body_are_the_effort_of_a_payload_on_it(robot):
    model, _ = robot
    [q], [qd], [qdd] = motions(model, 1, seed=1)
    Y = model.regressor(q, qd, qdd)
    tau = model.inverse_dynamics(q, qd, qdd)
    for link, frame in model.tree.links.items():
        if frame.body < 0:
            continue
        loaded = model.with_payload(link, 0.5, (0.3, -0.1, 0.2), np.diag([0.02, 0.03, 0.04]))
        phi = loaded.inertial_parameters - model.inertial_parameters
        others = np.delete(phi.reshape(-1, 10), frame.body, axis=0)
        assert phi.any() and not others.any()
        change = loaded.inverse_dynamics(q, qd, qdd) - tau
        np.testing.assert_allclose(Y @ phi, change, rtol=0, atol=1e-10 * np.abs(Y).max())


def test_rotors_are_not_in_it_and_gravity_is():
    model = RobotModel.from_urdf(ARM7, compile=False)
    [q], [qd], [qdd] = motions(model, 1)
    Y = model.regressor(q, qd, qdd)
    np.testing.assert_array_equal(model.with_rotor_inertia(1.0).regressor(q, qd, qdd), Y)
    turned = model.with_gravity([9.81, 0, 0])
    np.testing.assert_allclose(
        turned.regressor(q, qd, qdd) @ model.inertial_parameters,
        turned.inverse_dynamics(q, qd, qdd),
        atol=1e-12,
    )


def test_batches_threads_and_shapes():
    model = RobotModel.from_urdf(ARM7, compile=False)
    n, bodies = len(model.joint_names), len(model.tree.moving_joint_names)
    q, qd, qdd = motions(model, 9000)
    Y = model.regressor(q, qd, qdd, threads=2)
    assert Y.shape == (9000, n, 10 * bodies)
    np.testing.assert_array_equal(
        Y[[0, 8999]], model.regressor(q[[0, 8999]], qd[[0, 8999]], qdd[[0, 8999]])
    )
    assert model.regressor(q[:6].reshape(2, 3, n), qd[0], qdd[0]).shape == (2, 3, n, 10 * bodies)
    with pytest.raises(ArgumentError, match=r'qd: expected shape'):
        model.regressor(q[0], qd[0, 1:], qdd[0])
