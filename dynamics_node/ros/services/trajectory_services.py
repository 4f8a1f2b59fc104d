"""The services about trajectories and about how much the robot can carry."""

import time

from dynamics_interfaces.srv import ComputeTrajectoryEffort, GetMaxPayload
import numpy as np

from .base import Answering
from .query import finite, Query
from .trajectory_message import put_efforts, TrajectoryArrays
from ..support.callback_errors import guarded_service
from ..support.messages import to_field
from ...dynamics import complete_trajectory, over_limit
from ...errors import ArgumentError

# While efforts are sent, a request must not keep the node busy for longer than about 0.1 s.
MOST_WHILE_DRIVING = 1000


class TrajectoryServices(Answering):
    """Creates and answers ~/compute_trajectory_effort and ~/get_max_payload."""

    def __init__(self, node, get_robot, parameters, is_driving):
        """
        Create the services of a node; see `Answering`.

        Parameters
        ----------
        node, get_robot, parameters
            See `Answering`.
        is_driving : callable() -> bool
            Whether efforts are being sent, which must not wait for long.

        """
        super().__init__(node, get_robot, parameters)
        self._is_driving = is_driving
        self.serve(
            ComputeTrajectoryEffort, 'compute_trajectory_effort', self.compute_trajectory_effort
        )
        self.serve(GetMaxPayload, 'get_max_payload', self.get_max_payload)

    @guarded_service
    def compute_trajectory_effort(self, request, response):
        """Answer the same trajectory with efforts, and where they are above their limits."""

        def fill():
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
            # The other joints have limits as well: they hold what the trajectory moves.
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
            return (
                '; '.join(notes) or 'all velocities and accelerations were given'
            ) + motion.unseen

        return self.answer(response, fill)

    @guarded_service
    def get_max_payload(self, request, response):
        """Answer the largest mass at a point of a link, and the joint that allows no more."""

        def fill():
            robot = self.robot()
            link = request.link or robot.model.tip_link
            point = (request.point.x, request.point.y, request.point.z)
            if request.trajectory.points:
                motion = self._motion(robot, request.trajectory)
                names, index, notes = motion.names, motion.index, motion.notes
                unseen = motion.unseen
                q, qd, qdd = motion.states
                notes.insert(0, 'over the trajectory')
            else:
                query = Query(robot, request, self.parameters['state_timeout'])
                names, index, notes = query.names, query.index, [f'at rest {query.message}']
                unseen = query.unseen
                q = query.q[None]
                qd = qdd = np.zeros_like(q)
            limits = self._limits_before_gains(robot)
            most = robot.model.max_payload(q, link, point, qd=qd, qdd=qdd, effort_limits=limits)
            mass, joint, (place,) = most.least()
            if mass != np.inf:  # which says that no limit is in the way
                finite(mass)
            carried = robot.model.with_payload(link, mass if np.isfinite(mass) else 0.0, point)
            effort = carried.inverse_dynamics(q[place], qd[place], qdd[place])
            response.joint_names, response.link = list(names), link
            response.position = to_field(q[place, index])
            response.mass = mass
            response.limiting_joint = robot.model.joint_names[joint] if joint >= 0 else ''
            response.limiting_point = place if request.trajectory.points else -1
            response.effort = to_field(finite(effort[index]))
            response.effort_limits = to_field(limits[index])
            if joint >= 0 and joint not in index:
                notes.insert(
                    0,
                    f'{response.limiting_joint} is not in joint_names: it needs '
                    f'{effort[joint]:.6g} of {limits[joint]:.6g}',
                )
            return '; '.join([_in_words(mass, response.limiting_joint, link), *notes]) + unseen

        return self.answer(response, fill)

    def _motion(self, robot, trajectory):
        if len(trajectory.points) > MOST_WHILE_DRIVING and self._is_driving():
            raise ArgumentError(
                f'trajectory: expected at most {MOST_WHILE_DRIVING} points while the output is '
                f'on, because the efforts wait for the answer, got {len(trajectory.points)}: ask '
                'in parts, or while it is off'
            )
        timeout = self.parameters['state_timeout']
        return _Motion(robot, trajectory, timeout)

    def _limits_before_gains(self, robot):
        # What the node sends is limited after effort_scale; what it never sends has no limit.
        gains = np.ones(len(robot.model.joint_names))
        gains[robot.selection.index] = self.parameters['effort_scale'] or 1.0
        return np.divide(
            self._limits(robot), gains, where=gains > 0.0, out=np.full(len(gains), np.nan)
        )

    def _limits(self, robot):
        # Of all joints: those that are not chosen have their limits too.
        limits = robot.model.effort_limits.copy()
        limits[robot.selection.index] = robot.effort_limits(self.parameters['effort_limits'])
        return limits


def _over_in_words(over, limits, names, index):
    # Joints that are not in the trajectory have no place in the arrays of the answer.
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


class _Motion:
    # A trajectory, with all derivatives, of all joints of the robot.

    def __init__(self, robot, trajectory, timeout):
        arrays = TrajectoryArrays(robot, trajectory)
        motion = complete_trajectory(
            arrays.time, arrays.positions, arrays.velocities, arrays.accelerations
        )
        self.names, self.index = arrays.names, arrays.index
        rest = np.zeros(len(robot.model.joint_names))
        self.states = (
            arrays.whole(motion.positions, robot.buffer.position),
            arrays.whole(motion.velocities, rest),
            arrays.whole(motion.accelerations, rest),
        )
        self.notes = [motion.obtained] if motion.obtained else []
        self.unseen = robot.unseen_others(
            arrays.index, time.monotonic(), timeout
        ) + robot.beyond_limits(arrays.index, motion.positions)
