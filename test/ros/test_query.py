"""A request, resolved: the chosen joints in the wanted order, and where the state is from."""

from dynamics_interfaces.srv import GetDynamics
from dynamics_node import ArgumentError, RobotModel
from dynamics_node.ros.services.query import finite, Query
from dynamics_node.ros.torque_path.active_robot import ActiveRobot
import numpy as np
import pytest
from support.robots import ARM7

MODEL = RobotModel.from_urdf(ARM7)
CHOSEN = tuple(MODEL.joint_names[i] for i in (4, 2))


def test_parts_blocks_and_columns_are_those_of_the_wanted_joints():
    robot = ActiveRobot(MODEL, CHOSEN)
    query = Query(robot, GetDynamics.Request(joint_names=CHOSEN[::-1], position=[0.1, 0.2]), 1.0)
    assert query.names == list(CHOSEN[::-1])
    assert query.q[[4, 2]].tolist() == [0.2, 0.1]
    matrix = np.arange(64.0).reshape(8, 8)
    assert list(query.part(matrix[0])) == [2.0, 4.0]
    assert list(query.block(matrix)) == [18.0, 20.0, 34.0, 36.0]
    assert list(query.columns(matrix[:2])) == [2.0, 4.0, 10.0, 12.0]
    assert query.message == 'at the given position, velocity zero'
    assert list(query.whole('effort', [5.0, 6.0])) == [0, 0, 5.0, 0, 6.0, 0, 0, 0]
    with pytest.raises(ArgumentError, match='effort: expected 2 values'):
        query.whole('effort', [5.0])


def test_what_is_not_finite_is_no_answer():
    assert finite(np.ones(2)).tolist() == [1.0, 1.0]
    with pytest.raises(ArgumentError, match='the result is not finite'):
        finite(np.array([1.0, np.inf]))
