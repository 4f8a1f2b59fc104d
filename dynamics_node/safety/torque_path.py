"""From a joint state to a command: the one class that owns everything in between."""

from collections import deque
import math

import numpy as np

from .effort_output import EffortOutput, STOP_PERIOD
from .joint_state_buffer import JointStateBuffer, RejectedStateError, StampTolerance
from .state_machine import OutputState

# The nominal period of the joint states is the median of this many.
PERIODS = 9
# Shortest time between two ticks, s.
MIN_TICK = 0.001
# Starts that begin anew before the one before was over: more of them in a row are a fault.
MAX_RESTARTS = 3
# The search for other publishers and controllers may be overdue by at most this time while
# efforts are sent, s.
MAX_MONITOR_AGE = 2.0


class TorquePath:
    """
    Takes joint states, gives commands, and is the only one to start and stop them.

    A joint state is checked against the clock and the joints' limits and merged by name
    (`buffer`), turned into an effort (`compensation`), and limited (`output`). Every method
    takes the time of one steady clock, s. A returned command must be published by the caller,
    who then calls `published`; None means that nothing may be published.

    Attributes
    ----------
    output : EffortOutput
        State machine, ramps and limiter. To be read from outside, and changed only here.
    buffer : JointStateBuffer
        The measured joints; of no joint until `use`.
    compensation : object
        Its `torques(q, qd)` returns the gravity torque and the effort to send, both of shape
        (m,), N m or N; qd is None unless `needs_velocity`; see `dynamics.Compensation`.
    is_usable : bool
        Whether the newest joint state gave a gravity torque.
    gravity_torque : numpy.ndarray, shape (m,)
        G of the chosen joints at that state, N m or N.
    is_closed : bool
        Whether the process is about to end, so that nothing starts any more.

    """

    def __init__(self, settings, on_change=None):
        """
        Start with the output off and without a robot.

        Parameters
        ----------
        settings : OutputSettings
        on_change : callable(state, reason), optional
            See `OutputStateMachine`.

        """
        self.output = EffortOutput(settings, on_change)
        self.buffer = JointStateBuffer((), (), np.zeros(0))
        self.compensation = None
        self.is_usable = self.is_closed = False
        self.gravity_torque = np.zeros(0)
        self._restarts = 0
        self._periods: deque[float] = deque(maxlen=PERIODS)
        self._last_arrival = -math.inf
        self._last_look = self._last_tick = self._last_monitored = -math.inf

    @property
    def state(self):
        """The state of the output, an OutputState."""
        return self.output.machine.state

    @property
    def is_driving(self):
        """Whether commands follow the model: STARTING and ACTIVE."""
        return self.output.machine.is_driving

    @property
    def is_on(self):
        """Whether commands are published: STARTING, ACTIVE and STOPPING."""
        return self.output.machine.is_on

    @property
    def period(self):
        """Nominal period of the joint states, s: the median of the newest ones."""
        periods = sorted(self._periods)
        return periods[len(periods) // 2] if periods else STOP_PERIOD

    # ----------------------------------------------------------------- robot and parameters

    def use(self, buffer):
        """
        Take another robot's joints; the output is off.

        Parameters
        ----------
        buffer : JointStateBuffer

        """
        self.buffer = buffer
        self.compensation = None
        self.is_usable = False
        self._periods.clear()
        self._last_arrival = -math.inf

    def configure(self, now, settings, compensation, limiter, motion_limits):
        """
        Take over model and parameters; while driving, a change goes out over the start ramp.

        Parameters
        ----------
        now : float
            s.
        settings : OutputSettings
        compensation : Compensation
        limiter : EffortLimiter
        motion_limits : MotionLimits

        """
        before = self._target() if self.is_driving else None
        self.output.settings = settings
        self.compensation = compensation
        self.output.set_limiter(limiter)
        self.buffer.limits = motion_limits
        self.buffer.tolerance = StampTolerance(settings.state_timeout)
        after = self._target() if self.is_driving else None
        if before is None or after is None or len(before) != len(after):
            return
        if (difference := before - after).any():
            self.output.blend(now, difference)

    def _target(self):
        # Where the newest state's effort would lead without ramps and rate limits.
        if self.compensation is None or not self.buffer.is_complete:
            return None
        _, effort = self._torques(self.compensation)
        if not np.isfinite(effort).all():
            return None
        return np.array(self.output.limiter.target(effort))

    def _torques(self, compensation):
        velocity = self.buffer.velocity if compensation.needs_velocity else None
        return compensation.torques(self.buffer.position, velocity)

    # --------------------------------------------------------------- joint states and ticks

    def process_joint_state(
        self, now, names, positions, velocities=(), stamp=0, clock=0, efforts=()
    ):
        """
        Take a joint state; return the command that follows from it.

        Parameters
        ----------
        now : float
            Arrival, s.
        names, positions, velocities, stamp, clock, efforts
            See `JointStateBuffer.update`.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        Raises
        ------
        RejectedStateError
            If the message was dropped.

        """
        self.is_usable = False
        self._check_own_delay(now)
        self._take(now, names, positions, velocities, stamp, clock, efforts)
        age = self.buffer.age(now)
        if not self.buffer.is_complete or age > self.output.settings.state_timeout:
            return None
        if self._last_arrival > -math.inf:
            self._periods.append(now - self._last_arrival)
        self._last_arrival = now
        if self.compensation is None:
            return None
        self.gravity_torque, effort = self._torques(self.compensation)
        self.is_usable = True
        return self.output.follow(now, effort, self.period) if self.is_driving else None

    def _take(self, now, names, positions, velocities, stamp, clock, efforts):
        try:
            back = self.buffer.follow_clock(clock)
            if back:
                self._restart(now, f'the clock went back by {back:.3f} s, measured states dropped')
            self.buffer.update(now, names, positions, velocities, stamp, clock, efforts)
        except RejectedStateError as error:
            if error.is_fault:
                self.fault(now, str(error))
            raise
        fast = self.buffer.runaway()
        if fast:
            self.fault(now, f'runaway: {fast}, above velocity_limits')

    def _check_own_delay(self, now):
        # Whatever held up the process, the arm has moved unseen: the state that waits in the
        # queue is fresh, and its age would not tell.
        before, self._last_look = self._last_look, now
        if not self.is_driving:
            return
        timeout = self.output.settings.state_timeout
        if now - before > timeout:
            self.fault(
                now,
                f'the node itself stood still for {now - before:.3f} s, limit '
                f'{timeout:.3f} s: is the computer overloaded, or was it stopped?',
            )
        elif now - self._last_monitored > MAX_MONITOR_AGE:
            self.fault(
                now,
                'the search for other publishers and controllers has not run for '
                f'{now - self._last_monitored:.1f} s',
            )
        elif now - self._last_tick > timeout + MAX_MONITOR_AGE:
            self.fault(now, f'the watchdog has not run for {now - self._last_tick:.1f} s')

    def is_timely(self, now):
        """
        Tell whether the command just computed may still go out; if not, take it back and stop.

        Parameters
        ----------
        now : float
            s, right before publishing.

        Returns
        -------
        bool

        """
        late = now - self._last_look
        if late <= self.output.settings.state_timeout:
            return True
        self.output.limiter.withdraw()
        self.fault(
            now,
            f'the node itself stood still for {late:.3f} s between a joint state and its command',
        )
        return False

    def published(self, now):
        """
        Note that the command has gone out.

        Parameters
        ----------
        now : float
            s.

        """
        self.output.published(now)

    def monitored(self, now):
        """
        Note that other publishers and controllers have been looked for, without a finding.

        Parameters
        ----------
        now : float
            s.

        """
        self._last_monitored = now

    def tick(self, now):
        """
        Watch the age of the joint state; return the next command of a ramp or a stop.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None

        """
        age, timeout = self.buffer.age(now), self.output.settings.state_timeout
        if self.is_driving and age > timeout:
            self.output.stop(
                now,
                f'joint_states stale: last {age:.3f} s ago, limit {timeout:.3f} s',
                is_fault=True,
                may_hold=True,
            )
        self._last_look = self._last_tick = now
        return self.output.between(now)

    def next_tick_in(self, now):
        """
        Return when `tick` has to be called next while the output is on.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        float
            s: the next step of a ramp or a stop, or the moment at which the newest state
            becomes stale.

        """
        due = self.output.next_tick_in(now)
        if self.is_driving:
            due = min(due, self.output.settings.state_timeout - self.buffer.age(now))
        return max(due, MIN_TICK)

    # ------------------------------------------------------------------------ start and stop

    def enable(self, now):
        """
        Begin to send efforts; whether the arm may be driven has been found out before.

        The start ramp begins at the efforts in force: zero, or what `hold` or a deactivated
        controller has left, unless the measured efforts say that it is gone.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        bool
            False if the output is on, or the process is about to end.

        """
        if self.is_on or self.is_closed:
            return False
        self._restarts = 0
        self._last_look = self._last_tick = self._last_monitored = now
        self.output.start(now, self._in_force())
        return True

    def disable(self, now, reason):
        """
        Stop the output, or release what a stop has left in force.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.

        Returns
        -------
        bool
            Whether there is anything to stop.

        """
        if not self.is_driving and not self.output.has_effort_in_force:
            return False
        self.output.stop(now, reason)
        return True

    def fault(self, now, reason):
        """
        Stop because the arm must not be driven any further; nothing happens while all is zero.

        The last command is never held: it may be what the arm runs away with.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.

        """
        if self.is_on or self.state == OutputState.HOLDING:
            self.output.stop(now, reason, is_fault=True)

    def fail(self, now, reason):
        """Stop as `fault` does, and latch FAULT also while the output is off."""
        self.output.stop(now, reason, is_fault=True)

    def lose_controller(self, now, reason):
        """
        End in FAULT because the controller no longer takes commands; what it holds is unknown.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.

        """
        if self.is_on:
            left = self.output.limiter.describe_last()
            self.output.abandon(
                f'{reason}; the last efforts sent, which the hardware may hold: {left}'
            )

    def close(self, now, reason, within):
        """
        Stop for good because the process ends; a second call hastens the stop.

        Parameters
        ----------
        now : float
            s.
        reason : str
            For people.
        within : float
            Longest time for the stop, s.

        """
        self.is_closed = True
        if self.is_on or self.state == OutputState.HOLDING:
            self.output.stop(now, reason, within=within)

    def restart_from_zero(self, now, reason):
        """Begin the start ramp anew at zero, because no controller took the efforts so far."""
        if self.is_driving:
            self.output.start(now, np.zeros(len(self.output.limiter.last)), reason)

    def _restart(self, now, reason):
        # From the last command to the model's, because what was measured is no longer true.
        if not self.is_driving:
            return
        self._restarts = self._restarts + 1 if self.state == OutputState.STARTING else 1
        if self._restarts > MAX_RESTARTS:
            self.fault(now, f'{reason}, {self._restarts} times before the start ramp was over')
        else:
            self.output.start(now, self.output.limiter.last, reason)

    def _in_force(self):
        last, measured = self.output.limiter.last, self.buffer.needed_effort
        if not last.any() or len(measured) != len(last) or not np.isfinite(measured).all():
            return last
        is_gone = np.linalg.norm(measured - last) > np.linalg.norm(measured)
        return np.zeros(len(last)) if is_gone else last
