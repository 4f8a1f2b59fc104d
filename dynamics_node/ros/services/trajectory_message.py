"""Conversion between trajectory_msgs/JointTrajectory and arrays."""

from array import array
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from .query import not_finite
from ..torque_path.active_robot import ActiveRobot
from ...dynamics import JointSelection
from ...errors import ArgumentError


class TrajectoryArrays:
    """
    The points of a message as arrays.

    Attributes
    ----------
    names : tuple of str
        The m joints of the trajectory.
    index : numpy.ndarray of int, shape (m,)
        Their places among all n joints of the robot.
    time : numpy.ndarray, shape (N,)
        time_from_start, s.
    positions, velocities, accelerations : numpy.ndarray, shape (N, m)
        rad or m, per s, per s²; a row of NaN for a point without values.

    """

    def __init__(self, robot: ActiveRobot, trajectory: JointTrajectory) -> None:
        """
        Read a message.

        Parameters
        ----------
        robot : ActiveRobot
        trajectory : trajectory_msgs.msg.JointTrajectory
            With any of the robot's joints; without joint_names, with the chosen ones.

        Raises
        ------
        ArgumentError
            If there is no point, a name is unknown, a length is wrong or a number not finite.

        """
        if not trajectory.points:
            raise ArgumentError('trajectory.points: expected at least one point, got none')
        selection = JointSelection(robot.model, trajectory.joint_names or robot.joint_names)
        self.names, self.index = selection.names, selection.index
        points = trajectory.points
        self.time = np.array(
            [point.time_from_start.sec + point.time_from_start.nanosec * 1e-9 for point in points]
        )
        self.positions = self._values('positions', [point.positions for point in points])
        self.velocities = self._values('velocities', [point.velocities for point in points])
        self.accelerations = self._values(
            'accelerations', [point.accelerations for point in points]
        )
        if np.isnan(self.positions).any():
            missing = int(np.flatnonzero(np.isnan(self.positions).any(axis=1))[0])
            raise ArgumentError(
                f'trajectory.points[{missing}].positions: expected '
                f'{len(self.names)} numbers for {", ".join(self.names)}; got none'
            )

    def _values(self, name, fields):
        count = len(self.names)
        lengths = np.fromiter(map(len, fields), dtype=int, count=len(fields))
        wrong = np.flatnonzero((lengths != count) & (lengths != 0))
        if len(wrong):
            raise ArgumentError(
                f'trajectory.points[{wrong[0]}].{name}: expected {count} numbers '
                f'for {", ".join(self.names)}, or none; got {lengths[wrong[0]]}'
            )
        # In one array: a trajectory may have ten thousand points.
        numbers = np.frombuffer(b''.join(fields), dtype=float).reshape(-1, count)
        if not np.isfinite(numbers).all():
            # A given NaN would be taken for a missing value.
            place = int(np.argmin(np.isfinite(numbers).all(axis=1)))
            point = int(np.flatnonzero(lengths)[place])
            raise ArgumentError(
                f'trajectory.points[{point}].{name}: expected finite numbers, or '
                f'none; got {not_finite(self.names, numbers[place])}'
            )
        values = np.full((len(fields), count), np.nan)
        values[lengths == count] = numbers
        return values

    def whole(self, values: NDArray[np.float64], rest: NDArray[np.float64]) -> NDArray[np.float64]:
        """
        Return one value for every joint of the robot.

        Parameters
        ----------
        values : numpy.ndarray, shape (N, m)
        rest : numpy.ndarray, shape (n,)
            For the joints outside the trajectory.

        Returns
        -------
        numpy.ndarray, shape (N, n)

        """
        all_joints = np.repeat(rest[None], len(values), axis=0)
        all_joints[:, self.index] = values
        return all_joints


def put_efforts(points: Sequence[JointTrajectoryPoint], efforts: NDArray[np.float64]) -> None:
    """
    Write efforts into the points of a trajectory.

    Parameters
    ----------
    points : sequence of trajectory_msgs.msg.JointTrajectoryPoint
        N points; changed in place.
    efforts : numpy.ndarray, shape (N, m)
        N m or N.

    """
    data = np.ascontiguousarray(efforts, dtype=float).tobytes()
    width = efforts.shape[1] * 8
    for i, point in enumerate(points):
        point.effort = array('d', data[i * width : (i + 1) * width])
