"""The checked robot description: frozen plain data, in SI units and URDF frames."""

from dataclasses import dataclass

import numpy as np


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
    placement: np.ndarray
    tensor: np.ndarray


@dataclass(frozen=True)
class Link:
    """
    One link.

    Attributes
    ----------
    name : str
    inertial : Inertial or None
        None where the URDF has none.
    has_shape, has_visual : bool
        Whether the URDF gives it a <visual> or a <collision>, and whether a <visual>: what can
        be seen has a mass. The shape itself is never looked at.

    """

    name: str
    inertial: Inertial | None = None
    has_shape: bool = False
    has_visual: bool = False


@dataclass(frozen=True)
class Stated:
    """
    What the URDF says about a joint, before anything is put in the place of nonsense.

    Attributes
    ----------
    lower, upper, effort, velocity : float
        The attributes of <limit>; NaN where they are missing.
    has_axis : bool

    """

    lower: float = np.nan
    upper: float = np.nan
    effort: float = np.nan
    velocity: float = np.nan
    has_axis: bool = True


@dataclass(frozen=True)
class Mimic:
    """A joint that follows another: position = multiplier * leader + offset."""

    leader: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class Joint:
    """
    One joint.

    Attributes
    ----------
    name, parent, child : str
        Of the joint and of the links that it connects.
    kind : str
        'revolute', 'continuous', 'prismatic' or 'fixed'.
    placement : numpy.ndarray, shape (4, 4)
        Joint frame at position 0 → parent link frame, m.
    axis : numpy.ndarray, shape (3,)
        Unit vector in the joint frame.
    lower, upper : float
        Position limits, rad or m; -inf and inf where there are none.
    effort, velocity : float
        Limits, N m or N, rad/s or m/s; NaN where the URDF states none.
    damping, friction : float
        Viscous (N m s/rad, N s/m) and Coulomb (N m, N); 0 where the URDF states none.
    mimic : Mimic or None
    stated : Stated
        For people who look for mistakes; dynamics does not depend on it.

    """

    name: str
    kind: str
    parent: str
    child: str
    placement: np.ndarray
    axis: np.ndarray
    lower: float = -np.inf
    upper: float = np.inf
    effort: float = np.nan
    velocity: float = np.nan
    damping: float = 0.0
    friction: float = 0.0
    mimic: Mimic | None = None
    stated: Stated = Stated()

    @property
    def is_movable(self):
        """True unless the joint is fixed."""
        return self.kind != 'fixed'


@dataclass(frozen=True)
class RobotDescription:
    """
    A whole robot: one tree of links.

    Attributes
    ----------
    name, root : str
        Of the robot, and of the link that no joint moves.
    links : tuple of Link
    joints : tuple of Joint
        In the order of the URDF.
    warnings : tuple of str
        What was accepted but looks wrong, one sentence each.
    hardware_plugins : tuple of str
        `<ros2_control><hardware><plugin>`: which drivers the arm has.

    """

    name: str
    root: str
    links: tuple
    joints: tuple
    warnings: tuple = ()
    hardware_plugins: tuple = ()
