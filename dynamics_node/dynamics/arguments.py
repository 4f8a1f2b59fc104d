"""What arguments must be, and what is said when they are not."""

import numpy as np

from ..errors import ArgumentError, quoted, suggestion

# Links that an error message lists.
_MOST_SHOWN = 50


def check_link(links, link, field='link'):
    """
    Demand that a link is one of the robot's.

    Parameters
    ----------
    links : dict of str to LinkFrame
    link : str
    field : str
        What the caller gave the name in.

    Raises
    ------
    ArgumentError
        With the link that was probably meant, or the links that there are.

    """
    if link not in links:
        shown = ', '.join(list(links)[:_MOST_SHOWN]) + (', ...' * (len(links) > _MOST_SHOWN))
        raise ArgumentError(
            f'{field}: {quoted(link)} is not a link of the robot'
            + (suggestion(link, links) or f'; expected one of {shown}')
        )


def gravity_vector(value):
    """
    Check a gravity acceleration.

    Parameters
    ----------
    value : array_like, shape (3,)
        m/s².

    Returns
    -------
    numpy.ndarray, shape (3,)
        Read-only.

    Raises
    ------
    ArgumentError
        If it is not three finite numbers.

    """
    try:
        vector = np.array(value, dtype=float)
    except (TypeError, ValueError):
        vector = np.empty(0)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise ArgumentError(f'gravity: expected three finite numbers, m/s^2, got {value!r}')
    vector.flags.writeable = False
    return vector


def per_joint(name, joint_names, value):
    """
    Check one number per joint, or one for all.

    Parameters
    ----------
    name : str
        What it is, for people.
    joint_names : tuple of str
        The n joints.
    value : array_like, shape (n,), or float

    Returns
    -------
    numpy.ndarray, shape (n,)
        Read-only.

    Raises
    ------
    ArgumentError
        If the length is wrong or a number is negative or not finite.

    """
    count = len(joint_names)
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.full(1, np.nan)
    if array.shape not in ((), (count,)):
        raise ArgumentError(
            f'{name}: expected one number, or {count} for '
            f'{", ".join(joint_names)}; got shape {array.shape}'
        )
    if not (np.isfinite(array) & (array >= 0.0)).all():
        raise ArgumentError(f'{name}: expected finite numbers >= 0, got {value!r}')
    array = np.broadcast_to(array, (count,)).copy()
    array.flags.writeable = False
    return array
