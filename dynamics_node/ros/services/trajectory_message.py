"""Between trajectory_msgs/JointTrajectory and arrays."""

from array import array

import numpy as np

from .query import not_finite
from ...dynamics import JointSelection
from ...errors import ArgumentError


class TrajectoryArrays:
    """
    The points of a message as arrays of all joints of a robot.

    Attributes
    ----------
    names : tuple of str
        The trajectory's joints.
    index : numpy.ndarray of int, shape (m,)
        Their places among all joints.
    time : numpy.ndarray, shape (N,)
        time_from_start, s.
    positions, velocities, accelerations : numpy.ndarray, shape (N, m)
        rad or m, per s, per s²; rows of NaN where a point has none.

    """

    def __init__(self, robot, trajectory):
        """
        Take a message apart.

        Parameters
        ----------
        robot : ActiveRobot
        trajectory : trajectory_msgs.msg.JointTrajectory
            Its joint_names may be any of the robot's joints; empty for the chosen ones.

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
        # All at once: a trajectory may have ten thousand points.
        numbers = np.frombuffer(b''.join(fields), dtype=float).reshape(-1, count)
        if not np.isfinite(numbers).all():
            # Inside, NaN stands for what is missing: here it would be believed to be that.
            place = int(np.argmin(np.isfinite(numbers).all(axis=1)))
            point = int(np.flatnonzero(lengths)[place])
            raise ArgumentError(
                f'trajectory.points[{point}].{name}: expected finite numbers, or '
                f'none; got {not_finite(self.names, numbers[place])}'
            )
        values = np.full((len(fields), count), np.nan)
        values[lengths == count] = numbers
        return values

    def whole(self, values, rest):
        """
        Return one value for every joint of the robot.

        Parameters
        ----------
        values : numpy.ndarray, shape (N, m)
        rest : numpy.ndarray, shape (n,)
            What holds for the joints that are not in the trajectory.

        Returns
        -------
        numpy.ndarray, shape (N, n)

        """
        all_joints = np.repeat(rest[None], len(values), axis=0)
        all_joints[:, self.index] = values
        return all_joints


def put_efforts(points, efforts):
    """
    Write efforts into the points of a trajectory.

    Parameters
    ----------
    points : list of trajectory_msgs.msg.JointTrajectoryPoint
        N points; changed in place.
    efforts : numpy.ndarray, shape (N, m)
        N m or N.

    """
    data = np.ascontiguousarray(efforts, dtype=float).tobytes()
    width = efforts.shape[1] * 8
    for i, point in enumerate(points):
        point.effort = array('d', data[i * width : (i + 1) * width])
