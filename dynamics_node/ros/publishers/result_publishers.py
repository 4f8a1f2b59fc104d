"""The publishers of gravity torque and dynamics, for every joint state."""

from builtin_interfaces.msg import Time
from dynamics_interfaces.msg import JointDynamics
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState

from ..context import NodeContext
from ..support.messages import to_field
from ..support.qos import NO_EVENTS, RESULT
from ..support.throttling import HasSubscribers
from ..torque_path.active_robot import ActiveRobot


class ResultPublishers:
    """Publishes ~/gravity_torque and ~/dynamics while they have subscribers."""

    def __init__(self, context: NodeContext) -> None:
        """
        Create the publishers.

        Parameters
        ----------
        context : NodeContext

        """
        node, self._parameters = context.node, context.parameters
        self._gravity = node.create_publisher(
            JointState, '~/gravity_torque', RESULT, event_callbacks=NO_EVENTS
        )
        self._dynamics = node.create_publisher(
            JointDynamics, '~/dynamics', RESULT, event_callbacks=NO_EVENTS
        )
        self._gravity_has_subscribers = HasSubscribers(self._gravity)
        self._dynamics_has_subscribers = HasSubscribers(self._dynamics)

    def publish(self, robot: ActiveRobot, stamp: Time, effort: NDArray[np.float64]) -> None:
        """
        Publish the results of one state, on topics with subscribers.

        Parameters
        ----------
        robot : ActiveRobot
            Its buffer holds the state.
        stamp : builtin_interfaces.msg.Time
            Of the state.
        effort : numpy.ndarray, shape (m,)
            G of the chosen joints, N m or N, finite.

        """
        if self._gravity_has_subscribers:
            self._publish_gravity(robot, stamp, effort)
        if self._dynamics_has_subscribers and self._parameters['publish_dynamics']:
            self._publish_dynamics(robot, stamp)

    def _publish_gravity(self, robot, stamp, effort):
        result = JointState(
            name=list(robot.joint_names),
            effort=to_field(effort),
            position=to_field(robot.buffer.position[robot.selection.index]),
        )
        result.header.stamp = stamp
        self._gravity.publish(result)

    def _publish_dynamics(self, robot, stamp):
        index = robot.selection.index
        q, qd = robot.buffer.position, np.zeros(len(robot.model.joint_names))
        velocity = robot.buffer.velocity[index]
        is_known = bool(np.isfinite(velocity).all())
        if is_known:
            qd[index] = velocity
        terms = robot.model.dynamics(q, qd)
        coriolis_torque = terms.coriolis_matrix @ qd
        if not (np.isfinite(terms.mass_matrix).all() and np.isfinite(coriolis_torque).all()):
            return
        block = np.ix_(index, index)
        result = JointDynamics(
            joint_names=list(robot.joint_names),
            position=to_field(q[index]),
            mass_matrix=to_field(terms.mass_matrix[block]),
            gravity_torque=to_field(terms.gravity_torque[index]),
        )
        if is_known:
            result.velocity = to_field(velocity)
            result.coriolis_matrix = to_field(terms.coriolis_matrix[block])
            result.coriolis_torque = to_field(coriolis_torque[index])
        result.header.stamp = stamp
        result.header.frame_id = robot.model.tree.root
        self._dynamics.publish(result)
