"""The parameters of the effort guard, from which docs/reference.md is generated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..parameters.declaration import check_each, DOUBLE, DOUBLES, Parameter, TEXT
from ...errors import ParameterError
from ...safety.effort_guard import GuardSettings

GUARD_PARAMETERS = (
    Parameter(
        'input_topic',
        TEXT,
        '~/commands',
        'Where commands come from: the command_topic of the dynamics node',
        read_only=True,
    ),
    Parameter(
        'output_topic',
        TEXT,
        'forward_effort_controller/commands',
        'Where they go: the topic of the effort controller',
        read_only=True,
    ),
    Parameter(
        'timeout',
        DOUBLE,
        GuardSettings.timeout,
        'Longest time without a command while an effort is in force, s. At least three periods '
        'of the commands, which come with the joint states',
        read_only=True,
        low=0.01,
        high=1.0,
    ),
    Parameter(
        'stop_ramp',
        DOUBLE,
        GuardSettings.stop_ramp,
        'Time from the last command to zero, s',
        read_only=True,
        low=0.1,
        high=10.0,
    ),
    Parameter(
        'rate_limits',
        DOUBLES,
        (),
        'Largest change of effort per joint while it fades, N m/s or N/s, in the order of the '
        'commands; a fade takes longer than stop_ramp where they require it, 10 s at most. '
        'Empty: none',
        read_only=True,
        low=0.0,
        low_open=True,
    ),
    Parameter(
        'effort_limits',
        DOUBLES,
        (),
        'Largest effort per joint, N m or N. Commands above it are clamped, and commands that '
        'begin above a tenth of it do not pass. Empty: none',
        read_only=True,
        low=0.0,
        low_open=True,
    ),
)


def check_all(given: Mapping[str, Any]) -> dict[str, Any]:
    """
    Check all parameters, alone and together.

    Parameters
    ----------
    given : mapping of str to Any
        Name → value as ROS delivers it; missing names have their defaults.

    Returns
    -------
    dict of str to Any
        Name → value of every parameter, in its Python type.

    Raises
    ------
    ParameterError
        Lists every problem, one sentence each.

    """
    checked, problems = check_each(GUARD_PARAMETERS, given)
    rates, limits = (checked.get(name, ()) for name in ('rate_limits', 'effort_limits'))
    if rates and limits and len(rates) != len(limits):
        problems.append(
            'rate_limits, effort_limits: expected one number per joint in both, got '
            f'{len(rates)} and {len(limits)}'
        )
    problems += [
        f'{name}: expected the name of a topic, got none'
        for name in ('input_topic', 'output_topic')
        if checked.get(name) == ''
    ]
    if problems:
        raise ParameterError('; '.join(problems))
    return checked
