"""From parameters to the model: every parameter changes it, in the order of the joints."""

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
OTHERS = [0, 2, 4, 5, 6, 7]
TENSOR = [[0.02, 0.001, -0.002], [0.001, 0.03, 0.003], [-0.002, 0.003, 0.025]]


def model_with(values):
    """Return the model of an arm with some parameters."""
    return configured(ActiveRobot(ARM, CHOSEN), check_all(values))


def test_the_defaults_are_the_robot_of_the_urdf():
    model = model_with({})
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
        (PAYLOAD, lambda: ARM.with_payload('hand', 2.0)),
        (
            {**PAYLOAD, 'payload.com': [0.1, 0.2, 0.3]},
            lambda: ARM.with_payload('hand', 2.0, (0.1, 0.2, 0.3)),
        ),
        (
            {**PAYLOAD, 'payload.inertia': [0.02, 0.001, -0.002, 0.03, 0.003, 0.025]},
            lambda: ARM.with_payload('hand', 2.0, inertia=TENSOR),
        ),
    ],
)
def test_every_parameter_changes_the_efforts_of_a_motion(values, expected):
    motion = Q, QD, 3.0 * Q
    effort = model_with(values).inverse_dynamics(*motion)
    assert effort == pytest.approx(expected().inverse_dynamics(*motion), rel=1e-13, abs=1e-13)
    assert effort != pytest.approx(ARM.inverse_dynamics(*motion), abs=1e-3)


@pytest.mark.parametrize('name', ['viscous', 'coulomb', 'smoothing_velocity'])
def test_friction_changes_for_the_chosen_joints_only(name):
    changed = getattr(model_with({f'friction.{name}': [0.7, 0.2]}).friction, name)
    before = getattr(ARM.friction, name)
    assert changed[[3, 1]].tolist() == [0.7, 0.2]
    assert changed[OTHERS].tolist() == before[OTHERS].tolist()
    assert changed.tolist() != before.tolist()


def test_one_smoothing_velocity_counts_for_all_chosen_joints():
    friction = model_with({'friction.smoothing_velocity': 0.3}).friction
    assert friction.smoothing_velocity[[3, 1]].tolist() == [0.3, 0.3]


def test_only_differences_are_applied():
    robot, before = ActiveRobot(ARM, ()), check_all(PAYLOAD)
    robot.configure(before)
    loaded = robot.model
    robot.configure({**before, 'state_timeout': 0.5}, before)
    assert robot.model is loaded
    robot.configure(check_all({}), before)
    assert robot.model.payload is None
    assert np.array_equal(robot.model.gravity_torque(Q), ARM.gravity_torque(Q))


def test_an_unknown_link_and_a_nonphysical_inertia_are_refused():
    with pytest.raises(ArgumentError, match=r"^payload.link: 'nose' is not a link of"):
        model_with({'payload.link': 'nose'})
    with pytest.raises(InertiaError, match='triangle'):
        model_with({**PAYLOAD, 'payload.inertia': [1.0, 0, 0, 0, 0, 0]})


def test_the_tensor_of_six_numbers():
    assert tensor((1, 2, 3, 4, 5, 6)).tolist() == [[1, 2, 3], [2, 4, 5], [3, 5, 6]]
