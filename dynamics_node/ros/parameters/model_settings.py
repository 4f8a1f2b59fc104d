"""From parameters to the model in force: gravity, payload, rotors and friction."""

import numpy as np

from ...dynamics.arguments import check_link
from ...dynamics.friction import SMOOTHING_VELOCITY

# ixx ixy ixz iyy iyz izz, as in geometry_msgs/Inertia, by row and column of the tensor.
_TENSOR = ([0, 1, 2], [1, 3, 4], [2, 4, 5])
PER_JOINT = ('rotor_inertia', 'friction.viscous', 'friction.coulomb')


def tensor(six):
    """
    Return the inertia tensor of its six numbers.

    Parameters
    ----------
    six : sequence of float
        ixx, ixy, ixz, iyy, iyz, izz.

    Returns
    -------
    numpy.ndarray, shape (3, 3)

    """
    return np.array(six, dtype=float)[np.array(_TENSOR)]


def configured(robot, values, before=None):
    """
    Return a robot's model as the parameters say.

    Parameters
    ----------
    robot : ActiveRobot
    values : dict of str to Any
        Of the parameters; arrays per joint are in the order of the chosen joints.
    before : dict of str to Any, optional
        Those that the robot's model was made with: only what differs is done anew.

    Returns
    -------
    RobotModel

    Raises
    ------
    DynamicsError
        If the payload's link is unknown or no real body has its inertia.

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
    # One number per joint of the model: for the chosen joints those given, if any are.
    numbers = np.array(np.broadcast_to(others, (len(robot.model.joint_names),)))
    if chosen:
        numbers[robot.selection.index] = chosen
    return numbers
