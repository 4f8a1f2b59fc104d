"""Parameters of a table as rclpy declares them."""

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.parameter import Parameter as RosParameter

from .parameter import DOUBLE, DOUBLES, FLAG, TEXT, TEXTS

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
