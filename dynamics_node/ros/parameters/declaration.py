"""One parameter: kind, default, accepted values and description; and its declaration in ROS."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from ...errors import ParameterError

DOUBLE, DOUBLES, TEXT, TEXTS, FLAG = 'double', 'double[]', 'string', 'string[]', 'bool'


@dataclass(frozen=True)
class Parameter:
    """
    One parameter.

    Attributes
    ----------
    name, kind : str
        Kind is one of double, double[], string, string[], bool.
    default : Any
    description : str
        With the unit, and the meaning of an empty value.
    read_only : bool
        Whether it can be set only at the start.
    low, high : float
        Range of every number, both ends allowed; `low_open` excludes the lower end.
    choices : tuple of str
        Allowed values of a string.
    length : int or None
        Required length of an array; None for any.
    per_joint : bool
        Whether an array has one number per chosen joint, or is empty.
    takes_one : bool
        Whether a single number is accepted for all joints.

    """

    name: str
    kind: str
    default: Any
    description: str
    read_only: bool = False
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    choices: tuple[str, ...] = ()
    length: int | None = None
    per_joint: bool = False
    takes_one: bool = False

    def check(self, value: Any) -> Any:
        """
        Return a value in the kind of this parameter.

        Parameters
        ----------
        value : Any
            From ROS: bool, int, float, str or a sequence of one of them.

        Returns
        -------
        bool, float, str or tuple
            Integers are accepted as doubles.

        Raises
        ------
        ParameterError
            If the type or the value is wrong.

        """
        convert = {
            DOUBLE: self._number,
            DOUBLES: self._numbers,
            TEXT: self._text,
            TEXTS: self._texts,
            FLAG: self._flag,
        }
        return convert[self.kind](value)

    def constraints(self) -> str:
        """Return the accepted values in words; '' if every value of the kind is accepted."""
        if self.choices:
            return 'one of ' + ', '.join(self.choices)
        return self._range() if self.kind in (DOUBLE, DOUBLES) else ''

    def _number(self, value):
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self._error('a number', value)
        in_range = self.low < value if self.low_open else self.low <= value
        if not (math.isfinite(value) and in_range and value <= self.high):
            raise self._error(self._range(), value)
        return float(value)

    def _range(self):
        if math.isinf(self.low) and math.isinf(self.high):
            return 'a finite number'
        low = f'{">" if self.low_open else ">="} {self.low:g}'
        if math.isinf(self.high):
            return f'a finite number {low}'
        return f'a number {low} and <= {self.high:g}'

    def _numbers(self, value):
        if self.takes_one and isinstance(value, (int, float)):
            value = (value,)
        if not _is_list(value):
            raise self._error('a list of numbers', value)
        if self.length is not None and len(value) != self.length:
            raise self._error(f'{self.length} numbers', value)
        return tuple(self._number(item) for item in value)

    def _text(self, value):
        if not isinstance(value, str):
            raise self._error('a text', value)
        if self.choices and value not in self.choices:
            raise self._error('one of ' + ', '.join(self.choices), value)
        return value

    def _texts(self, value):
        if not _is_list(value):
            raise self._error('a list of texts', value)
        if not all(isinstance(item, str) and item for item in value):
            raise self._error('a list of texts that are not empty', value)
        return tuple(value)

    def _flag(self, value):
        if not isinstance(value, bool):
            raise self._error('true or false', value)
        return value

    def _error(self, expected, value):
        text = repr(list(value)) if _is_list(value) else repr(value)
        return ParameterError(f'{self.name}: expected {expected}, got {text[:80]}')


def check_each(
    parameters: Sequence[Parameter], values: Mapping[str, Any]
) -> tuple[dict[str, Any], list[str]]:
    """
    Check the value of every parameter by itself.

    Parameters
    ----------
    parameters : sequence of Parameter
    values : mapping of str to Any
        Name → value from ROS; a missing name gets its default.

    Returns
    -------
    checked : dict of str to Any
        Name → value of its kind, without the wrong ones.
    problems : list of str
        One sentence per wrong value.

    """
    checked, problems = {}, []
    for parameter in parameters:
        try:
            checked[parameter.name] = parameter.check(
                values.get(parameter.name, parameter.default)
            )
        except ParameterError as error:
            problems.append(str(error))
    return checked, problems


_TYPES = {
    DOUBLE: RosParameter.Type.DOUBLE,
    DOUBLES: RosParameter.Type.DOUBLE_ARRAY,
    TEXT: RosParameter.Type.STRING,
    TEXTS: RosParameter.Type.STRING_ARRAY,
    FLAG: RosParameter.Type.BOOL,
}


def declare(node: Node, parameters: Sequence[Parameter]) -> dict[str, Any]:
    """
    Declare parameters with their descriptions and defaults.

    Parameters
    ----------
    node : rclpy.node.Node
    parameters : sequence of Parameter

    Returns
    -------
    dict of str to Any
        Name → unchecked value from the command line or a file; only the given ones.

    """
    given = {}
    for parameter in parameters:
        name = parameter.name
        value = node.declare_parameter(name, None, _descriptor(parameter)).value
        if value is None:
            # Set after the declaration: only then an empty list keeps the type of its elements.
            node.set_parameters([ros_parameter(parameter, parameter.default)])
        else:
            given[name] = value
        # Read-only last: a read-only parameter could not be set above.
        node.set_descriptor(name, _descriptor(parameter, parameter.read_only))
    return given


def ros_parameter(parameter: Parameter, value: Any) -> RosParameter:
    """
    Return a value as a parameter of rclpy.

    Parameters
    ----------
    parameter : Parameter
    value : bool, float, str or tuple
        In the kind of the parameter.

    Returns
    -------
    rclpy.parameter.Parameter

    """
    value = list(value) if isinstance(value, tuple) else value
    return RosParameter(parameter.name, _TYPES[parameter.kind], value)


def _is_list(value):
    return hasattr(value, '__len__') and not isinstance(value, (str, bytes))


def _descriptor(parameter, read_only=False):
    # Dynamic typing: rcl raises an exception for [87, 12] in a double array. `Parameter.check`
    # accepts integers and gives the reason for every refusal.
    return ParameterDescriptor(
        description=parameter.description,
        read_only=read_only,
        additional_constraints=parameter.constraints(),
        dynamic_typing=True,
    )
