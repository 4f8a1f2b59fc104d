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
        self._needed = np.array([self._index[name] for name in needed], dtype=np.intp)
        self._position = np.array(neutral, dtype=float)
        self._velocity = np.full(len(names), math.nan)
        self._time = np.full(len(names), -math.inf)
        self._known_names = None
        self._source = self._target = np.empty(0, dtype=np.intp)
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
        source, target = self._source, self._target
        measured = np.asarray(positions, dtype=float)[source]
        is_finite = np.isfinite(measured)
        if not is_finite.all():
            wrong = [self._names[i] for i in target[~is_finite] if i in self._needed]
            if wrong:
                raise RejectedStateError('not finite', 'expected finite positions, got NaN or '
                                         f'infinity for {", ".join(wrong)}')
            source, target, measured = source[is_finite], target[is_finite], measured[is_finite]
        self._position[target] = measured
        self._time[target] = now
        self._velocity[target] = (np.asarray(velocities, dtype=float)[source]
                                  if len(velocities) else math.nan)

    def _learn(self, names):
        # The mapping by name; kept until a message names other joints or another order.
        if len(names) > MAX_NAMES:
            raise RejectedStateError('too many names', f'expected at most {MAX_NAMES} names, '
                                     f'got {len(names)}')
        if len(set(names)) != len(names):
            twice = sorted(name for name, count in Counter(names).items() if count > 1)
            raise RejectedStateError('name twice', 'expected each joint once, got twice: '
                                     + ', '.join(twice[:5]))
        pairs = [(i, self._index[name]) for i, name in enumerate(names) if name in self._index]
        self._source = np.array([i for i, _ in pairs], dtype=np.intp)
        self._target = np.array([i for _, i in pairs], dtype=np.intp)
        self._known_names = list(names)

    @property
    def position(self):
        """Newest positions, or neutral ones where never measured; shape (n,), a copy."""
        return self._position.copy()

    @property
    def velocity(self):
        """Newest velocities, NaN where unknown; shape (n,), a copy."""
        return self._velocity.copy()

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
        if self._needed.size == 0:
            return math.inf
        return now - float(self._time[self._needed].min())

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
