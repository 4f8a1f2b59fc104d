"""From parameters to the model in force: gravity, payload, rotors and friction."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...dynamics import RobotModel
from ...dynamics.arguments import check_link
from ...dynamics.friction import SMOOTHING_VELOCITY

# Row and column of the tensor → index in ixx, ixy, ixz, iyy, iyz, izz (geometry_msgs/Inertia).
_TENSOR = ([0, 1, 2], [1, 3, 4], [2, 4, 5])


def tensor(six: Sequence[float]) -> NDArray[np.float64]:
    """
    Return an inertia tensor from its six numbers.

    Parameters
    ----------
    six : sequence of float
        ixx, ixy, ixz, iyy, iyz, izz.

    Returns
    -------
    numpy.ndarray, shape (3, 3)

    """
    return np.array(six, dtype=float)[np.array(_TENSOR)]


def configured(
    robot: Any, values: Mapping[str, Any], before: Mapping[str, Any] | None = None
) -> RobotModel:
    """
    Return the model of a robot with the parameters applied.

    Parameters
    ----------
    robot : ActiveRobot
    values : mapping of str to Any
        Parameter values; arrays per joint are in the order of the chosen joints.
    before : mapping of str to Any, optional
        Parameter values of the present model: only the differences are applied.

    Returns
    -------
    RobotModel

    Raises
    ------
    DynamicsError
        If the link of the payload is unknown or its inertia is not physical.

    """

    def has_changed(*names):
        return before is None or any(values[name] != before[name] for name in names)

    model = robot.model
    if has_changed('gravity'):
        model = model.with_gravity(values['gravity'])
    if has_changed('rotor_inertia'):
        model = model.with_rotor_inertia(_of_all(robot, values['rotor_inertia'], 0.0))
    if has_changed('friction.viscous', 'friction.coulomb', 'friction.smoothing_velocity'):
        model = model.with_friction(*_friction(robot, values))
    if has_changed('payload.link', 'payload.mass', 'payload.com', 'payload.inertia'):
        if values['payload.link']:
            check_link(model.tree.links, values['payload.link'], 'payload.link')
        model = model.with_payload(
            values['payload.link'],
            values['payload.mass'],
            values['payload.com'],
            tensor(values['payload.inertia']),
        )
    return model


def _friction(robot, values):
    tree = robot.model.tree
    smoothing = values['friction.smoothing_velocity']
    return (
        _of_all(robot, values['friction.viscous'], tree.friction[:, 0]),
        _of_all(robot, values['friction.coulomb'], tree.friction[:, 1]),
        _of_all(
            robot,
            smoothing * len(robot.joint_names) if len(smoothing) == 1 else smoothing,
            SMOOTHING_VELOCITY,
        ),
    )


def _of_all(robot, chosen, others):
    # One number per joint of the model; `chosen` may be empty.
    numbers = np.array(np.broadcast_to(others, (len(robot.model.joint_names),)))
    if chosen:
        numbers[robot.selection.index] = chosen
    return numbers
