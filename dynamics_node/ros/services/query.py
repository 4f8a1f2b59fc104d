"""A request about one state, resolved: state of all joints, requested joints and their order."""

from array import array
from collections.abc import Sequence
import time
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..support.messages import from_field, to_field
from ..torque_path.active_robot import ActiveRobot
from ...errors import ArgumentError

# Largest number of joints in a refusal.
_MOST_SHOWN = 8
_Numbers = TypeVar('_Numbers', float, NDArray[np.float64])


class Query:
    """
    The state and the joints of a request.

    Attributes
    ----------
    model : RobotModel
    names : list of str
        The m requested joints in the requested order.
    index : numpy.ndarray of int, shape (m,)
        Their places among all n joints of the model.
    q, qd : numpy.ndarray, shape (n,)
        State of all joints of the model; the other joints stand still.
    message : str
        The source of the state.
    unseen : str
        Appended to the message: other joints of unknown position, and given positions beyond
        the limits.

    """

    def __init__(self, robot: ActiveRobot, request: Any, timeout: float) -> None:
        """
        Resolve `joint_names`, `position`, and `velocity` if the request has one.

        Parameters
        ----------
        robot : ActiveRobot
        request : object
            Request of a service.
        timeout : float
            Largest age of a fresh measured state, s.

        Raises
        ------
        DynamicsError
            If names, lengths or numbers are wrong, or there is no fresh state.

        """
        selection = robot.selection
        self.model = robot.model
        if request.joint_names:
            order = selection.permutation(request.joint_names)
            self.names = [selection.names[i] for i in order]
            self.index = selection.index[order]
        else:
            self.names, self.index = list(selection.names), selection.index
        self.unseen = robot.unseen_others(self.index, time.monotonic(), timeout)
        self.has_all_in_order = robot.has_all_in_order and not request.joint_names
        if len(request.position):
            self.q = robot.buffer.position
            given = self.q[self.index] = self._checked('position', request.position)
            self.unseen += robot.beyond_limits(self.index, given)
            self.message = 'at the given position'
        else:
            self.q = robot.measured_position(time.monotonic(), timeout)
            self.message = 'at the newest measured position'
        self.qd = np.zeros(self.q.size)
        if hasattr(request, 'velocity'):
            self.qd = self.whole('velocity', request.velocity)

    def whole(self, name: str, field: Sequence[float]) -> NDArray[np.float64]:
        """
        Return one value for every joint of the model.

        Parameters
        ----------
        name : str
            Name of the request's field, for messages.
        field : sequence of float
            For the requested joints; empty for zeros, which `message` then mentions.

        Returns
        -------
        numpy.ndarray, shape (n,)
            Zero for the other joints.

        Raises
        ------
        ArgumentError
            If the length is wrong or a value is not finite.

        """
        values = np.zeros(self.q.size)
        if len(field):
            values[self.index] = self._checked(name, field)
        else:
            self.message += f', {name} zero'
        return values

    def part(self, vector: NDArray[np.float64]) -> array:
        """Return the entries of the requested joints of a vector of all joints, as a field."""
        return to_field(finite(vector if self.has_all_in_order else vector[self.index]))

    def block(self, matrix: NDArray[np.float64]) -> array:
        """Return rows and columns of the requested joints of a matrix, as a field."""
        if not self.has_all_in_order:
            matrix = matrix[np.ix_(self.index, self.index)]
        return to_field(finite(matrix))

    def columns(self, matrix: NDArray[np.float64]) -> array:
        """Return the columns of the requested joints of a matrix, as a field."""
        return to_field(finite(matrix if self.has_all_in_order else matrix[:, self.index]))

    def _checked(self, name, field):
        values = from_field(field)
        if values.size != len(self.names):
            raise ArgumentError(
                f'{name}: expected {len(self.names)} values for '
                f'{", ".join(self.names)}, or none; got {values.size}'
            )
        if not np.isfinite(values).all():
            raise ArgumentError(
                f'{name}: expected finite values, got ' + not_finite(self.names, values)
            )
        return values


def not_finite(names: Sequence[str], values: NDArray[np.float64]) -> str:
    """
    Return the values that are not finite, in words.

    Parameters
    ----------
    names : sequence of str
        The m joints.
    values : numpy.ndarray, shape (m,)

    Returns
    -------
    str
        "nan for elbow_pitch"; at most eight joints.

    """
    wrong = np.flatnonzero(~np.isfinite(values))
    more = f' and {len(wrong) - _MOST_SHOWN} more' if len(wrong) > _MOST_SHOWN else ''
    return ', '.join(f'{values[i]} for {names[i]}' for i in wrong[:_MOST_SHOWN]) + more


def finite(values: _Numbers) -> _Numbers:
    """
    Return values unchanged if all are finite.

    Raises
    ------
    ArgumentError
        If one is not: the result exceeds the range of double precision.

    """
    if not np.isfinite(values).all():
        raise ArgumentError('the result is not finite: the numbers in the request are too large')
    return values
