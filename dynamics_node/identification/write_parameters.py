"""Identified values into a parameter file of the node: what a URDF cannot hold."""

from collections.abc import Sequence
import json
import re
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ArgumentError, quoted

# A name that YAML takes as text without quotes.
_PLAIN = re.compile(r'[A-Za-z_][A-Za-z0-9_./-]*')
# Texts that are a truth value, a number or nothing to a reader of YAML, in any case.
_WORDS = {'y', 'n', 'yes', 'no', 'on', 'off', 'true', 'false', 'null', 'nan', 'inf', 'infinity'}


class Written(NamedTuple):
    """
    One parameter with a number per joint.

    Attributes
    ----------
    argument : str
        Argument of `write_parameters`.
    name : str
        Parameter of the node.
    low, high : float
        Range that the node accepts; both ends allowed, except for zero where `is_positive`.
    comment : str
        Lines above it in the file.
    is_positive : bool

    """

    argument: str
    name: str
    low: float
    high: float
    comment: str = ''
    is_positive: bool = False


WRITTEN = (
    Written(
        'viscous',
        'friction.viscous',
        0.0,
        1e6,
        'Friction per joint: viscous (N m s/rad or N s/m) and Coulomb (N m or N), which fades to\n'
        'zero below the smoothing velocity (rad/s or m/s). It is part of the command only with\n'
        'compensate.friction, which is positive feedback: begin with less than these numbers.',
    ),
    Written('coulomb', 'friction.coulomb', 0.0, 1e6),
    Written(
        'smoothing_velocity', 'friction.smoothing_velocity', 0.0, np.inf, '', is_positive=True
    ),
    Written(
        'rotor_inertia',
        'rotor_inertia',
        0.0,
        1e6,
        'Inertia of the rotors, reflected to the joints, kg m² or kg.',
    ),
    Written('effort_scale', 'effort_scale', 0.0, 10.0, 'Gain on the model effort.'),
    Written(
        'effort_offset',
        'effort_offset',
        -1e6,
        1e6,
        'Bias, N m or N, added after the gain and before the limits.',
    ),
)


def write_parameters(
    joint_names: Sequence[str],
    *,
    viscous: ArrayLike | None = None,
    coulomb: ArrayLike | None = None,
    smoothing_velocity: ArrayLike | None = None,
    rotor_inertia: ArrayLike | None = None,
    effort_offset: ArrayLike | None = None,
    effort_scale: ArrayLike | None = None,
    comment: str = '',
) -> str:
    """
    Return a parameter file for `ros2 run dynamics_node dynamics_node --ros-args --params-file`.

    It changes no term of the command: friction is not compensated unless the node's parameter
    compensate.friction says so.

    Parameters
    ----------
    joint_names : sequence of str
        The n joints: order of the numbers below, and of the node's command.
    viscous : array_like, shape (n,), optional
        N m s/rad or N s/m, >= 0. What is not given is not in the file.
    coulomb : array_like, shape (n,), optional
        N m or N, >= 0.
    smoothing_velocity : float or array_like, shape (n,), optional
        rad/s or m/s, > 0; one number is for all joints.
    rotor_inertia : array_like, shape (n,), optional
        kg m² or kg, >= 0.
    effort_offset : array_like, shape (n,), optional
        N m or N.
    effort_scale : array_like, shape (n,), optional
        0 to 10.
    comment : str
        First lines of the file.

    Returns
    -------
    str
        YAML, UTF-8.

    Raises
    ------
    ArgumentError
        If there is no joint, or a value has the wrong length or range.

    """
    given = {
        'viscous': viscous,
        'coulomb': coulomb,
        'smoothing_velocity': smoothing_velocity,
        'rotor_inertia': rotor_inertia,
        'effort_scale': effort_scale,
        'effort_offset': effort_offset,
    }
    if not joint_names:
        raise ArgumentError('joint_names: expected at least one joint, got none')
    lines = [
        *_comment(comment),
        *_comment('    ros2 run dynamics_node dynamics_node --ros-args --params-file FILE'),
        '',
        '/**/dynamics_node:',
        '  ros__parameters:',
        '    # Order of the numbers and of the command: the effort controller must have the same.',
        '    joints:',
        *(f'      - {_name(name)}' for name in joint_names),
    ]
    for parameter in WRITTEN:
        value = given[parameter.argument]
        if value is None:
            continue
        if parameter.comment:
            lines += ['', *(f'    {line}' for line in _comment(parameter.comment))]
        numbers = _numbers(parameter, value, len(joint_names))
        lines.append(f'    {parameter.name}: [{", ".join(map(_number, numbers))}]')
    return '\n'.join(lines) + '\n'


def _numbers(parameter: Written, value: ArrayLike, count: int) -> list[float]:
    array = np.asarray(value, dtype=float)
    takes_one = parameter.argument == 'smoothing_velocity' and array.ndim == 0
    if array.shape != (count,) and not takes_one:
        raise ArgumentError(
            f'{parameter.argument}: expected shape ({count},), one number per joint, '
            f'got {array.shape}'
        )
    numbers: list[float] = array.reshape(-1).tolist()
    for number in numbers:
        is_low = number < parameter.low or (parameter.is_positive and number == 0.0)
        if not np.isfinite(number) or is_low or number > parameter.high:
            sign = '>' if parameter.is_positive else '>='
            top = f' and <= {parameter.high:g}' if np.isfinite(parameter.high) else ''
            raise ArgumentError(
                f'{parameter.argument}: expected finite numbers {sign} {parameter.low:g}{top}, '
                f'got {number!r}'
            )
    return numbers


def _number(value: float) -> str:
    # The shortest text that is read as the same double; with a point, without which YAML 1.1
    # takes 1e-05 as text.
    text = repr(value + 0.0)
    mantissa, e, exponent = text.partition('e')
    return text if '.' in mantissa else f'{mantissa}.0{e}{exponent}'


def _name(name: str) -> str:
    if not name.isprintable():
        raise ArgumentError(f'joint_names: expected printable names, got {quoted(name)}')
    if _PLAIN.fullmatch(name) and name.lower() not in _WORDS:
        return name
    return json.dumps(name, ensure_ascii=False)


def _comment(text: str) -> list[str]:
    # Unprintable characters, of a file's name for example, are not YAML.
    return [
        f'# {"".join(char if char.isprintable() else "?" for char in line)}'.rstrip()
        for line in text.splitlines()
    ]
