"""One request, resolved: the state of all joints, and the joints and order that are asked for."""

import time

import numpy as np

from ..support.messages import from_field, to_field
from ...errors import ArgumentError

# Joints that a refusal lists.
_MOST_SHOWN = 8


class Query:
    """
    What a request about one state asks for.

    Attributes
    ----------
    model : RobotModel
    names : list of str
        The wanted joints in the wanted order.
    q, qd : numpy.ndarray, shape (n,)
        State of all joints of the model; joints that are not wanted stand still.
    message : str
        Where this state comes from, for people.
    unseen : str
        What to append to it: joints of unknown position that were not asked for, and given
        positions beyond the limits.

    """

    def __init__(self, robot, request, timeout):
        """
        Resolve `joint_names`, `position`, and `velocity` if the request has one.

        Parameters
        ----------
        robot : ActiveRobot
        request : object
            A service's request.
        timeout : float
            Age at which a measured state is still fresh, s.

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

    def whole(self, name, field):
        """
        Return one value for every joint of the model.

        Parameters
        ----------
        name : str
            Of the request's field, for people.
        field : sequence of float
            For the wanted joints; empty for zeros, which `message` then says.

        Returns
        -------
        numpy.ndarray, shape (n,)
            Zero for joints that are not wanted.

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

    def part(self, vector):
        """Return the entries of the wanted joints of a vector of all joints, as a field."""
        return to_field(finite(vector if self.has_all_in_order else vector[self.index]))

    def block(self, matrix):
        """Return rows and columns of the wanted joints of a matrix of all joints, as a field."""
        if not self.has_all_in_order:
            matrix = matrix[np.ix_(self.index, self.index)]
        return to_field(finite(matrix))

    def columns(self, matrix):
        """Return the columns of the wanted joints of a matrix of all joints, as a field."""
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


def not_finite(names, values):
    """
    Return which of some values are not finite, in words.

    Parameters
    ----------
    names : sequence of str
        The m joints.
    values : numpy.ndarray, shape (m,)

    Returns
    -------
    str
        "nan for elbow_pitch", at most eight of them.

    """
    wrong = np.flatnonzero(~np.isfinite(values))
    more = f' and {len(wrong) - _MOST_SHOWN} more' if len(wrong) > _MOST_SHOWN else ''
    return ', '.join(f'{values[i]} for {names[i]}' for i in wrong[:_MOST_SHOWN]) + more


def finite(values):
    """
    Return values that are finite as they are.

    Raises
    ------
    ArgumentError
        If one is not: what was asked for is beyond what numbers can hold.

    """
    if not np.isfinite(values).all():
        raise ArgumentError('the result is not finite: the numbers in the request are too large')
    return values
