"""From parameters to the model: each of them changes it, and in the order of the joints."""

from dynamics_node import ArgumentError, InertiaError, RobotModel
from dynamics_node.ros.parameters.model_settings import configured, tensor
from dynamics_node.ros.parameters.table import check_all
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
import numpy as np
import pytest
from support.robots import ARM7

ARM = RobotModel.from_urdf(ARM7)
CHOSEN = tuple(ARM.joint_names[i] for i in (3, 1))
Q, QD = np.linspace(-1.0, 1.0, 8), np.linspace(2.0, -3.0, 8)
PAYLOAD = {'payload.link': 'hand', 'payload.mass': 2.0}


def made(**values):
    """Return the model of an arm with some parameters, dots written as double underscores."""
    return configured(
        ActiveRobot(ARM, CHOSEN),
        check_all({name.replace('__', '.'): value for name, value in values.items()}),
    )


def test_the_defaults_are_the_robot_of_the_urdf():
    model = made()
    assert np.array_equal(model.mass_matrix(Q), ARM.mass_matrix(Q))
    assert np.array_equal(model.friction_torque(QD), ARM.friction_torque(QD))
    assert model.payload is None


@pytest.mark.parametrize(
    ('values', 'expected'),
    [
        ({'gravity': [0.0, 9.81, 0.0]}, lambda: ARM.with_gravity([0.0, 9.81, 0.0])),
        (
            {'rotor_inertia': [0.3, 0.1]},
            lambda: ARM.with_rotor_inertia([0.0, 0.1, 0.0, 0.3, 0.0, 0.0, 0.0, 0.0]),
        ),
        ({'payload__link': 'hand', 'payload__mass': 2.0}, lambda: ARM.with_payload('hand', 2.0)),
        (
            {'payload__link': 'hand', 'payload__mass': 2.0, 'payload__com': [0.1, 0.2, 0.3]},
            lambda: ARM.with_payload('hand', 2.0, (0.1, 0.2, 0.3)),
        ),
        (
            {
                'payload__link': 'hand',
                'payload__mass': 2.0,
                'payload__inertia': [0.02, 0.001, -0.002, 0.03, 0.003, 0.025],
            },
            lambda: ARM.with_payload(
                'hand',
                2.0,
                inertia=[[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.025]],
            ),
        ),
    ],
)
def test_each_of_them_changes_the_efforts_of_a_motion(values, expected):
    motion = Q, QD, 3.0 * Q
    effort = made(**values).inverse_dynamics(*motion)
    assert effort == pytest.approx(expected().inverse_dynamics(*motion), rel=1e-13, abs=1e-13)
    assert effort != pytest.approx(ARM.inverse_dynamics(*motion), abs=1e-3)


@pytest.mark.parametrize(
    ('values', 'expected'),
    [
        ({'friction__viscous': [0.7, 0.2]}, lambda f: f.viscous),
        ({'friction__coulomb': [0.7, 0.2]}, lambda f: f.coulomb),
        ({'friction__smoothing_velocity': [0.7, 0.2]}, lambda f: f.smoothing_velocity),
    ],
)
def test_friction_of_the_chosen_joints_the_urdf_for_the_others(values, expected):
    numbers, before = expected(made(**values).friction), expected(ARM.friction)
    assert numbers[[3, 1]].tolist() == [0.7, 0.2]
    others = [0, 2, 4, 5, 6, 7]
    assert numbers[others].tolist() == before[others].tolist()
    assert numbers.tolist() != before.tolist()


def test_one_smoothing_velocity_is_for_all_chosen_joints():
    friction = made(friction__smoothing_velocity=0.3).friction
    assert friction.smoothing_velocity[[3, 1]].tolist() == [0.3, 0.3]


def test_only_what_differs_is_done_anew():
    robot, before = ActiveRobot(ARM, ()), check_all(PAYLOAD)
    robot.configure(before)
    loaded = robot.model
    robot.configure({**before, 'state_timeout': 0.5}, before)
    assert robot.model is loaded
    robot.configure(check_all({}), before)
    assert robot.model.payload is None
    assert np.array_equal(robot.model.gravity_torque(Q), ARM.gravity_torque(Q))


def test_what_the_robot_cannot_be_is_refused():
    with pytest.raises(ArgumentError, match=r"^payload.link: 'nose' is not a link of"):
        made(payload__link='nose')
    with pytest.raises(InertiaError, match='triangle'):
        made(
            **{name.replace('.', '__'): value for name, value in PAYLOAD.items()},
            payload__inertia=[1.0, 0, 0, 0, 0, 0],
        )


def test_the_tensor_of_six_numbers():
    assert tensor((1, 2, 3, 4, 5, 6)).tolist() == [[1, 2, 3], [2, 4, 5], [3, 5, 6]]
