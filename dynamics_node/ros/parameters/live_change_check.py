"""Checks of a change of model or limits while the output holds the arm."""

from collections.abc import Mapping
from typing import Any

from ...dynamics import RobotModel
from ...errors import ParameterError
from ...safety import GravityChange


def check_change(
    robot: Any,
    model: RobotModel,
    values: Mapping[str, Any],
    before: Mapping[str, Any],
    gravity_change: GravityChange,
    now: float,
) -> None:
    """
    Refuse a change that would throw or drop the arm while the output is on.

    Parameters
    ----------
    robot : ActiveRobot
        With the model and the state in force.
    model : RobotModel
        The model after the change.
    values, before : mapping of str to Any
        Parameter values after and before the change.
    gravity_change : GravityChange
        Changes of gravity since the output was enabled.
    now : float
        Steady clock, s.

    Raises
    ------
    ParameterError
        If a chosen joint would have no effort limit, a limit would be above the URDF's, gravity
        would point up or turn too fast, or gravity torque, scaled and with the offset, would bring
        another joint to its limit.

    """
    unlimited = robot.unlimited_joints(values['effort_limits'])
    if unlimited:
        raise ParameterError(
            'effort_limits: expected a limit for every joint while output is on, '
            f'got none for {", ".join(unlimited)}'
        )
    above = robot.above_urdf(values)
    if above and not values['allow_limits_above_urdf'] and above != robot.above_urdf(before):
        raise ParameterError(
            'expected limits within those of the URDF while output is on, got '
            f'{above}: set allow_limits_above_urdf first'
        )
    if values['gravity'] != before['gravity']:
        _check_gravity(values, gravity_change, now)
    if model is robot.model and all(
        values[name] == before[name] for name in ('effort_scale', 'effort_offset')
    ):
        return  # lower limits are always accepted
    over = robot.over_limits(values, model, before)
    if over:
        raise ParameterError(
            'while output is on, expected what the arm can hold, but its '
            f'gravity torque would be above the limit: {over}'
        )


def _check_gravity(values, gravity_change, now):
    gravity = values['gravity']
    if gravity[2] > 0.0 and not values['allow_upward_gravity']:
        raise ParameterError(
            f'gravity: expected a vector that points to the earth, got '
            f'{list(gravity)}, which points up in the frame of the root link: '
            'if the arm hangs from a ceiling, set allow_upward_gravity'
        )
    refusal = gravity_change.refusal(now, gravity)
    if refusal:
        raise ParameterError(f'gravity: {refusal}')
