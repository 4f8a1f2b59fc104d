"""The measured quantities, and the `Call` by which a library computes one."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

# Name in the code → title in the report.
QUANTITIES = {
    'dynamics': 'D, C and G',
    'mass_matrix': 'D',
    'gravity': 'G',
    'inverse': 'inverse dynamics, q̈ → τ',
    'forward': 'forward dynamics, τ → q̈',
}
# The vectors of a state that the calls take: q, q̇ and the third one, q̈ or τ.
ARGUMENTS = {'dynamics': 2, 'mass_matrix': 1, 'gravity': 1, 'inverse': 3, 'forward': 3}


def identity(value):
    """Return the value itself."""
    return value


@dataclass(frozen=True)
class Call:
    """
    Computes one quantity with one library.

    Attributes
    ----------
    run : callable
        Takes the first `ARGUMENTS` vectors of a state; returns a tuple, one item per part, or
        the array if there is one part.
    parts : tuple of str
        Returned parts: 'D', 'C', 'G', 'C qd', 'C qd + G', 'tau' or 'qdd'.
    how : str
        Called functions of the library, for the report.
    argument : callable
        Converts a numpy array to the library's vector type, before the timing.
    array : callable
        Converts a part of the result to a numpy array; for the check only.

    """

    run: Callable[..., Any]
    parts: tuple[str, ...]
    how: str
    argument: Callable[[np.ndarray], Any] = field(default=identity)
    array: Callable[[Any], np.ndarray] = field(default=np.asarray)

    def arguments(self, quantity, states):
        """
        Return the arguments of calls for some states.

        Parameters
        ----------
        quantity : str
            A key of QUANTITIES.
        states : list of tuple of numpy.ndarray
            As `Robot.states`.

        Returns
        -------
        list of tuple

        """
        return [
            tuple(self.argument(value) for value in state[: ARGUMENTS[quantity]])
            for state in states
        ]
