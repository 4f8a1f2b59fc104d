"""The newest measured state of every joint, merged from messages in any order."""

from collections import Counter
import math

import numpy as np

from .motion_limits import MotionLimits
from ..errors import DynamicsError, quoted

# More names than any robot has: such a message is refused before its arrays are touched.
MAX_NAMES = 4096
# A single impossible position may be a transmission error; this many in a row are a fault.
MAX_JUMPS = 3


class JointStateBuffer:
    """
    Positions, velocities and efforts by joint name.

    Messages may name the joints in any order, only some of them, and others besides. A message
    is taken whole or rejected whole; a rejected one does not make anything fresh.

    Attributes
    ----------
    accepted : int
        Messages taken.
    breaks : int
        How often everything measured was forgotten; see `forget`.
    rejected : collections.Counter
        Messages dropped, by kind.
    tolerance : StampTolerance
        How far stamps may be from the clock; may be replaced.
    limits : MotionLimits
        How far and fast the joints can move.

    """

    def __init__(self, names, needed, neutral, limits=None, tolerance=None):
        """
        Start without measurements.

        Parameters
        ----------
        names : sequence of str
            All n joints of the robot.
        needed : sequence of str
            Those that must be fresh for a state to be usable.
        neutral : numpy.ndarray, shape (n,)
            Where a joint is taken to stand until it is measured, rad or m.
        limits : MotionLimits, optional
            Of the n joints; none by default.
        tolerance : StampTolerance, optional

        """
        self._index = {name: i for i, name in enumerate(names)}
        self._names = tuple(names)
        self._needed = [self._index[name] for name in needed]
        self.limits = limits or MotionLimits.none(names)
        self.tolerance = tolerance or StampTolerance(0.0)
        # Lists, not arrays: for the few joints of a robot plain numbers are several times as
        # fast as numpy, and this runs for every state before its command goes out.
        self._position = np.array(neutral, dtype=float).tolist()
        self._velocity = [math.nan] * len(names)
        self._effort = [math.nan] * len(names)
        self._time = [-math.inf] * len(names)
        self._stamp = [0] * len(names)
        self._newest_stamp = 0
        self._oldest = self._forgotten = -math.inf
        self._jumps = 0
        self._jumped_joint = -1
        self._clock = 0
        self._known_names = None
        self._pairs: list[tuple[int, int]] = []
        self._needed_pairs: list[tuple[int, int]] = []
        self._has_all_needed = False
        self.accepted = self.breaks = 0
        self.rejected: Counter[str] = Counter()

    def follow_clock(self, clock):
        """
        Compare the clock of the stamps with the last one; forget all measurements if it is behind.

        Parameters
        ----------
        clock : int
            That clock now, ns.

        Returns
        -------
        float
            By how much it has gone back, s; 0.0 for less than stamps may be wrong anyway.

        Raises
        ------
        RejectedStateError
            Kind 'no clock': it stands at zero, so it is simulated time that nobody publishes.

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

    def update(self, now, names, positions, velocities=(), stamp=0, clock=0, efforts=()):
        """
        Take one message.

        The age of its joints counts from the stamp where there is one: a state that has been
        delayed on its way is as old as it is, not as young as its arrival.

        Parameters
        ----------
        now : float
            Arrival on a steady clock, s.
        names : list of str
        positions : sequence of float
            As many as names, rad or m.
        velocities : sequence of float
            As many as names or empty; NaN where unknown.
        stamp : int
            When the state was measured, ns; 0 if the message does not say it.
        clock : int
            Arrival on the clock that stamps belong to, ns.
        efforts : sequence of float
            As many as names; anything else makes them unknown, and is no reason to drop a state
            whose positions are good.

        Raises
        ------
        RejectedStateError
            If lengths differ, a name comes twice, the stamp is far from the clock or not newer
            than the last one, or the position of a needed joint is not finite or further from
            one that is still fresh than the joint can have moved. That of another joint is
            passed over. The third jump in a row is a fault: the last position is forgotten, so
            that the next message counts.

        """
        try:
            self._update(now, names, positions, velocities, stamp, clock)
        except RejectedStateError as error:
            self.rejected[error.kind] += 1
            raise
        self._take_efforts(efforts, len(names))
        if self._jumps and any(target == self._jumped_joint for _, target in self._needed_pairs):
            self._jumps = 0  # it is the joint itself that stands where it may
        self.accepted += 1

    def _update(self, now, names, positions, velocities, stamp, clock):
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
            # No joint is that fast: it is not known how fast it is.
            velocities = [math.nan if math.isinf(value) else value for value in velocities]
        # The tolerance above has made sure that the stamp is credible.
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

    def _take_efforts(self, efforts, count):
        effort = self._effort
        if len(efforts) != count:
            for _, target in self._pairs:
                effort[target] = math.nan
            return
        for source, target in self._pairs:
            value = efforts[source]
            effort[target] = math.nan if math.isinf(value) else value

    def _check_order(self, pairs, stamp, clock):
        if stamp > self._newest_stamp:
            return
        last = max((self._stamp[target] for _, target in pairs), default=0)
        # A stamp that was true once and is ahead by now: the clock was set back, and what was
        # measured before says nothing about the order any more.
        if stamp > last or self.tolerance.is_ahead(last, clock):
            return
        kind = 'repeated' if stamp == last else 'going back'
        raise RejectedStateError(
            'old stamp',
            f'expected a newer stamp than the last one, got one that is {kind} by '
            f'{(last - stamp) * 1e-9:.3f} s: does a bag loop, or do two nodes publish?',
        )

    def _check_steps(self, now, positions, stamp):
        small, position = self.limits.small_steps, self._position
        for source, target in self._needed_pairs:
            # Nearly every step is possible in however short a time.
            if not -small[target] <= positions[source] - position[target] <= small[target]:
                self._check_step(target, now, positions[source], stamp)

    def _check_step(self, joint, now, position, stamp):
        if now - self._time[joint] > self.tolerance.seconds:
            return  # too long ago to say where the joint can be by now
        last = self._stamp[joint]
        dt = (stamp - last) * 1e-9 if stamp and last else now - self._time[joint]
        if self.limits.is_impossible(joint, self._position[joint], position, dt):
            self._jumped(joint, position, dt)

    def _jumped(self, joint, position, dt):
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

    def forget(self):
        """
        Take no joint for measured any more, because the time or the arm has jumped.

        `age` goes on from the last state: a reset does not count as a fresh measurement.

        """
        self._forgotten = max(self._oldest, self._forgotten)
        self._oldest = -math.inf
        self._jumps = 0
        self.breaks += 1
        self._effort = [math.nan] * len(self._names)
        self._time = [-math.inf] * len(self._names)
        self._stamp = [0] * len(self._names)
        self._newest_stamp = 0

    def _finite_pairs(self, positions):
        wrong = {target for source, target in self._pairs if not math.isfinite(positions[source])}
        missing = [self._names[i] for _, i in self._pairs if i in wrong and i in self._needed]
        if missing:
            raise RejectedStateError(
                'not finite',
                f'expected finite positions, got NaN or infinity for {", ".join(missing)}',
            )
        return [(source, target) for source, target in self._pairs if target not in wrong]

    def _learn(self, names):
        # The mapping by name; kept until a message names other joints or another order.
        if len(names) > MAX_NAMES:
            raise too_many_names(len(names))
        if len(set(names)) != len(names):
            twice = sorted(name for name, count in Counter(names).items() if count > 1)
            # Anybody may have written them: short, and without what a terminal would obey.
            raise RejectedStateError(
                'name twice',
                'expected each joint once, got twice: ' + ', '.join(map(quoted, twice[:5])),
            )
        self._pairs = [
            (i, self._index[name]) for i, name in enumerate(names) if name in self._index
        ]
        needed = set(self._needed)
        self._needed_pairs = [pair for pair in self._pairs if pair[1] in needed]
        self._has_all_needed = bool(needed) and len(self._needed_pairs) == len(needed)
        self._known_names = list(names)

    @property
    def position(self):
        """Newest positions, or neutral ones where never measured; shape (n,), a copy."""
        return np.array(self._position, dtype=float)

    @property
    def velocity(self):
        """Newest velocities, NaN where unknown; shape (n,), a copy."""
        return np.array(self._velocity, dtype=float)

    @property
    def effort(self):
        """Newest efforts, NaN where unknown; shape (n,), a copy."""
        return np.array(self._effort, dtype=float)

    @property
    def needed_effort(self):
        """Newest efforts of the needed joints, NaN where unknown; a copy."""
        return np.array([self._effort[i] for i in self._needed])

    @property
    def measured(self):
        """When the oldest of the needed joints was measured, ns; 0 where that is not said."""
        return min((self._stamp[i] for i in self._needed), default=0)

    @property
    def newest_measured(self):
        """When the newest of the needed joints was measured, ns; 0 where that is not said."""
        return max((self._stamp[i] for i in self._needed), default=0)

    @property
    def newest_names(self):
        """Names in the newest message whose names could be used, whatever came of the rest."""
        return tuple(self._known_names or ())

    def joints_without_velocity(self):
        """Return the names of the needed joints whose velocity is unknown, a list of str."""
        return [self._names[i] for i in self._needed if math.isnan(self._velocity[i])]

    @property
    def is_complete(self):
        """Whether every needed joint has been measured, however long ago."""
        return self._oldest > -math.inf

    def runaway(self):
        """Return which needed joints are above their velocity limit; '' if none is."""
        return self.limits.runaway(self._needed, self._velocity)

    def outside(self):
        """Return which needed joints stand beyond their position limits; '' if none does."""
        return self.limits.outside(self._needed, self._position)

    def age(self, now):
        """
        Return how old the oldest of the needed joints is.

        Parameters
        ----------
        now : float
            The same steady clock, s.

        Returns
        -------
        float
            s; infinite while a needed joint was never measured.

        """
        return now - max(self._oldest, self._forgotten)

    def stale_joints(self, now, timeout, joints=None):
        """
        Return which needed joints are missing, or which of some others.

        Parameters
        ----------
        now : float
            The same steady clock, s.
        timeout : float
            Age that is still fresh, s.
        joints : sequence of int, optional
            Places of joints, instead of those that are needed.

        Returns
        -------
        list of str

        """
        return [
            self._names[i]
            for i in (self._needed if joints is None else joints)
            if now - self._time[i] > timeout
        ]


def too_many_names(count):
    """Return the error about a message with more names than any robot has."""
    return RejectedStateError('too many names', f'expected at most {MAX_NAMES} names, got {count}')


class RejectedStateError(DynamicsError):
    """
    A joint state message was dropped.

    Attributes
    ----------
    kind : str
        Short and constant, for counting.
    is_fault : bool
        Whether the arm must not be driven any further.

    """

    def __init__(self, kind, message, is_fault=False):
        self.kind = kind
        self.is_fault = is_fault
        super().__init__(message)


# However short the timeout: clocks of two machines that are synchronized differ by less.
SMALLEST_TOLERANCE = 0.1


class StampTolerance:
    """
    Compares stamps with the node's own clock.

    Attributes
    ----------
    seconds : float
        The largest difference that is accepted, in both directions, s.

    """

    def __init__(self, state_timeout):
        """
        Accept what is not older than a state may be.

        Parameters
        ----------
        state_timeout : float
            Largest age of a joint state, s.

        """
        self.seconds = max(state_timeout, SMALLEST_TOLERANCE)
        self._nanoseconds = round(self.seconds * 1e9)

    def check(self, stamp, clock):
        """
        Refuse a stamp that is too far from the clock.

        Parameters
        ----------
        stamp : int
            ns.
        clock : int
            The time at which the message arrived, on the clock that stamps belong to, ns.

        Raises
        ------
        RejectedStateError
            Kind 'stamp'; says by how much, and what to look for.

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

    def is_ahead(self, stamp, clock):
        """Tell whether a stamp that was accepted once lies in the future of the clock by now."""
        return stamp - clock > self._nanoseconds
