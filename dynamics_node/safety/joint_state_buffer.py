"""
The newest measured state of every joint: which joint states are accepted, and their age.

Messages are checked against the joints' motion limits and, by their stamps, against the clock.

"""

from collections import Counter
from collections.abc import Iterable, Sequence
import math
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .motion_limits import MotionLimits
from ..errors import quoted, RejectedStateError

# Largest number of names in a message; a longer one is refused before its arrays are read.
MAX_NAMES = 4096
# A single impossible position may be a transmission error; this many in a row are a fault.
MAX_JUMPS = 3
# Smallest tolerance of stamps, s: synchronized clocks of two machines differ by less.
SMALLEST_TOLERANCE = 0.1


class JointStateBuffer:
    """
    Positions, velocities and efforts by joint name.

    A message may contain the joints in any order, some of them only, and other joints. It is
    accepted or rejected as a whole; a rejected message makes no joint fresh.

    Attributes
    ----------
    accepted : int
        Number of accepted messages.
    breaks : int
        Number of times that all measurements were forgotten; see `forget`.
    rejected : collections.Counter
        Number of dropped messages, by kind.
    tolerance : StampTolerance
        Largest difference between stamps and the clock; may be replaced.
    limits : MotionLimits
        Position and velocity limits of the joints; may be replaced.

    """

    def __init__(
        self,
        names: Sequence[str],
        needed: Sequence[str],
        neutral: ArrayLike,
        limits: MotionLimits | None = None,
        tolerance: 'StampTolerance | None' = None,
    ) -> None:
        """
        Start without measurements.

        Parameters
        ----------
        names : sequence of str
            All n joints of the robot.
        needed : sequence of str
            The joints that must be fresh for a usable state.
        neutral : array_like, shape (n,)
            Assumed position of a joint until its first measurement, rad or m.
        limits : MotionLimits, optional
            Limits of the n joints; none by default.
        tolerance : StampTolerance, optional

        """
        self._index = {name: i for i, name in enumerate(names)}
        self._names = tuple(names)
        self._needed = [self._index[name] for name in needed]
        self.limits = limits or MotionLimits.none(names)
        self.tolerance = tolerance or StampTolerance(0.0)
        # Lists instead of arrays: for the few joints of a robot, plain numbers are several times
        # faster than numpy, and every command waits for this.
        self._position: list[float] = np.array(neutral, dtype=float).tolist()
        self._velocity = [math.nan] * len(names)
        self._effort = [math.nan] * len(names)
        self._time = [-math.inf] * len(names)
        self._stamp = [0] * len(names)
        self._newest_stamp = 0
        self._oldest = self._forgotten = -math.inf
        self._jumps = 0
        self._jumped_joint = -1
        self._clock = 0
        self._known_names: list[str] | None = None
        self._pairs: list[tuple[int, int]] = []
        self._needed_pairs: list[tuple[int, int]] = []
        self._has_all_needed = False
        self.accepted = self.breaks = 0
        self.rejected: Counter[str] = Counter()

    def follow_clock(self, clock: int) -> float:
        """
        Forget all measurements if the clock of the stamps has gone back.

        Parameters
        ----------
        clock : int
            Current time of that clock, ns.

        Returns
        -------
        float
            The step back, s; 0.0 if it is within the tolerance of stamps.

        Raises
        ------
        RejectedStateError
            Kind 'no clock': the clock is zero, so simulated time has no publisher.

        """
        if not clock:
            self.rejected['no clock'] += 1
            raise RejectedStateError(
                'no clock',
                'use_sim_time is true, but nothing has come on '
                '/clock yet: start the simulation, or set it to false',
            )
        back, self._clock = (self._clock - clock) * 1e-9, clock
        if back <= self.tolerance.seconds:
            return 0.0
        self.forget()
        return back

    def update(
        self,
        now: float,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float] = (),
        stamp: int = 0,
        clock: int = 0,
        efforts: Sequence[float] = (),
    ) -> None:
        """
        Accept or reject one message.

        The age of its joints counts from the stamp if there is one, so that a delay on the way
        counts as age.

        Parameters
        ----------
        now : float
            Arrival on a steady clock, s.
        names : list of str
        positions : sequence of float
            One per name, rad or m.
        velocities : sequence of float
            One per name, or empty, rad/s or m/s; NaN where unknown.
        stamp : int
            Time of the measurement, ns; 0 if unknown.
        clock : int
            Arrival on the clock of the stamps, ns.
        efforts : sequence of float
            One per name, N m or N. With another length the efforts are unknown, and the message
            is still accepted.

        Raises
        ------
        RejectedStateError
            If lengths differ, a name is repeated, the stamp is far from the clock or not newer
            than the last one, or a needed joint has a position that is not finite or that it
            cannot have reached since its last, still fresh measurement. Such positions of other
            joints are ignored. The third jump in a row is a fault: all measurements are
            forgotten, so that the next message is accepted.

        """
        try:
            self._update(now, names, positions, velocities, stamp, clock)
        except RejectedStateError as error:
            self.rejected[error.kind] += 1
            raise
        self._take_efforts(efforts, len(names))
        if self._jumps and any(target == self._jumped_joint for _, target in self._needed_pairs):
            self._jumps = 0  # the joint that jumped has reported a plausible position again
        self.accepted += 1

    def _update(
        self,
        now: float,
        names: Sequence[str],
        positions: Sequence[float],
        velocities: Sequence[float],
        stamp: int,
        clock: int,
    ) -> None:
        if names != self._known_names:
            self._learn(names)
        if len(positions) != len(names):
            raise RejectedStateError(
                'length',
                f'expected {len(names)} positions for {len(names)} names, got {len(positions)}',
            )
        if len(velocities) not in (0, len(names)):
            raise RejectedStateError(
                'length', f'expected {len(names)} velocities or none, got {len(velocities)}'
            )
        pairs, is_complete = self._pairs, self._has_all_needed
        if not all(map(math.isfinite, positions)):
            pairs, is_complete = self._finite_pairs(positions), False
        if stamp:
            self.tolerance.check(stamp, clock)
            self._check_order(pairs, stamp, clock)
        self._check_steps(now, positions, stamp)
        position, velocity, time, stamps = self._position, self._velocity, self._time, self._stamp
        has_velocities = len(velocities) > 0
        if any(map(math.isinf, velocities)):
            # An infinite velocity is a wrong measurement: it is unknown.
            velocities = [math.nan if math.isinf(value) else value for value in velocities]
        # The stamp is credible: the tolerance has been checked above.
        measured = now - max(clock - stamp, 0) * 1e-9 if stamp else now
        for source, target in pairs:
            position[target] = positions[source]
            velocity[target] = velocities[source] if has_velocities else math.nan
            time[target] = measured
            stamps[target] = stamp
        self._newest_stamp = max(stamp, self._newest_stamp)
        self._oldest = (
            measured
            if is_complete
            else min((self._time[i] for i in self._needed), default=-math.inf)
        )

    def _take_efforts(self, efforts: Sequence[float], count: int) -> None:
        effort = self._effort
        if len(efforts) != count:
            for _, target in self._pairs:
                effort[target] = math.nan
            return
        for source, target in self._pairs:
            value = efforts[source]
            effort[target] = math.nan if math.isinf(value) else value

    def _check_order(self, pairs: list[tuple[int, int]], stamp: int, clock: int) -> None:
        if stamp > self._newest_stamp:
            return
        last = max((self._stamp[target] for _, target in pairs), default=0)
        # A last stamp ahead of the clock: the clock was set back, so stamps of earlier
        # measurements no longer tell the order.
        if stamp > last or self.tolerance.is_ahead(last, clock):
            return
        kind = 'repeated' if stamp == last else 'going back'
        raise RejectedStateError(
            'old stamp',
            f'expected a newer stamp than the last one, got one that is {kind} by '
            f'{(last - stamp) * 1e-9:.3f} s: does a bag loop, or do two nodes publish?',
        )

    def _check_steps(self, now: float, positions: Sequence[float], stamp: int) -> None:
        small, position = self.limits.small_steps, self._position
        for source, target in self._needed_pairs:
            # Nearly every step is so small that it is possible in any time.
            if not -small[target] <= positions[source] - position[target] <= small[target]:
                self._check_step(target, now, positions[source], stamp)

    def _check_step(self, joint: int, now: float, position: float, stamp: int) -> None:
        if now - self._time[joint] > self.tolerance.seconds:
            return  # stale: the joint can have reached any position
        last = self._stamp[joint]
        dt = (stamp - last) * 1e-9 if stamp and last else now - self._time[joint]
        if self.limits.is_impossible(joint, self._position[joint], position, dt):
            self._jumped(joint, position, dt)

    def _jumped(self, joint: int, position: float, dt: float) -> NoReturn:
        text = (
            'expected a position that the joint can have reached, got '
            + self.limits.describe_jump(joint, self._position[joint], position, dt)
        )
        self._jumps += 1
        self._jumped_joint = joint
        if self._jumps < MAX_JUMPS:
            raise RejectedStateError('jump', text)
        self.forget()
        raise RejectedStateError('jump', f'{text}, {MAX_JUMPS} times in a row', is_fault=True)

    def forget(self) -> None:
        """
        Forget all measurements, because the clock or the arm has jumped.

        `age` continues from the last state: a reset does not count as a fresh measurement.

        """
        self._forgotten = max(self._oldest, self._forgotten)
        self._oldest = -math.inf
        self._jumps = 0
        self.breaks += 1
        self._effort = [math.nan] * len(self._names)
        self._time = [-math.inf] * len(self._names)
        self._stamp = [0] * len(self._names)
        self._newest_stamp = 0

    def _finite_pairs(self, positions: Sequence[float]) -> list[tuple[int, int]]:
        wrong = {target for source, target in self._pairs if not math.isfinite(positions[source])}
        missing = [self._names[i] for _, i in self._pairs if i in wrong and i in self._needed]
        if missing:
            raise RejectedStateError(
                'not finite',
                f'expected finite positions, got NaN or infinity for {", ".join(missing)}',
            )
        return [(source, target) for source, target in self._pairs if target not in wrong]

    def _learn(self, names: Sequence[str]) -> None:
        # The mapping by name, kept until a message has other joints or another order.
        if len(names) > MAX_NAMES:
            raise too_many_names(len(names))
        if len(set(names)) != len(names):
            repeated = sorted(name for name, count in Counter(names).items() if count > 1)
            # Untrusted text: quoted, without control characters, at most five names.
            raise RejectedStateError(
                'name twice',
                'expected each joint once, got twice: ' + ', '.join(map(quoted, repeated[:5])),
            )
        self._pairs = [
            (i, self._index[name]) for i, name in enumerate(names) if name in self._index
        ]
        needed = set(self._needed)
        self._needed_pairs = [pair for pair in self._pairs if pair[1] in needed]
        self._has_all_needed = bool(needed) and len(self._needed_pairs) == len(needed)
        self._known_names = list(names)

    @property
    def position(self) -> NDArray[np.float64]:
        """Newest positions, neutral where never measured, rad or m; shape (n,), a copy."""
        return np.array(self._position, dtype=float)

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Newest velocities, rad/s or m/s, NaN where unknown; shape (n,), a copy."""
        return np.array(self._velocity, dtype=float)

    @property
    def effort(self) -> NDArray[np.float64]:
        """Newest efforts, N m or N, NaN where unknown; shape (n,), a copy."""
        return np.array(self._effort, dtype=float)

    @property
    def needed_effort(self) -> NDArray[np.float64]:
        """Newest efforts of the needed joints, N m or N, NaN where unknown; a copy."""
        return np.array([self._effort[i] for i in self._needed])

    @property
    def measured(self) -> int:
        """Stamp of the oldest measurement of a needed joint, ns; 0 if it has none."""
        return min((self._stamp[i] for i in self._needed), default=0)

    @property
    def newest_measured(self) -> int:
        """Stamp of the newest measurement of a needed joint, ns; 0 if it has none."""
        return max((self._stamp[i] for i in self._needed), default=0)

    @property
    def newest_names(self) -> tuple[str, ...]:
        """Joint names of the last message with valid names, even if it was then rejected."""
        return tuple(self._known_names or ())

    def joints_without_velocity(self) -> list[str]:
        """Return the names of the needed joints with unknown velocity."""
        return [self._names[i] for i in self._needed if math.isnan(self._velocity[i])]

    @property
    def is_complete(self) -> bool:
        """Whether every needed joint has been measured, at any time."""
        return self._oldest > -math.inf

    def runaway(self) -> str:
        """Return the needed joints above their velocity limits, as text; '' if there are none."""
        return self.limits.runaway(self._needed, self._velocity)

    def outside(self) -> str:
        """Return the needed joints beyond their position limits, as text; '' if there are none."""
        return self.limits.outside(self._needed, self._position)

    def age(self, now: float) -> float:
        """
        Return the age of the oldest measurement of a needed joint.

        Parameters
        ----------
        now : float
            The same steady clock, s.

        Returns
        -------
        float
            s; infinite before the first measurement of every needed joint.

        """
        return now - max(self._oldest, self._forgotten)

    def stale_joints(
        self, now: float, timeout: float, joints: Iterable[int] | None = None
    ) -> list[str]:
        """
        Return the joints without a fresh measurement.

        Parameters
        ----------
        now : float
            The same steady clock, s.
        timeout : float
            Largest age of a fresh measurement, s.
        joints : iterable of int, optional
            Indices of the joints in question; the needed joints by default.

        Returns
        -------
        list of str
            Their names.

        """
        return [
            self._names[i]
            for i in (self._needed if joints is None else joints)
            if now - self._time[i] > timeout
        ]


def too_many_names(count: int) -> RejectedStateError:
    """Return the error about a message with more than MAX_NAMES names."""
    return RejectedStateError('too many names', f'expected at most {MAX_NAMES} names, got {count}')


class StampTolerance:
    """
    Compares stamps with the node's clock.

    Attributes
    ----------
    seconds : float
        Largest accepted difference in both directions, s.

    """

    def __init__(self, state_timeout: float) -> None:
        """
        Set the tolerance from the state timeout.

        Parameters
        ----------
        state_timeout : float
            Largest age of a joint state, s.

        """
        self.seconds = max(state_timeout, SMALLEST_TOLERANCE)
        self._nanoseconds = round(self.seconds * 1e9)

    def check(self, stamp: int, clock: int) -> None:
        """
        Refuse a stamp that is too far from the clock.

        Parameters
        ----------
        stamp : int
            ns.
        clock : int
            Arrival of the message on the clock of the stamps, ns.

        Raises
        ------
        RejectedStateError
            Kind 'stamp', with the difference and its probable causes.

        """
        late = clock - stamp
        if -self._nanoseconds <= late <= self._nanoseconds:
            return
        side = 'old' if late > 0 else 'in the future'
        raise RejectedStateError(
            'stamp',
            f'expected a stamp within {self.seconds:g} s of the clock, got one '
            f'{abs(late) * 1e-9:.3f} s {side}: synchronize the clocks of both machines, and '
            'set use_sim_time on both sides or on neither',
        )

    def is_ahead(self, stamp: int, clock: int) -> bool:
        """Tell whether a stamp, accepted earlier, is now in the future of the clock."""
        return stamp - clock > self._nanoseconds
