"""The picture of the dynamics for RViz: ~/markers, while somebody listens."""

import numpy as np
from visualization_msgs.msg import MarkerArray

from .guard import logged
from .listened import Listened
from .marker_writer import as_message, MarkerWriter
from .qos import NO_EVENTS, RESULT
from .throttle import Throttle
from ..drawing import Picture

# People see no more, and the torque needs the time, s.
PERIOD = 0.05


class Markers:
    """
    Publishes ~/markers while somebody listens, at most every PERIOD.

    Attributes
    ----------
    is_on : bool
        Whether somebody listens; then measured efforts are needed.

    """

    def __init__(self, node, parameters, channel):
        """
        Create the publisher.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        channel : OutputChannel
            Whose command is shown where joint_states has no effort.

        """
        self.logger = node.get_logger()
        self._parameters, self._channel = parameters, channel
        self._publisher = node.create_publisher(MarkerArray, '~/markers', RESULT,
                                                event_callbacks=NO_EVENTS)
        self._is_wanted = Listened(self._publisher)
        self._due = Throttle(PERIOD)
        self._view: _View | None = None
        self.is_on = False

    def has_changed(self):
        """Find out whether somebody listens; tell whether that is news."""
        was, self.is_on = self.is_on, bool(self._is_wanted)
        return self.is_on != was

    @logged
    def on_state(self, robot, stamp, gravity_torque):
        """
        Publish the picture of a state, if it is time.

        Parameters
        ----------
        robot : Robot
            With that state in its buffer.
        stamp : builtin_interfaces.msg.Time
            Of the state.
        gravity_torque : numpy.ndarray, shape (m,)
            G of the chosen joints at that state, N m or N, finite.

        """
        if not self._due.is_due():
            return
        if self._view is None or self._view.robot is not robot:
            self._view = _View(robot, self._view)
        shapes = self._view.picture.shapes(
            robot.model, robot.buffer.position, gravity_torque, self._effort(robot),
            robot.effort_limits(self._parameters['effort_limits']))
        self._publisher.publish(self._view.message(shapes, stamp))

    def _effort(self, robot):
        # As measured; where the arm does not say it, what it is told.
        effort = robot.buffer.effort[robot.selection.index]
        if self._channel.machine.is_on:
            effort = np.where(np.isfinite(effort), effort, self._channel.limiter.last)
        return effort


class _View:
    """One robot as it is shown."""

    def __init__(self, robot, before):
        """Take the place of another view, or of none."""
        self.robot = robot
        self.picture = Picture(robot.model.tree, robot.joint_names)
        self._frame_id = robot.model.tree.root
        self._writer = MarkerWriter(self._frame_id)
        self._is_writer_right: bool | None = None
        self._shown = before._shown if before else None

    def message(self, shapes, stamp):
        """Return a picture as a message or, far sooner, as its bytes."""
        # What is not there any more goes at once, not after its lifetime.
        shown = {shape[:2] for shape in shapes}
        begins_anew, self._shown = shown != self._shown, shown
        if self._is_writer_right is None:
            self._is_writer_right = self._writer.is_right(shapes, stamp)
        if self._is_writer_right:
            return self._writer.write(shapes, stamp, begins_anew)
        return as_message(shapes, stamp, self._frame_id, begins_anew)
