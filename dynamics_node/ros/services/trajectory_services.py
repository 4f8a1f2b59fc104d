"""The services about trajectories and the largest payload."""

from collections.abc import Sequence
from dataclasses import dataclass
import time
from typing import Any

from dynamics_interfaces.srv import ComputeTrajectoryEffort, GetMaxPayload
import numpy as np
from numpy.typing import NDArray

from .base import RobotServices, service
from .query import finite, Query
from .trajectory_message import put_efforts, TrajectoryArrays
from ..context import NodeContext
from ..support.messages import to_field
from ...dynamics import complete_trajectory, over_limit
from ...errors import ArgumentError
from ...safety import TorquePath

# Points per request while the output is on: the efforts wait for the answer, about 0.1 s.
MOST_WHILE_DRIVING = 1000


class TrajectoryServices(RobotServices):
    """The services ~/compute_trajectory_effort and ~/get_max_payload."""

    def __init__(self, context: NodeContext, path: TorquePath) -> None:
        """
        Create the services.

        Parameters
        ----------
        context : NodeContext
        path : TorquePath
            Long requests are refused while it is on.

        """
        super().__init__(context)
        self._path = path

    @service(ComputeTrajectoryEffort)
    def compute_trajectory_effort(self, request: Any, response: Any) -> str:
        """
        Answer the trajectory with `effort` in every point; points and joints above their limit.

        Missing velocities and accelerations are those of a spline through the positions.

        """
        robot, trajectory = self.robot(), request.trajectory
        motion = self._motion(robot, trajectory)
        model, (q, qd, qdd) = robot.model, motion.states
        efforts, notes = model.inverse_dynamics(q, qd, qdd), motion.notes
        if request.without_gravity:
            efforts = efforts - model.gravity_torque(q)
            notes.append('without gravity')
        if request.with_friction:
            efforts = efforts + model.friction_torque(qd)
            notes.append('with friction')
        # Of all joints: the others carry the moving ones, and have limits too.
        limits = self._limits(robot)
        over = over_limit(finite(efforts), limits)
        put_efforts(trajectory.points, efforts[:, motion.index])
        trajectory.joint_names = list(motion.names)
        response.trajectory = trajectory
        response.within_limits = not len(over.points)
        response.points_over_limit = over.points.tolist()
        response.joints_over_limit = [robot.model.joint_names[i] for i in over.joints]
        response.peak_effort = to_field(over.peak_effort[motion.index])
        response.effort_limits = to_field(limits[motion.index])
        if len(over.points):
            notes.append(_over_in_words(over, limits, robot.model.joint_names, motion.index))
        return ('; '.join(notes) or 'all velocities and accelerations were given') + motion.unseen

    @service(GetMaxPayload)
    def get_max_payload(self, request: Any, response: Any) -> str:
        """
        Answer the largest mass on a link, at a state or over a trajectory, and the limiting joint.

        The mass is infinite if no effort limit is in the way.

        """
        robot = self.robot()
        link = request.link or robot.model.tip_link
        point = (request.point.x, request.point.y, request.point.z)
        motion = self._requested_motion(robot, request)
        q, qd, qdd = motion.states
        limits = self._limits_before_gains(robot)
        most = robot.model.max_payload(q, link, point, qd=qd, qdd=qdd, effort_limits=limits)
        mass, joint, (place,) = most.least()
        if mass != np.inf:  # infinite: no limit is in the way
            finite(mass)
        carried = robot.model.with_payload(link, mass if np.isfinite(mass) else 0.0, point)
        effort = carried.inverse_dynamics(q[place], qd[place], qdd[place])
        response.joint_names, response.link = list(motion.names), link
        response.position = to_field(q[place, motion.index])
        response.mass = mass
        response.limiting_joint = robot.model.joint_names[joint] if joint >= 0 else ''
        response.limiting_point = place if request.trajectory.points else -1
        response.effort = to_field(finite(effort[motion.index]))
        response.effort_limits = to_field(limits[motion.index])
        notes = [_in_words(mass, response.limiting_joint, link)]
        if joint >= 0 and joint not in motion.index:
            notes.append(
                f'{response.limiting_joint} is not in joint_names: it needs '
                f'{effort[joint]:.6g} of {limits[joint]:.6g}'
            )
        return '; '.join([*notes, *motion.notes]) + motion.unseen

    def _requested_motion(self, robot, request):
        # The trajectory of a request, or its state, at rest.
        if request.trajectory.points:
            motion = self._motion(robot, request.trajectory)
            motion.notes.insert(0, 'over the trajectory')
            return motion
        query = Query(robot, request, self.parameters['state_timeout'])
        q = query.q[None]
        states = (q, np.zeros_like(q), np.zeros_like(q))
        notes = [f'at rest {query.message}']
        return _Motion(query.names, query.index, states, notes, query.unseen)

    def _motion(self, robot, trajectory):
        if len(trajectory.points) > MOST_WHILE_DRIVING and self._path.is_on:
            raise ArgumentError(
                f'trajectory: expected at most {MOST_WHILE_DRIVING} points while the output is '
                f'on, because the efforts wait for the answer, got {len(trajectory.points)}: ask '
                'in parts, or while it is off'
            )
        return _read_motion(robot, trajectory, self.parameters['state_timeout'])

    def _limits_before_gains(self, robot):
        # The limits apply after effort_scale and effort_offset; a joint with gain 0 gets no model
        # effort, and no limit. The offset counts against both directions: the answer has one
        # limit per joint.
        count = len(robot.model.joint_names)
        gains, offsets = np.ones(count), np.zeros(count)
        gains[robot.selection.index] = self.parameters['effort_scale'] or 1.0
        offsets[robot.selection.index] = self.parameters['effort_offset'] or 0.0
        left = np.maximum(self._limits(robot) - np.abs(offsets), 0.0)
        return np.divide(left, gains, where=gains > 0.0, out=np.full(count, np.nan))

    def _limits(self, robot):
        # Of all joints: the joints outside `joints` have limits too.
        limits = robot.model.effort_limits.copy()
        limits[robot.selection.index] = robot.effort_limits(self.parameters['effort_limits'])
        return limits


