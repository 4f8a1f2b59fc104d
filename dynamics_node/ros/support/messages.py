"""Fast conversion between message fields and numpy arrays, and names of message types."""

from array import array

import numpy as np


def to_field(values):
    """
    Return an array in the type that a float64[] field accepts fastest.

    Parameters
    ----------
    values : numpy.ndarray
        Any shape; flattened row-major.

    Returns
    -------
    array.array of 'd'

    """
    return array('d', np.asarray(values, dtype=float).tobytes())


def from_field(field):
    """
    Return a float64[] field as an array of its own.

    Parameters
    ----------
    field : array.array or sequence of float

    Returns
    -------
    numpy.ndarray, shape (len(field),)

    """
    return np.array(field, dtype=float)


def type_name(kind):
    """Return the name of a message type as ROS writes it, 'sensor_msgs/msg/JointState'."""
    return f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}'
