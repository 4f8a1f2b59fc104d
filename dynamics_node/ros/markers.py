"""The picture of the dynamics for RViz: ~/markers, while somebody listens."""

from collections.abc import Iterator
import time

from builtin_interfaces.msg import Time
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
# Of the time between two states, so much goes into the picture, and at least one step of it.
SHARE = 0.1
# s: not more, however rare the states are.
LONGEST = 0.05
# The shortest time between two complaints about what cannot be drawn, s.
COMPLAIN_EVERY = 10.0


class Markers:
    """
    Publishes ~/markers while somebody listens, at most every PERIOD.

    Attributes
    ----------
    is_on : bool
        Whether somebody listens; then measured efforts are needed.

    """

    def __init__(self, node, parameters, channel, on_change, clock=time.monotonic):
        """
        Create the publisher.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        channel : EffortOutput
            Whose command is shown where joint_states has no effort.
        on_change : callable()
            Called when `is_on` has changed.
        clock : callable() -> float
            Steady, s.

        """
        self.logger = node.get_logger()
        self._parameters, self._channel = parameters, channel
        self._on_change, self._clock = on_change, clock
        self._publisher = node.create_publisher(MarkerArray, '~/markers', RESULT,
                                                event_callbacks=NO_EVENTS)
        self._is_wanted = Listened(self._publisher)
        self._due = Throttle(PERIOD, clock)
        self._complaint = Throttle(COMPLAIN_EVERY, clock)
        self._view: _View | None = None
        self._steps: Iterator = iter(())
        self._last = clock()
        self.is_on = False

    @logged
    def prepare(self, robot):
        """Look at a robot, before the first picture of it has to be made beside the torque."""
        self._view_of(robot)

    def _view_of(self, robot):
        if self._view is None or self._view.robot is not robot:
            self._view = _View(robot, self._view)
        return self._view

    @logged
    def on_state(self, robot, stamp, gravity_torque):
        """
        Go on with the picture, or begin one if it is time, while somebody listens.

        A picture takes longer than a state, so it is made in steps, some after each state, and
        the next state finds the node waiting for it.

        Parameters
        ----------
        robot : Robot
            With that state in its buffer.
        stamp : builtin_interfaces.msg.Time
            Of the state.
        gravity_torque : numpy.ndarray, shape (m,)
            G of the chosen joints at that state, N m or N, finite.

        """
        was, self.is_on = self.is_on, bool(self._is_wanted)
        if self.is_on != was:
            self._steps, self._last = iter(()), self._clock()
            self._on_change()  # from the next state on there are efforts
            return
        if not self.is_on:
            return
        before, self._last = self._last, self._clock()
        until = self._last + min(SHARE * (self._last - before), LONGEST)
        try:
            if not self._go_on(until) and self._due.is_due():
                self._steps = self._draw(robot, stamp, gravity_torque)
                self._go_on(until)
        except Exception:
            self._steps = iter(())
            if self._complaint.is_due():  # the next picture will fail as this one
                raise

    def _go_on(self, until):
        # False if there was nothing to go on with.
        has_begun = False
        for _ in self._steps:
            has_begun = True
            if self._clock() >= until:
                break
        return has_begun

    def _draw(self, robot, stamp, gravity_torque):
        # Of one state, however many come meanwhile.
        stamp = Time(sec=stamp.sec, nanosec=stamp.nanosec)  # the next state's may be put into it
        view, shapes = self._view_of(robot), []
        for part in view.picture.parts(
                robot.model, robot.buffer.position, gravity_torque, self._effort(robot),
                robot.effort_limits(self._parameters['effort_limits'])):
            shapes += part
            yield
        for data in view.steps(shapes, stamp):
            if data is not None:
                self._publisher.publish(data)
            yield

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
        self._is_writer_right = self._writer.is_right()
        self._shown = before._shown if before else None

    def steps(self, shapes, stamp):
        """Write a picture as a message or, sooner, as its bytes: yield None, and it at last."""
        # What is not there any more goes at once, not after its lifetime.
        shown = {shape[:2] for shape in shapes}
        begins_anew, self._shown = shown != self._shown, shown
        if self._is_writer_right:
            yield from self._writer.steps(shapes, stamp, begins_anew)
        else:
            yield as_message(shapes, stamp, self._frame_id, begins_anew)
