"""The topic ~/external_torque: torque on the joints from outside, for every state."""

from __future__ import annotations

import math
from typing import Any

from builtin_interfaces.msg import Time
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState

from ..context import NodeContext
from ..support.callback_errors import logged
from ..support.messages import to_field
from ..support.qos import NO_EVENTS, RESULT
from ..support.throttling import Throttle
from ..torque_path.active_robot import ActiveRobot
from ...dynamics import MomentumObserver
from ...dynamics.momentum_observer import LONGEST_STEP
from ...safety import EffortPlausibility

# Shortest time between two warnings of the same kind, s.
WARN_EVERY = 10.0
# ns.
_SECOND = 1_000_000_000
# Restarts of the observer in a row: fewer are a gap, more are a too low rate of joint states.
MAX_RESTARTS = 3
# Missing input → what to do.
_TO_DO = {
    'velocity': 'give the joints a velocity state interface in the <ros2_control> of the URDF',
    'effort': 'give the joints an effort state interface in the <ros2_control> of the URDF, if '
    'the arm measures torque',
}


class ExternalTorque:
    """
    Publishes ~/external_torque while the parameter publish_external_torque is true.

    Attributes
    ----------
    is_on : bool
    published : int
        Number of published messages.

    """

    def __init__(self, context: NodeContext) -> None:
        """
        Create the publisher; off until `configure`.

        Parameters
        ----------
        context : NodeContext

        """
        self.logger = context.logger
        self._parameters = context.parameters
        self._publisher = context.node.create_publisher(
            JointState, '~/external_torque', RESULT, event_callbacks=NO_EVENTS
        )
        self._warnings = {kind: Throttle(WARN_EVERY) for kind in (*_TO_DO, 'rate', 'doubt')}
        self._observation: _Observation | None = None
        self._missing = ''
        self.is_on = False
        self.published = self._restarts = 0

    def configure(self) -> bool:
        """
        Apply the parameters.

        Returns
        -------
        bool
            Whether it is on, and needs measured efforts.

        """
        is_on = self._parameters['publish_external_torque']
        if is_on != self.is_on:
            self.is_on, self._observation, self._missing = is_on, None, ''
        return is_on

    @logged
    def on_state(
        self, robot: ActiveRobot, stamp: Time, gravity_torque: NDArray[np.float64]
    ) -> None:
        """
        Observe a state, and publish the estimate.

        Parameters
        ----------
        robot : ActiveRobot
            Its buffer holds the state.
        stamp : builtin_interfaces.msg.Time
            Of the state, or of its arrival if it has none.
        gravity_torque : numpy.ndarray, shape (m,)
            G of the chosen joints at that state, N m or N, finite.

        """
        time = robot.buffer.measured or stamp.sec * _SECOND + stamp.nanosec
        gain, seen = self._parameters['external_torque.gain'], self._observation
        if seen is None or not seen.fits(robot, gain):
            seen = self._observation = _Observation(robot, gain, time, seen)
        elif seen.time <= time <= seen.newest:
            return  # a partial state: the older joints have not arrived yet
        seen.follow(time, robot)
        buffer, index = robot.buffer, robot.selection.index
        q, qd, effort = buffer.position, buffer.velocity, buffer.effort[index]
        if self._is_unknown(robot, velocity=qd[index], effort=effort):
            seen.restart()
            return
        estimate = seen.observer.update(seen.seconds, q, qd, effort)
        if seen.at_rest.update(seen.seconds, qd[index], effort, gravity_torque):
            self._warn_of_doubt(seen.at_rest.warning)
        if seen.observer.observed == 0.0:
            self._restarts += 1
            self._check_rate(seen)
        elif all(map(math.isfinite, estimate.tolist())):
            seen.restarts = 0
            self._publish(robot, time, q[index], qd[index], estimate)

    def health(self) -> tuple[str, dict[str, str]]:
        """
        Return the health for the diagnostics.

        Returns
        -------
        problem : str
            Why nothing is published, or why the estimate is implausible; '' without a problem.
        values : dict of str to str

        """
        doubt = self._observation.at_rest.warning if self._observation else ''
        return self._missing or doubt, {
            'published': str(self.published),
            'begun': str(self._restarts),
            'missing': self._missing,
            'effort at rest': doubt or 'nothing wrong',
        }

    def _is_unknown(self, robot: ActiveRobot, **measured: Any) -> bool:
        for kind, values in measured.items():
            names = [
                name
                for name, value in zip(robot.joint_names, values.tolist(), strict=True)
                if not math.isfinite(value)
            ]
            if names:
                self._missing = f'no {kind} in joint_states of {", ".join(names)}'
                if self._warnings[kind].is_due():
                    self.logger.warning(
                        f'{self._missing}: ~/external_torque is not published; {_TO_DO[kind]}'
                    )
                return True
        self._missing = ''
        return False

    def _check_rate(self, seen):
        seen.restarts += 1
        if seen.restarts >= MAX_RESTARTS:
            self._missing = f'joint states come more than {LONGEST_STEP:g} s apart'
            if self._warnings['rate'].is_due():
                self.logger.warning(
                    f'{self._missing}: ~/external_torque is not published; raise '
                    'the rate of the joint state broadcaster'
                )

    def _warn_of_doubt(self, doubt):
        if doubt and self._warnings['doubt'].is_due():
            self.logger.warning(
                f'the effort of joint_states can hardly be torque: {doubt}. Some drivers report '
                'motor current, zeros, or torque without gravity (docs/arms.md); then '
                '~/external_torque is wrong: have the driver report joint torque, or set '
                'publish_external_torque to false. All is well if a brake or something else '
                'carries the arm'
            )

    def _publish(self, robot, time, position, velocity, estimate):
        message = JointState(
            name=list(robot.joint_names),
            position=to_field(position),
            velocity=to_field(velocity),
            effort=to_field(estimate),
        )
        message.header.stamp = Time(sec=time // _SECOND, nanosec=time % _SECOND)
        self._publisher.publish(message)
        self.published += 1


class _Observation:
    """
    The observation of one robot.

    Attributes
    ----------
    observer : MomentumObserver
    at_rest : EffortPlausibility
    time, newest : int
        Stamps of the oldest and the newest joint of the latest state, ns.
    restarts : int
        Restarts of the observer in a row.

    """

    def __init__(
        self, robot: ActiveRobot, gain: float, time: int, before: _Observation | None
    ) -> None:
        # A jump of the arm or of the clock (a break), or another gain, ends the observation.
        self._robot, self._fixed = robot, (robot.buffer.breaks, gain)
        self._model = robot.model
        self.observer = MomentumObserver(robot.model, gain, robot.joint_names)
        self.at_rest = EffortPlausibility(
            robot.joint_names, robot.model.effort_limits[robot.selection.index]
        )
        if before is not None and before.at_rest.names == self.at_rest.names:
            self.at_rest.warning = before.at_rest.warning
        # Seconds since the start, because seconds since 1970 have too few digits in a double.
        self._start = self.time = self.newest = time
        self.restarts = 0

    def fits(self, robot: ActiveRobot, gain: float) -> bool:
        """Tell whether the observation continues with this robot and gain."""
        return self._robot is robot and self._fixed == (robot.buffer.breaks, gain)

    def follow(self, time: int, robot: ActiveRobot) -> None:
        """Go on to a state, ns, and to the model in force, with its payload and gravity."""
        self.time, self.newest = time, max(time, robot.buffer.newest_measured)
        if robot.model is not self._model:
            self._model = robot.model
            self.observer.follow(robot.model)

    @property
    def seconds(self) -> float:
        """The time of the latest state since the start, s."""
        return (self.time - self._start) * 1e-9

    def restart(self) -> None:
        """Start again with the next state."""
        self.observer.reset()
        self.at_rest.forget()
