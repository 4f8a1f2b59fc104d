"""The newest measured state of every joint, merged from messages in any order."""

from collections import Counter
import math

import numpy as np

from ..errors import DynamicsError

# More names than any robot has: such a message is refused before its arrays are touched.
MAX_NAMES = 4096


class RejectedStateError(DynamicsError):
    """
    A joint state message was dropped.

    Attributes
    ----------
    kind : str
        Short and constant, for counting.

    """

    def __init__(self, kind, message):
        self.kind = kind
        super().__init__(message)


class JointStateBuffer:
    """
    Positions and velocities by joint name.

    Messages may name the joints in any order, only some of them, and others besides. A message
    is taken whole or rejected whole; a rejected one does not make anything fresh.

    Attributes
    ----------
    accepted : int
        Messages taken.
    rejected : collections.Counter
        Messages dropped, by kind.

    """

    def __init__(self, names, needed, neutral):
        """
        Start with no joint measured.

        Parameters
        ----------
        names : sequence of str
            All n joints of the robot.
        needed : sequence of str
            Those that must be fresh for a state to be usable.
        neutral : numpy.ndarray, shape (n,)
            Where a joint is taken to stand until it is measured, rad or m.

        """
        self._index = {name: i for i, name in enumerate(names)}
        self._names = tuple(names)
        self._needed = [self._index[name] for name in needed]
        # Lists, not arrays: for the few joints of a robot plain numbers are several times as
        # fast as numpy, and this runs for every state before its command goes out.
        self._position = np.array(neutral, dtype=float).tolist()
        self._velocity = [math.nan] * len(names)
        self._time = [-math.inf] * len(names)
        self._oldest = -math.inf
        self._known_names = None
        self._pairs: list[tuple[int, int]] = []
        self._has_all_needed = False
        self.accepted = 0
        self.rejected: Counter[str] = Counter()

    def update(self, now, names, positions, velocities=()):
        """
        Take one message.

        Parameters
        ----------
        now : float
            Arrival on a steady clock, s.
        names : list of str
        positions : sequence of float
            As many as names, rad or m.
        velocities : sequence of float
            As many as names or empty; NaN where unknown.

        Raises
        ------
        RejectedStateError
            If lengths differ, a name comes twice, or the position of a needed joint is not
            finite. That of another joint is passed over.

        """
        try:
            self._update(now, names, positions, velocities)
        except RejectedStateError as error:
            self.rejected[error.kind] += 1
            raise
        self.accepted += 1

    def _update(self, now, names, positions, velocities):
        if names != self._known_names:
            self._learn(names)
        if len(positions) != len(names):
            raise RejectedStateError('length', f'expected {len(names)} positions for '
                                     f'{len(names)} names, got {len(positions)}')
        if len(velocities) not in (0, len(names)):
            raise RejectedStateError('length', f'expected {len(names)} velocities or none, '
                                     f'got {len(velocities)}')
        pairs, is_complete = self._pairs, self._has_all_needed
        if not all(map(math.isfinite, positions)):
            pairs, is_complete = self._finite_pairs(positions), False
        position, velocity, time = self._position, self._velocity, self._time
        has_velocities = len(velocities) > 0
        for source, target in pairs:
            position[target] = positions[source]
            velocity[target] = velocities[source] if has_velocities else math.nan
            time[target] = now
        self._oldest = now if is_complete else min(
            (self._time[i] for i in self._needed), default=-math.inf)

    def _finite_pairs(self, positions):
        wrong = {target for source, target in self._pairs
                 if not math.isfinite(positions[source])}
        missing = [self._names[i] for _, i in self._pairs if i in wrong and i in self._needed]
        if missing:
            raise RejectedStateError('not finite', 'expected finite positions, got NaN or '
                                     f'infinity for {", ".join(missing)}')
        return [(source, target) for source, target in self._pairs if target not in wrong]

    def _learn(self, names):
        # The mapping by name; kept until a message names other joints or another order.
        if len(names) > MAX_NAMES:
            raise RejectedStateError('too many names', f'expected at most {MAX_NAMES} names, '
                                     f'got {len(names)}')
        if len(set(names)) != len(names):
            twice = sorted(name for name, count in Counter(names).items() if count > 1)
            # Anybody may have written them: short, and without what a terminal would obey.
            raise RejectedStateError('name twice', 'expected each joint once, got twice: '
                                     + ', '.join(repr(name[:40]) for name in twice[:5]))
        self._pairs = [(i, self._index[name]) for i, name in enumerate(names)
                       if name in self._index]
        self._has_all_needed = bool(self._needed) and set(self._needed) <= {
            target for _, target in self._pairs}
        self._known_names = list(names)

    @property
    def position(self):
        """Newest positions, or neutral ones where never measured; shape (n,), a copy."""
        return np.array(self._position, dtype=float)

    @property
    def velocity(self):
        """Newest velocities, NaN where unknown; shape (n,), a copy."""
        return np.array(self._velocity, dtype=float)

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
        return now - self._oldest

    def stale_joints(self, now, timeout):
        """
        Return which needed joints are missing.

        Parameters
        ----------
        now : float
            The same steady clock, s.
        timeout : float
            Age that is still fresh, s.

        Returns
        -------
        list of str

        """
        return [self._names[i] for i in self._needed if now - self._time[i] > timeout]
