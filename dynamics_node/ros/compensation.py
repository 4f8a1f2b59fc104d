"""The efforts that go into the command: gravity, Coriolis, friction, each on or off."""

import numpy as np

from .throttle import Throttle


class Compensation:
    """Adds up the terms that the parameters `compensate.*` ask for."""

    def __init__(self, node, parameters):
        """
        Belong to a node.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters

        """
        self.logger = node.get_logger()
        self._parameters = parameters
        self._without_velocity = Throttle(10.0)

    def effort(self, robot, gravity_torque):
        """
        Return the model's effort of the chosen joints at the newest state.

        Parameters
        ----------
        robot : Robot
        gravity_torque : numpy.ndarray, shape (m,)
            G of the chosen joints at that state, N m or N.

        Returns
        -------
        numpy.ndarray, shape (m,)
            N m or N. Joints of unknown velocity are taken to stand still.

        """
        values = self._parameters.values
        effort = gravity_torque
        if not values['compensate.gravity']:
            effort = np.zeros(len(gravity_torque))
        if values['compensate.coriolis'] or values['compensate.friction']:
            effort = effort + self._of_motion(robot, values)
        return effort

    def _of_motion(self, robot, values):
        index, model = robot.selection.index, robot.model
        velocity, qd = robot.buffer.velocity[index], np.zeros(len(model.joint_names))
        if not np.isfinite(velocity).all() and self._without_velocity.is_due():
            self.logger.warning('joint_states have no velocities of all joints: '
                                'compensate.coriolis and compensate.friction take zero for those')
        qd[index] = np.nan_to_num(velocity, nan=0.0)
        effort = np.zeros(len(qd))
        if values['compensate.coriolis']:
            effort += model.coriolis_matrix(robot.buffer.position, qd) @ qd
        if values['compensate.friction']:
            effort += model.friction_torque(qd)
        return effort[index]
