"""A robot's own machine code keeps the promise, on real and on extreme robots."""

from dynamics_node import RobotModel
import pytest
from support.extreme_robots import extreme_robots
from support.machine_code import needs_machine_code
from support.robots import public_robot
from support.sweep import BOUND, row

pytestmark = needs_machine_code

# Compiling takes a second or two each; the general kernel is held to this on all robots, and
# `kernels/specialised` holds the machine code to the general kernel on random trees.
PUBLIC = ('ur_description/urdf/ur5_robot.urdf', 'panda_description/urdf/panda.urdf',
          'kinova_description/robots/kinova.urdf')
EXTREME = [name for name in extreme_robots() if 'boom' in name or 'km away' in name]


def specialised(source):
    model = RobotModel.from_urdf(source)
    assert model.specialise()
    return model


@pytest.mark.parametrize('name', PUBLIC)
def test_a_public_robot_keeps_the_promise(name):
    text = public_robot(name).read_text()
    errors = row(name, text, specialised(text)).errors
    for judge in ('pinocchio', 'exact'):
        for quantity, error in errors['library', judge].items():
            assert error <= BOUND, (judge, quantity)


@pytest.mark.parametrize('name', EXTREME)
def test_an_extreme_robot_keeps_its_digits(name):
    text = extreme_robots()[name]
    errors = row(name, text, specialised(text)).errors['library', 'exact']
    for quantity in ('D', 'C', 'G', 'ID', 'energy'):
        assert errors[quantity] <= BOUND, quantity