def _over_in_words(over, limits, names, index):
    # The arrays of the answer have no place for joints outside the trajectory.
    count = len(over.points)
    joints = [
        names[i]
        if i in index
        else f'{names[i]} (not in the trajectory: up to {over.peak_effort[i]:.6g} of '
        f'{limits[i]:.6g})'
        for i in over.joints.tolist()
    ]
    return f'{count} point{"s" if count > 1 else ""} above the effort limit of ' + ', '.join(
        joints
    )


def _in_words(mass, joint, link):
    if not joint:
        return f'no effort limit is in the way of a mass on {link}'
    if mass == 0.0:
        return f'{joint} is at or above its effort limit without any payload on {link}'
    return f'{mass:.6g} kg on {link}: then {joint} is at its effort limit'


@dataclass
class _Motion:
    """
    A sequence of states of all joints of the robot.

    Attributes
    ----------
    names : sequence of str
        The m joints of the request.
    index : numpy.ndarray of int, shape (m,)
        Their places among all n joints.
    states : tuple of numpy.ndarray, shape (N, n)
        Positions, velocities, accelerations.
    notes : list of str
        The source of the states, for the message.
    unseen : str
        See `Query`.

    """

    names: Sequence[str]
    index: NDArray[np.intp]
    states: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
    notes: list[str]
    unseen: str


def _read_motion(robot, trajectory, timeout):
    arrays = TrajectoryArrays(robot, trajectory)
    motion = complete_trajectory(
        arrays.time, arrays.positions, arrays.velocities, arrays.accelerations
    )
    rest = np.zeros(len(robot.model.joint_names))
    states = (
        arrays.whole(motion.positions, robot.buffer.position),
        arrays.whole(motion.velocities, rest),
        arrays.whole(motion.accelerations, rest),
    )
    unseen = robot.unseen_others(arrays.index, time.monotonic(), timeout) + robot.beyond_limits(
        arrays.index, motion.positions
    )
    notes = [motion.obtained] if motion.obtained else []
    return _Motion(arrays.names, arrays.index, states, notes, unseen)
