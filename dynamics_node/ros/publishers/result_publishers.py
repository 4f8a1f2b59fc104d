"""What is published for every joint state: gravity torque, and all of the dynamics."""

from dynamics_interfaces.msg import JointDynamics
import numpy as np
from sensor_msgs.msg import JointState

from ..support.messages import to_field
from ..support.qos import NO_EVENTS, RESULT
from ..support.throttling import HasSubscribers


class ResultPublishers:
    """Publishes ~/gravity_torque and ~/dynamics while somebody listens."""

    def __init__(self, context):
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
        self._is_gravity_wanted = HasSubscribers(self._gravity)
        self._is_dynamics_wanted = HasSubscribers(self._dynamics)

    def publish(self, robot, stamp, effort):
        """
        Publish what is wanted of one state.

        Parameters
        ----------
        robot : ActiveRobot
            With that state in its buffer.
        stamp : builtin_interfaces.msg.Time
            Of the state.
        effort : numpy.ndarray, shape (m,)
            G of the chosen joints, N m or N, finite.

        """
        if self._is_gravity_wanted:
            self._publish_gravity(robot, stamp, effort)
        if self._is_dynamics_wanted and self._parameters['publish_dynamics']:
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
