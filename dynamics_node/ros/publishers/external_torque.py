"""What pushes the arm from outside, published for every state while it is wanted."""

import math

from builtin_interfaces.msg import Time
from sensor_msgs.msg import JointState

from ..support.callback_errors import logged
from ..support.messages import to_field
from ..support.qos import NO_EVENTS, RESULT
from ..support.throttling import Throttle
from ...dynamics import MomentumObserver
from ...dynamics.momentum_observer import LONGEST_STEP
from ...safety import EffortPlausibility

# The shortest time between two warnings about the same thing, s.
WARN_EVERY = 10.0
_SECOND = 1_000_000_000
# So many begins in a row are no gap, but states that are too rare.
MAX_BEGINS = 3
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
        Messages published so far.

    """

    def __init__(self, context):
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
        self._warnings = {what: Throttle(WARN_EVERY) for what in (*_TO_DO, 'rate', 'doubt')}
        self._watch: _Watch | None = None
        self._missing = ''
        self.is_on = False
        self.published = self._begun = 0

    def configure(self):
        """
        Take over the parameters.

        Returns
        -------
        bool
            Whether it is on, so that it needs measured efforts.

        """
        is_on = self._parameters['publish_external_torque']
        if is_on != self.is_on:
            self.is_on, self._watch, self._missing = is_on, None, ''
        return is_on

    @logged
    def on_state(self, robot, stamp, gravity_torque):
        """
        Observe a state, and publish what follows from it.

        Parameters
        ----------
        robot : ActiveRobot
            With that state in its buffer.
        stamp : builtin_interfaces.msg.Time
            Of the state, or of its arrival if it says none.
        gravity_torque : numpy.ndarray, shape (m,)
            G of the chosen joints at that state, N m or N, finite.

        """
        time = robot.buffer.measured or stamp.sec * _SECOND + stamp.nanosec
        gain, watch = self._parameters['external_torque.gain'], self._watch
        if watch is None or not watch.fits(robot, gain):
            watch = self._watch = _Watch(robot, gain, time, watch)
        elif watch.time <= time <= watch.newest:
            return  # a part of a state: the joints that are older have not come yet
        watch.take(time, robot)
        buffer, index = robot.buffer, robot.selection.index
        q, qd, effort = buffer.position, buffer.velocity, buffer.effort[index]
        if self._is_unknown(robot, velocity=qd[index], effort=effort):
            watch.forget()
            return
        estimate = watch.observer.update(watch.seconds, q, qd, effort)
        if watch.at_rest.update(watch.seconds, qd[index], effort, gravity_torque):
            self._warn_of(watch.at_rest.warning)
        if watch.observer.observed == 0.0:
            self._begun += 1
            self._notice_rare(watch)
        elif all(map(math.isfinite, estimate.tolist())):
            watch.begins = 0
            self._publish(robot, time, q[index], qd[index], estimate)

    def health(self):
        """
        Return what there is to say to people.

        Returns
        -------
        problem : str
            Why nothing is published, or why it can hardly be right; '' if all is well.
        values : dict of str to str

        """
        doubt = self._watch.at_rest.warning if self._watch else ''
        return self._missing or doubt, {
            'published': str(self.published),
            'begun': str(self._begun),
            'missing': self._missing,
            'effort at rest': doubt or 'nothing wrong',
        }

    def _is_unknown(self, robot, **measured):
        for what, values in measured.items():
            names = [
                name
                for name, value in zip(robot.joint_names, values.tolist(), strict=True)
                if not math.isfinite(value)
            ]
            if names:
                self._missing = f'no {what} in joint_states of {", ".join(names)}'
                if self._warnings[what].is_due():
                    self.logger.warning(
                        f'{self._missing}: ~/external_torque is not published; {_TO_DO[what]}'
                    )
                return True
        self._missing = ''
        return False

    def _notice_rare(self, watch):
        watch.begins += 1
        if watch.begins >= MAX_BEGINS:
            self._missing = f'joint states come more than {LONGEST_STEP:g} s apart'
            if self._warnings['rate'].is_due():
                self.logger.warning(
                    f'{self._missing}: ~/external_torque is not published; raise '
                    'the rate of the joint state broadcaster'
                )

    def _warn_of(self, doubt):
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


class _Watch:
    """
    One robot under observation.

    Attributes
    ----------
    observer : MomentumObserver
    at_rest : EffortPlausibility
    time, newest : int
        Of the newest state, ns: when the oldest and the newest of its joints was measured.
    begins : int
        How often in a row the observer has begun anew.

    """

    def __init__(self, robot, gain, time, before):
        """Begin to observe at a time, ns; `before` is the watch that ends."""
        # What must stay as it is: a jump of the arm or of the clock is a break in what was
        # measured.
        self._robot, self._what = robot, (robot.buffer.breaks, gain)
        self._model = robot.model
        self.observer = MomentumObserver(robot.model, gain, robot.joint_names)
        self.at_rest = EffortPlausibility(
            robot.joint_names, robot.model.effort_limits[robot.selection.index]
        )
        if before is not None and before.at_rest.names == self.at_rest.names:
            self.at_rest.warning = before.at_rest.warning
        # Seconds since then have digits enough, those since 1970 have not.
        self._epoch = self.time = self.newest = time
        self.begins = 0

    def fits(self, robot, gain):
        """Tell whether it may go on with a robot as it is now, and a gain."""
        return self._robot is robot and self._what == (robot.buffer.breaks, gain)

    def take(self, time, robot):
        """Go on to a state, ns, and to the model in force: the payload or gravity may be new."""
        self.time, self.newest = time, max(time, robot.buffer.newest_measured)
        if robot.model is not self._model:
            self._model = robot.model
            self.observer.follow(robot.model)

    @property
    def seconds(self):
        """The time of the newest state since the watch began, s."""
        return (self.time - self._epoch) * 1e-9

    def forget(self):
        """Begin anew with the next state."""
        self.observer.reset()
        self.at_rest.forget()
