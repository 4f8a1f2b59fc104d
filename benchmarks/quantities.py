"""What is measured, and what a library has to hand over for it."""

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


def same(value):
    """Return the value itself."""
    return value


@dataclass(frozen=True)
class Call:
    """
    How one library computes one quantity.

    Attributes
    ----------
    run : callable
        Takes the first `ARGUMENTS` vectors of a state; returns a tuple, one item per part, or
        the array if there is one part.
    parts : tuple of str
        What it returns: 'D', 'C', 'G', 'C qd', 'C qd + G', 'tau' or 'qdd'.
    how : str
        The library's functions that it calls, for the report.
    argument : callable
        Makes the library's kind of vector of a numpy array, before the clock starts.
    array : callable
        Makes a numpy array of a part of the result; for the check only.

    """

    run: Callable[..., Any]
    parts: tuple[str, ...]
    how: str
    argument: Callable[[np.ndarray], Any] = field(default=same)
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
