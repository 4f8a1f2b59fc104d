"""Fast conversion between messages and numpy, and names of message types."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def to_field(values: ArrayLike) -> array:
    """
    Return numbers in the type that a float64[] field accepts fastest.

    Parameters
    ----------
    values : array_like
        Any shape; flattened row-major.

    Returns
    -------
    array.array of 'd'

    """
    return array('d', np.asarray(values, dtype=float).tobytes())


def from_field(field: ArrayLike) -> NDArray[np.float64]:
    """
    Return a copy of a float64[] field.

    Parameters
    ----------
    field : array.array or sequence of float

    Returns
    -------
    numpy.ndarray, shape (len(field),)

    """
    return np.array(field, dtype=float)


def type_name(kind: Any) -> str:
    """Return the ROS name of a message type, for example 'sensor_msgs/msg/JointState'."""
    return f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}'
