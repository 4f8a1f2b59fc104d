"""Which changes of model and limits may reach an arm that the output holds."""

import numpy as np

from .parameter_table import ParameterError


def check_change(robot, model, values, before):
    """
    Refuse a change that would throw or drop the arm while the output is on.

    Parameters
    ----------
    robot : Robot
        With the model and the state in force.
    model : RobotModel
        As it would become.
    values, before : dict of str to Any
        Of the parameters, as they would become and as they are.

    Raises
    ------
    ParameterError
        If a chosen joint would have no effort limit, gravity would turn by 90 degrees or more,
        or gravity torque would bring a joint to its limit that is not there yet.

    """
    unlimited = robot.unlimited_joints(values['effort_limits'])
    if unlimited:
        raise ParameterError('effort_limits: expected a limit for every joint while output is on, '
                             f'got none for {", ".join(unlimited)}')
    _check_gravity(values['gravity'], before['gravity'])
    if model is robot.model and values['effort_scale'] == before['effort_scale']:
        return  # lower limits are always possible
    over = robot.over_limits(values, model, before)
    if over:
        raise ParameterError('while output is on, expected what the arm can hold, but its '
                             f'gravity torque would be above the limit: {over}')


def _check_gravity(gravity, before):
    # Zero has no direction: from there every other one would be possible.
    if gravity == before or np.dot(gravity, before) > 0.0:
        return
    if not any(gravity) or not any(before):
        raise ParameterError('gravity: expected a vector that is not zero while output is on, got '
                             f'{list(before)} -> {list(gravity)}: disable it first, or leave '
                             'gravity out of the command by compensate.gravity')
    # What an accelerometer at rest says is the opposite of gravity.
    raise ParameterError('gravity: expected a vector that points to the earth, got one that is '
                         'turned by 90 degrees or more against the one in force: while output is '
                         'on, this would throw the arm')
