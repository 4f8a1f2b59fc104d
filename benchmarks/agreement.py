"""The check before timing: a library computes the same numbers as this one."""

import numpy as np

# Relative to the largest element of D, C, G, ...; measured differences are about 1e-15.
TOLERANCE = 1e-8
CHECKED_STATES = 4


class DifferentResultError(Exception):
    """A library returns other numbers than this one; its times would be meaningless."""


def expected_parts(robot, quantity, state):
    """
    Return the expected parts of a call's result, by this library.

    Parameters
    ----------
    robot : Robot
    quantity : str
        A key of QUANTITIES.
    state : tuple of numpy.ndarray
        q, q̇ and q̈ or τ, shape (n,) each.

    Returns
    -------
    dict of str to numpy.ndarray

    """
    q, qd, third = state
    D, C, G = robot.model.dynamics(q, qd)
    if quantity == 'inverse':
        return {'tau': D @ third + C @ qd + G}
    if quantity == 'forward':
        return {'qdd': np.linalg.solve(D, third - C @ qd - G)}
    return {'D': D, 'C': C, 'G': G, 'C qd': C @ qd, 'C qd + G': C @ qd + G}


def check(robot, quantity, call):
    """
    Compare a call's results with those of this library.

    Parameters
    ----------
    robot : Robot
    quantity : str
        A key of QUANTITIES.
    call : Call

    Returns
    -------
    float
        The largest difference, relative to the largest element.

    Raises
    ------
    DifferentResultError
        If a difference is above TOLERANCE, or not a number.

    """
    worst = 0.0
    states = robot.states[:CHECKED_STATES]
    for state, arguments in zip(states, call.arguments(quantity, states), strict=True):
        expected = expected_parts(robot, quantity, state)
        result = call.run(*arguments)
        parts = result if isinstance(result, tuple) else (result,)
        for part, value in zip(call.parts, parts, strict=True):
            array = call.array(value)
            if array.shape != expected[part].shape:
                raise DifferentResultError(
                    f'{part}: expected shape {expected[part].shape}, got {array.shape}'
                )
            error = np.abs(array - expected[part]).max() / np.abs(expected[part]).max()
            if not error <= TOLERANCE:
                raise DifferentResultError(
                    f'{part}: expected a difference of at most {TOLERANCE:g} of the largest '
                    f'element, got {error:.2g}'
                )
            worst = max(worst, float(error))
    return worst
