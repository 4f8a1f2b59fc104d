"""The checked robot description: frozen plain data, in SI units and URDF frames."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..inertia import pseudo_inertia, transform_pseudo_inertia


@dataclass(frozen=True)
class Inertial:
    """
    Inertial parameters of one link.

    Attributes
    ----------
    mass : float
        kg, >= 0.
    placement : numpy.ndarray, shape (4, 4)
        Inertial frame → link frame; its origin is the center of mass, m.
    tensor : numpy.ndarray, shape (3, 3)
        Inertia about the center of mass, in the inertial frame, kg m².

    """

    mass: float
    placement: NDArray[np.float64]
    tensor: NDArray[np.float64]

    @cached_property
    def pseudo_inertia(self) -> NDArray[np.float64]:
        """
        J about the link frame's origin, shape (4, 4): kg m², kg m, kg; read-only.

        References
        ----------
        docs/mathematics.md, equations (2) to (5).

        """
        matrix = transform_pseudo_inertia(
            pseudo_inertia(self.mass, np.zeros(3), self.tensor), self.placement
        )
        matrix.flags.writeable = False
        return matrix


@dataclass(frozen=True)
class Link:
    """
    One link.

    Attributes
    ----------
    name : str
    inertial : Inertial or None
        None where the URDF has none.
    has_shape : bool
        Whether the URDF has a <visual> or a <collision> for it: a visible link has a mass.
        The shape itself is not read.
    has_visual : bool
        Whether the URDF has a <visual> for it.

    """

    name: str
    inertial: Inertial | None = None
    has_shape: bool = False
    has_visual: bool = False


@dataclass(frozen=True)
class Stated:
    """
    The attributes of a joint as written in the URDF, before defaults replace unusable ones.

    Attributes
    ----------
    lower, upper : float
        Position limits of <limit>, rad or m; NaN where they are missing.
    effort : float
        N m or N; NaN where it is missing.
    velocity : float
        rad/s or m/s; NaN where it is missing.
    has_axis : bool
        Whether the URDF has an <axis>.

    """

    lower: float = np.nan
    upper: float = np.nan
    effort: float = np.nan
    velocity: float = np.nan
    has_axis: bool = True


@dataclass(frozen=True)
class Mimic:
    """
    A joint that follows another: position = multiplier * leader's position + offset.

    Attributes
    ----------
    leader : str
        Name of the other joint, which may mimic a third one.
    multiplier : float
        Follower per leader: 1, or m/rad and rad/m between a hinge and a slider.
    offset : float
        rad or m, of the follower.

    """

    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Joint:
    """
    One joint.

    Attributes
    ----------
    name : str
    parent, child : str
        Names of the links that it connects.
    kind : str
        'revolute', 'continuous', 'prismatic' or 'fixed'.
    placement : numpy.ndarray, shape (4, 4)
        Joint frame at position 0 → parent link frame, m.
    axis : numpy.ndarray, shape (3,)
        Unit vector in the joint frame.
    lower, upper : float
        Position limits, rad or m; -inf and inf where there are none.
    effort : float
        Limit, N m or N; NaN where the URDF states none.
    velocity : float
        Limit, rad/s or m/s; NaN where the URDF states none.
    damping : float
        Viscous friction, N m s/rad or N s/m; 0 where the URDF states none.
    friction : float
        Coulomb friction, N m or N; 0 where the URDF states none.
    mimic : Mimic or None
    stated : Stated
        For reports about the URDF; dynamics does not depend on it.

    """

    name: str
    kind: str
    parent: str
    child: str
    placement: NDArray[np.float64]
    axis: NDArray[np.float64]
    lower: float = -np.inf
    upper: float = np.inf
    effort: float = np.nan
    velocity: float = np.nan
    damping: float = 0.0
    friction: float = 0.0
    mimic: Mimic | None = None
    stated: Stated = Stated()

    @property
    def is_movable(self) -> bool:
        """True unless the joint is fixed."""
        return self.kind != 'fixed'


@dataclass(frozen=True)
class RobotDescription:
    """
    A whole robot: one tree of links.

    Attributes
    ----------
    name : str
    root : str
        Name of the link that is no joint's child.
    links : tuple of Link
    joints : tuple of Joint
        In the order of the URDF.
    warnings : tuple of str
        Accepted but suspicious values, one sentence each.
    hardware_plugins : tuple of str
        Drivers of the arm, from `<ros2_control><hardware><plugin>`.

    """

    name: str
    root: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    warnings: tuple[str, ...] = ()
    hardware_plugins: tuple[str, ...] = ()
