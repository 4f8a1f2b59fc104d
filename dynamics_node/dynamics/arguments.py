"""Checks of arguments, with errors that name argument, expected and given value."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import ArgumentError, quoted, suggestion
from ..model.tree import LinkFrame

# Links that an error message lists.
_MAX_LISTED = 50


def check_link(links: Mapping[str, LinkFrame], link: str, field: str = 'link') -> None:
    """
    Require that a link is one of the robot's.

    Parameters
    ----------
    links : dict of str to LinkFrame
    link : str
    field : str
        Name of the caller's argument, for the error.

    Raises
    ------
    ArgumentError
        With a suggestion of a similar name, or a list of the robot's links.

    """
    if link not in links:
        available = ', '.join(list(links)[:_MAX_LISTED]) + (', ...' * (len(links) > _MAX_LISTED))
        raise ArgumentError(
            f'{field}: {quoted(link)} is not a link of the robot'
            + (suggestion(link, links) or f'; expected one of {available}')
        )


def gravity_vector(value: ArrayLike) -> NDArray[np.float64]:
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


def per_joint(name: str, joint_names: Sequence[str], value: ArrayLike) -> NDArray[np.float64]:
    """
    Check non-negative numbers, one per joint or one for all.

    Parameters
    ----------
    name : str
        Name of the quantity, for the error.
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
