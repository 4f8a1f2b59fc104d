"""One parameter of a table: its kind, its default, which values it takes and what it says."""

from dataclasses import dataclass
import math
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
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
        With the unit; what an empty value means.
    read_only : bool
        Whether it can be set only at start-up.
    low, high : float
        Range of every number, both ends allowed; `low_open` leaves out the lower end.
    choices : tuple of str
        Allowed values of a text.
    length : int or None
        How many numbers an array must have; None for any.
    takes_one : bool
        Whether one number may stand for an array: for all joints.

    """

    name: str
    kind: str
    default: Any
    description: str
    read_only: bool = False
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    choices: tuple = ()
    length: int | None = None
    takes_one: bool = False

    def check(self, value):
        """
        Return a value in the kind of this parameter.

        Parameters
        ----------
        value : Any
            What ROS delivers: bool, int, float, str or a sequence of one of them.

        Returns
        -------
        bool, float, str or tuple
            Integers are taken for doubles, as people write them.

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

    def constraints(self):
        """Return in words which values are accepted; '' if the kind says it all."""
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
        return (
            f'a finite number {low}'
            if math.isinf(self.high)
            else f'a number {low} and <= {self.high:g}'
        )

    def _numbers(self, value):
        if self.takes_one and isinstance(value, (int, float)):
            value = (value,)
        if isinstance(value, (str, bytes)) or not hasattr(value, '__len__'):
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
        if isinstance(value, (str, bytes)) or not hasattr(value, '__len__'):
            raise self._error('a list of texts', value)
        if not all(isinstance(item, str) and item for item in value):
            raise self._error('a list of texts that are not empty', value)
        return tuple(value)

    def _flag(self, value):
        if not isinstance(value, bool):
            raise self._error('true or false', value)
        return value

    def _error(self, expected, value):
        is_list = hasattr(value, '__len__') and not isinstance(value, (str, bytes))
        text = repr(list(value)) if is_list else repr(value)
        return ParameterError(f'{self.name}: expected {expected}, got {text[:80]}')


_TYPES = {
    DOUBLE: RosParameter.Type.DOUBLE,
    DOUBLES: RosParameter.Type.DOUBLE_ARRAY,
    TEXT: RosParameter.Type.STRING,
    TEXTS: RosParameter.Type.STRING_ARRAY,
    FLAG: RosParameter.Type.BOOL,
}


def declare(node, parameters):
    """
    Declare parameters with their descriptions and defaults.

    Parameters
    ----------
    node : rclpy.node.Node
    parameters : sequence of Parameter

    Returns
    -------
    dict of str to Any
        Name → value from the command line or a file, not checked yet; only those that are given.

    """
    given = {}
    for parameter in parameters:
        name = parameter.name
        value = node.declare_parameter(name, None, _descriptor(parameter)).value
        if value is None:
            # Set after declaring: only so an empty list keeps the type of its elements.
            node.set_parameters([ros_parameter(parameter, parameter.default)])
        else:
            given[name] = value
        # A read-only parameter could not have been set above.
        node.set_descriptor(name, _descriptor(parameter, parameter.read_only))
    return given


def ros_parameter(parameter, value):
    """
    Return a value of a parameter as rclpy sets it.

    Parameters
    ----------
    parameter : Parameter
    value : bool, float, str or tuple
        In the parameter's kind.

    Returns
    -------
    rclpy.parameter.Parameter

    """
    value = list(value) if isinstance(value, tuple) else value
    return RosParameter(parameter.name, _TYPES[parameter.kind], value)


def _descriptor(parameter, read_only=False):
    # Dynamic typing, because rcl refuses [87, 12] for a double array by an exception; the
    # table's own check takes integers and says what is wrong with the rest.
    return ParameterDescriptor(
        description=parameter.description,
        read_only=read_only,
        additional_constraints=parameter.constraints(),
        dynamic_typing=True,
    )
