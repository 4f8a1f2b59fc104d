"""A payload: one more rigid body on a link."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import check_link
from ..errors import ArgumentError
from ..inertia import check_physical, pseudo_inertia, transform_pseudo_inertia
from ..model.tree import KinematicTree, LinkFrame


@dataclass(frozen=True)
class Payload:
    """
    A rigid body attached to a link.

    Attributes
    ----------
    link : str
    mass : float
        kg, > 0.
    com : numpy.ndarray, shape (3,)
        Center of mass in the link's frame, m; read-only.
    inertia : numpy.ndarray, shape (3, 3)
        Inertia tensor about the center of mass, along the axes of the link's frame, kg m²;
        off-diagonal entries -∫xy dm as in URDF; read-only.

    """

    link: str
    mass: float
    com: NDArray[np.float64]
    inertia: NDArray[np.float64]

    @cached_property
    def pseudo_inertia(self) -> NDArray[np.float64]:
        """J of the payload in the link's frame, shape (4, 4): kg m², kg m, kg."""
        matrix: NDArray[np.float64] = pseudo_inertia(self.mass, self.com, self.inertia)
        return matrix


def make_payload(
    links: Mapping[str, LinkFrame],
    link: str,
    mass: float,
    com: ArrayLike,
    inertia: ArrayLike | None,
) -> Payload | None:
    """
    Check the numbers of a payload, and return it.

    Parameters
    ----------
    links : dict of str to LinkFrame
        Links of the robot.
    link : str
    mass : float
        kg; 0 for no payload, then the other arguments are ignored.
    com : array_like, shape (3,)
        m, in the link's frame.
    inertia : array_like, shape (3, 3), or None
        kg m², about the center of mass, along the link's axes; None for a point mass.

    Returns
    -------
    Payload or None

    Raises
    ------
    ArgumentError
        If the link is unknown, a shape is wrong or a number is not finite.
    InertiaError
        If this mass and inertia are physically impossible; lists every violated condition.

    References
    ----------
    docs/mathematics.md, equations (3) to (5).

    """
    try:
        mass = float(mass)
    except (TypeError, ValueError):
        raise ArgumentError(f'payload mass: expected a number, kg, got {mass!r}') from None
    if mass == 0.0:
        return None
    check_link(links, link)
    com = _finite('payload com', com, (3,), 'm')
    inertia = _finite(
        'payload inertia', np.zeros((3, 3)) if inertia is None else inertia, (3, 3), 'kg m^2'
    )
    if not np.isfinite(mass):
        raise ArgumentError(f'payload mass: expected a finite number, kg, got {mass}')
    payload = Payload(link, mass, com, inertia)
    with np.errstate(over='ignore', invalid='ignore'):  # reported by the error below
        matrix = payload.pseudo_inertia
    if not np.isfinite(matrix).all():
        raise ArgumentError(
            'payload: expected finite second moments, got those of mass '
            f'{mass:g}, com {com.tolist()} and an inertia tensor of up to '
            f'{np.abs(inertia).max():g}'
        )
    check_physical(matrix)
    return payload


def loaded_inertia(tree: KinematicTree, payload: Payload | None) -> NDArray[np.float64]:
    """
    Return the pseudo-inertia of every body, with the payload.

    Parameters
    ----------
    tree : KinematicTree
    payload : Payload or None

    Returns
    -------
    numpy.ndarray, shape (N, 4, 4)
        Without payload the tree's own array: the same numbers to the last bit.

    References
    ----------
    docs/mathematics.md, equation (5).

    """
    if payload is None or tree.links[payload.link].body < 0:
        return tree.inertia
    frame = tree.links[payload.link]
    inertia = tree.inertia.copy()
    inertia[frame.body] += transform_pseudo_inertia(payload.pseudo_inertia, frame.placement)
    return inertia


def _finite(name: str, value: ArrayLike, shape: tuple[int, ...], unit: str) -> NDArray[np.float64]:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != shape or not np.isfinite(array).all():
        raise ArgumentError(
            f'{name}: expected finite numbers of shape {shape}, {unit}, got {value!r}'
        )
    array.flags.writeable = False
    return array
