"""From a joint state to a command: one class owns every step in between."""

from collections import deque
from collections.abc import Callable, Sequence
import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .effort_limiter import EffortLimiter
from .effort_output import EffortOutput, OutputSettings, STOP_PERIOD
from .joint_state_buffer import JointStateBuffer, StampTolerance
from .motion_limits import MotionLimits
from .state_machine import OutputState
from ..errors import RejectedStateError

# Number of intervals whose median is the nominal period of the joint states.
PERIODS = 9
# Shortest time between two ticks, s.
MIN_TICK = 0.001
# Largest number of restarts before a start ramp has ended; more are a fault.
MAX_RESTARTS = 3
# Longest time without a search for other publishers and controllers while efforts are sent, s.
MAX_MONITOR_AGE = 2.0


class Compensation(Protocol):
    """The model behind the efforts; see `dynamics.Compensation`."""

    @property
    def needs_velocity(self) -> bool:
        """Whether `torques` reads the velocity; otherwise it may be None."""

    def torques(
        self, position: NDArray[np.float64], velocity: NDArray[np.float64] | None, /
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return gravity torque and effort to send, N m or N, each of shape (m,)."""


class TorquePath:
    """
    Turns joint states into commands; only this class starts and stops them.

    A joint state is checked against the clock and the joints' limits and merged by name
    (`buffer`), turned into an effort (`compensation`), and limited (`output`). Every method
    takes the time of one steady clock, s. The caller must publish a returned command and then
    call `published`; None means that nothing may be published.

    Attributes
    ----------
    output : EffortOutput
        State machine, ramps and limiter. Other classes only read it.
    buffer : JointStateBuffer
        The measured joints; without joints until `use`.
    compensation : Compensation or None
        None without a robot.
    is_usable : bool
        Whether the newest joint state gave a gravity torque.
    gravity_torque : numpy.ndarray, shape (m,)
        G of the chosen joints at that state, N m or N.
    is_closed : bool
        Whether the process is about to end, so that the output cannot start again.

    """

    def __init__(
        self, settings: OutputSettings, on_change: Callable[[OutputState, str], None] | None = None
    ) -> None:
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
        self.compensation: Compensation | None = None
        self.is_usable = self.is_closed = False
        self.gravity_torque: NDArray[np.float64] = np.zeros(0)
        self._restarts = 0
        self._periods: deque[float] = deque(maxlen=PERIODS)
        self._last_arrival = -math.inf
        self._last_look = self._last_tick = self._last_monitored = -math.inf

    @property
    def state(self) -> OutputState:
        """The state of the output, an OutputState."""
        return self.output.machine.state

    @property
    def is_driving(self) -> bool:
        """Whether commands follow the model: STARTING and ACTIVE."""
        return self.output.machine.is_driving

    @property
    def is_on(self) -> bool:
        """Whether commands are published: STARTING, ACTIVE and STOPPING."""
        return self.output.machine.is_on

    @property
    def period(self) -> float:
        """Nominal period of the joint states, s: the median of the newest ones."""
        periods = sorted(self._periods)
        return periods[len(periods) // 2] if periods else STOP_PERIOD

    # ----------------------------------------------------------------- robot and parameters

    def use(self, buffer: JointStateBuffer) -> None:
        """
        Switch to the joints of another robot while the output is off.

        Parameters
        ----------
        buffer : JointStateBuffer

        """
        self.buffer = buffer
        self.compensation = None
        self.is_usable = False
        self._periods.clear()
        self._last_arrival = -math.inf

    def configure(
        self,
        now: float,
        settings: OutputSettings,
        compensation: Compensation,
        limiter: EffortLimiter,
        motion_limits: MotionLimits,
    ) -> None:
        """
        Apply model and parameters; while driving, a change is spread over the start ramp.

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

    def _target(self) -> NDArray[np.float64] | None:
        # The command for the newest state without ramps and rate limits.
        if self.compensation is None or not self.buffer.is_complete:
            return None
        _, effort = self._torques(self.compensation)
        if not np.isfinite(effort).all():
            return None
        return np.array(self.output.limiter.target(effort))

    def _torques(
        self, compensation: Compensation
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        velocity = self.buffer.velocity if compensation.needs_velocity else None
        return compensation.torques(self.buffer.position, velocity)

    # --------------------------------------------------------------- joint states and ticks

    def process_joint_state(
        self,
        now: float,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float] = (),
        stamp: int = 0,
        clock: int = 0,
        efforts: Sequence[float] = (),
    ) -> NDArray[np.float64] | None:
        """
        Accept a joint state and return the command for it.

        Parameters
        ----------
        now : float
            Arrival, s.
        names, positions, velocities, stamp, clock, efforts
            See `JointStateBuffer.update`.

        Returns
        -------
        numpy.ndarray, shape (m,), or None
            N m or N.

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

    def _take(
        self,
        now: float,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float],
        stamp: int,
        clock: int,
        efforts: Sequence[float],
    ) -> None:
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

    def _check_own_delay(self, now: float) -> None:
        # During a standstill of the process the arm moves unobserved. The state that waits in
        # the queue is fresh, so its age does not show the standstill.
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

    def is_timely(self, now: float) -> bool:
        """
        Tell whether the computed command may still be published; if not, withdraw it and stop.

        Parameters
        ----------
        now : float
            Time right before publishing, s.

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

    def published(self, now: float) -> None:
        """
        Note that the command is published.

        Parameters
        ----------
        now : float
            s.

        """
        self.output.published(now)

    def monitored(self, now: float) -> None:
        """
        Note that a search for other publishers and controllers has found no conflict.

        Parameters
        ----------
        now : float
            s.

        """
        self._last_monitored = now

    def tick(self, now: float) -> NDArray[np.float64] | None:
        """
        Check the age of the joint state; return the next command of a ramp or a stop.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        numpy.ndarray, shape (m,), or None
            N m or N.

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

    def next_tick_in(self, now: float) -> float:
        """
        Return the time until the next call of `tick` while the output is on.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        float
            s: until the next step of a ramp or a stop, or until the newest state is stale.

        """
        due = self.output.next_tick_in(now)
        if self.is_driving:
            due = min(due, self.output.settings.state_timeout - self.buffer.age(now))
        return max(due, MIN_TICK)

    # ------------------------------------------------------------------------ start and stop

    def enable(self, now: float) -> bool:
        """
        Start the output; the caller has checked that the arm may be driven.

        The start ramp begins at the efforts in force: zero, or the last efforts before `hold` or
        the deactivation of a controller, unless the measured efforts show that they are gone.

        Parameters
        ----------
        now : float
            s.

        Returns
        -------
        bool
            False if the output is already on, or the process is about to end.

        """
        if self.is_on or self.is_closed:
            return False
        self._restarts = 0
        self._last_look = self._last_tick = self._last_monitored = now
        self.output.start(now, self._in_force())
        return True

    def disable(self, now: float, reason: str) -> bool:
        """
        Stop the output, or ramp down efforts that are still in force.

        Parameters
        ----------
        now : float
            s.
        reason : str
            Cause, as text.

        Returns
        -------
        bool
            False if the output is off without an effort in force, or already stopping.

        """
        if not self.is_driving and not self.output.has_effort_in_force:
            return False
        self.output.stop(now, reason)
        return True

    def fault(self, now: float, reason: str) -> None:
        """
        Stop because the arm must not be driven any further; no effect while READY or FAULT.

        The last command is never held: it may drive a runaway.

        Parameters
        ----------
        now : float
            s.
        reason : str
            Cause, as text.

        """
        if self.is_on or self.state == OutputState.HOLDING:
            self.output.stop(now, reason, is_fault=True)

    def fail(self, now: float, reason: str) -> None:
        """Stop as `fault` does, and enter FAULT even if the output is off."""
        self.output.stop(now, reason, is_fault=True)

    def lose_controller(self, now: float, reason: str) -> None:
        """
        End in FAULT because no controller takes commands; the efforts in force are unknown.

        Parameters
        ----------
        now : float
            s.
        reason : str
            Cause, as text.

        """
        if self.is_on:
            left = self.output.limiter.describe_last()
            self.output.abandon(
                f'{reason}; the last efforts sent, which the hardware may hold: {left}'
            )

    def close(self, now: float, reason: str, within: float) -> None:
        """
        Stop for good because the process ends; a second call shortens the stop.

        Parameters
        ----------
        now : float
            s.
        reason : str
            Cause, as text.
        within : float
            Longest duration of the stop, s.

        """
        self.is_closed = True
        if self.is_on or self.state == OutputState.HOLDING:
            self.output.stop(now, reason, within=within)

    def restart_from_zero(self, now: float, reason: str) -> None:
        """Restart the start ramp at zero, because no controller took the efforts so far."""
        if self.is_driving:
            self.output.start(now, np.zeros(len(self.output.limiter.last)), reason)

    def _restart(self, now: float, reason: str) -> None:
        # A new start ramp from the last command, because the measurements are no longer valid.
        if not self.is_driving:
            return
        self._restarts = self._restarts + 1 if self.state == OutputState.STARTING else 1
        if self._restarts > MAX_RESTARTS:
            self.fault(now, f'{reason}, {self._restarts} times before the start ramp was over')
        else:
            self.output.start(now, self.output.limiter.last, reason)

    def _in_force(self) -> NDArray[np.float64]:
        last, measured = self.output.limiter.last, self.buffer.needed_effort
        if not last.any() or len(measured) != len(last) or not np.isfinite(measured).all():
            return last
        is_gone = np.linalg.norm(measured - last) > np.linalg.norm(measured)
        return np.zeros(len(last)) if is_gone else last
