"""Every URDF of example-robot-data: this library, Pinocchio, MuJoCo, 80-bit arithmetic."""

from dynamics_node import RobotModel, SingularMassMatrixError
import numpy as np
import pytest
from support.cross_library import QUANTITIES
from support.result_cache import BOUND, compare, MUJOCO_BOUND, sweep
from support.robots import public_robot, public_robots

NAMES = public_robots()

# What is left out, and a part of the reason that the sweep must give. An addition here needs
# a reason that is the robot's, not ours.
LEFT_OUT = {
    'alex_description/urdf/alex_psyonic_hands.urdf': "mimics 'index_q1', which is not a movable",
    'hector_description/robots/quadrotor_base.urdf': 'no movable joint',
    'iris_description/robots/iris_simple.urdf': 'no movable joint',
    'romeo_description/urdf/romeo_laas_small.urdf': 'inertia is not physical',
    'ur_description/urdf/ur3.urdf': 'it has no <link>',
}
COMPARED = [name for name in NAMES if name not in LEFT_OUT]

# Where Pinocchio is further from 80-bit arithmetic than the bound: its C, which it sums in the
# base frame, loses the digits of light links far from the base.
PINOCCHIO_LOSES = {('tiago_description/robots/tiago_no_hand.urdf', 'C')}

# Accelerations are undefined where a joint moves no inertia.
SINGULAR = {'romeo_description/urdf/romeo.urdf': ('LHand', 'RHand')}


def quantities(name):
    """Return the quantities to compare: all, without forward dynamics where D is singular."""
    return {quantity for quantity in QUANTITIES if quantity != 'FD' or name not in SINGULAR}


def test_every_robot_is_compared_or_left_out_with_a_reason():
    rows, left_out = sweep()
    assert [row.name for row in rows] == COMPARED
    assert {robot.name for robot in left_out} == set(LEFT_OUT)
    for robot in left_out:
        assert LEFT_OUT[robot.name] in robot.reason


@pytest.mark.parametrize('name', COMPARED)
def test_a_public_robot_agrees_with_80_bit_arithmetic(name):
    errors = compare(name).errors['library', 'exact']
    assert errors.keys() == quantities(name)
    for quantity, error in errors.items():
        assert error <= BOUND, quantity


@pytest.mark.parametrize('name', COMPARED)
def test_a_public_robot_agrees_with_pinocchio(name):
    errors = compare(name).errors['library', 'pinocchio']
    assert errors.keys() == quantities(name)
    for quantity, error in errors.items():
        if (name, quantity) not in PINOCCHIO_LOSES:
            assert error <= BOUND, quantity


@pytest.mark.parametrize('name, quantity', PINOCCHIO_LOSES)
def test_where_pinocchio_disagrees_pinocchio_loses_digits(name, quantity):
    errors = compare(name).errors
    assert errors['pinocchio', 'exact'][quantity] > BOUND
    assert errors['library', 'exact'][quantity] < 0.1 * errors['pinocchio', 'exact'][quantity]


@pytest.mark.parametrize('name', COMPARED)
def test_a_public_robot_agrees_with_mujoco(name):
    errors = compare(name).errors['library', 'mujoco']
    assert errors.keys() == quantities(name)
    for quantity, error in errors.items():
        assert error <= MUJOCO_BOUND, quantity


@pytest.mark.parametrize('name', SINGULAR)
def test_a_joint_without_inertia_is_reported_not_solved(name):
    model = RobotModel.from_urdf(public_robot(name))
    idle = [model.joint_names.index(joint) for joint in SINGULAR[name]]
    q = np.ones(len(model.joint_names))
    D = model.mass_matrix(q)
    assert set(np.flatnonzero(np.diag(D) == 0)) == set(idle)
    with pytest.raises(SingularMassMatrixError, match='inertia behind every joint'):
        model.forward_dynamics(q, q, q)
