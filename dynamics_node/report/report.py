"""The report as plain data, for the terminal, JSON and the page."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..dynamics import RobotModel

Vector = tuple[float, ...]

# In descending order. Problems and warnings fail `--strict`, notes do not.
SEVERITIES = ('problem', 'warning', 'note')


@dataclass(frozen=True)
class LinkEntry:
    """
    One link as written in the URDF.

    Attributes
    ----------
    name : str
    has_inertial, has_shape : bool
        Whether it has an <inertial>, and a <visual> or a <collision>.
    mass : float
        kg; 0 without <inertial>, NaN if its numbers cannot be read.
    com : tuple of 3 floats or None
        Center of mass in the link's frame, m; None without mass.
    principal_moments : tuple of 3 floats or None
        About the center of mass, kg m², ascending; None without <inertial>.
    violations : tuple of str
        Reasons why mass and inertia are physically impossible.
    carrier : str or None
        The movable joint whose body it belongs to; None if it stands on the base, or if the tree
        cannot be read.

    """

    name: str
    has_inertial: bool
    has_shape: bool
    mass: float
    com: Vector | None
    principal_moments: Vector | None
    violations: tuple[str, ...]
    carrier: str | None

    @property
    def is_physical(self) -> bool:
        """Whether mass and inertia are physically possible."""
        return not self.violations


@dataclass(frozen=True)
class BodyEntry:
    """
    The rigid body that one joint moves: its child link and the links fixed to it.

    Attributes
    ----------
    joint, link : str
        The movable joint, and its child link, whose frame is the body's.
    parent : str or None
        The joint of the body that carries it; None for the base.
    lumped : tuple of str
        Links attached by fixed joints, with and without mass.
    mass : float
        kg.
    com : tuple of 3 floats or None
        In the body's frame, m; None without mass.
    principal_moments : tuple of 3 floats
        About the center of mass, kg m², ascending.
    is_physical : bool

    """

    joint: str
    link: str
    parent: str | None
    lumped: tuple[str, ...]
    mass: float
    com: Vector | None
    principal_moments: Vector
    is_physical: bool


@dataclass(frozen=True)
class GravityLoad:
    """
    The gravity torque of one joint over all positions, N m or N (`JointEntry.effort_unit`).

    Attributes
    ----------
    worst : float
        The largest in magnitude, with its sign.
    position : tuple of n floats
        Its position, in the order of `Report.joint_names`, rad or m.
    share : float
        Its magnitude over the effort limit; NaN without limit.
    payload_left : float
        Point mass at the point of `Report.payload` that brings this joint to its limit there,
        kg; 0 above the limit, infinite if the mass does not load the joint, NaN without limit.
    sampled : float
        The largest magnitude among the samples alone, before the search.
    levels, quantiles : tuple of floats
        Quantiles of the magnitude over the samples; levels from 0 to 1.
    edges, counts : tuple of numbers
        Histogram of the magnitude over the samples; one more edge than counts.
    curve_positions, curve_torques : tuple of floats
        Gravity torque over the joint's own position, all other joints as in `position`.

    """

    worst: float
    position: Vector
    share: float
    payload_left: float
    sampled: float
    levels: Vector
    quantiles: Vector
    edges: Vector
    counts: tuple[int, ...]
    curve_positions: Vector
    curve_torques: Vector

    @property
    def magnitude(self) -> float:
        """The largest gravity torque without its sign, N m or N."""
        return abs(self.worst)

    def quantile(self, level: float) -> float:
        """Return the quantile of the magnitude at one of the `levels`, N m or N."""
        return self.quantiles[self.levels.index(level)]


@dataclass(frozen=True)
class JointEntry:
    """
    One movable joint.

    Attributes
    ----------
    name, parent, child : str
        Names of the joint and of the links that it connects.
    kind : str
        'revolute', 'continuous' or 'prismatic'.
    mimics : str or None
        The independent joint that it follows, with `multiplier` and `offset`.
    multiplier, offset : float
        1 and 0 unless it mimics.
    lower, upper : float
        rad or m, infinite without limit.
    velocity, effort : float
        rad/s or m/s, N m or N; NaN without limit.
    damping, friction : float
        N m s/rad or N s/m, N m or N.
    range_note : str
        The sampled range if limits are missing; '' otherwise.
    gravity : GravityLoad or None
        None for joints that mimic another, and for a refused robot.

    """

    name: str
    parent: str
    child: str
    kind: str
    mimics: str | None
    multiplier: float
    offset: float
    lower: float
    upper: float
    velocity: float
    effort: float
    damping: float
    friction: float
    range_note: str = ''
    gravity: GravityLoad | None = None

    @property
    def unit(self) -> str:
        """Unit of positions."""
        return 'm' if self.kind == 'prismatic' else 'rad'

    @property
    def effort_unit(self) -> str:
        """Unit of efforts."""
        return 'N' if self.kind == 'prismatic' else 'N m'


@dataclass(frozen=True)
class PayloadEntry:
    """
    The point mass that the effort limits allow at rest.

    Attributes
    ----------
    link : str
    point : tuple of 3 floats
        In the link's frame, m.
    is_moved : bool
        Whether any joint moves the link; if not, a payload has no effect.
    everywhere : float
        Mass that is held at every position, kg; 0 if a joint is above its limit without it,
        infinite if no effort limit restricts it.
    limiting_joint : str or None
    limiting_position : tuple of n floats or None
        Position at which that joint reaches its limit with `everywhere`, rad or m.
    best : float
        Mass that is held at the best of the sampled positions, kg.
    best_position : tuple of n floats
    best_joint : str or None
        The limiting joint there.
    unlimited_joints : tuple of str
        Joints that carry the point without an effort limit; they are ignored.
    is_guessed : bool
        Whether the link is the default, see `RobotModel.tip_link`.

    """

    link: str
    point: Vector
    is_moved: bool
    everywhere: float
    limiting_joint: str | None
    limiting_position: Vector | None
    best: float
    best_position: Vector
    best_joint: str | None
    unlimited_joints: tuple[str, ...]
    is_guessed: bool = False


@dataclass(frozen=True)
class ConditioningEntry:
    """
    The condition number of D: its largest over its smallest eigenvalue.

    Attributes
    ----------
    median, worst : float
        Over the samples; infinite where D is not positive definite.
    position : tuple of n floats
        Position of the worst, rad or m.
    weakest_joint : str
        The joint with the largest entry in the eigenvector of the smallest eigenvalue there.
    is_positive_definite : bool
        At every sample, beyond rounding errors.
    has_mixed_units : bool
        Whether there are prismatic and rotating joints: the number then depends on the units.
    samples : int
        Number of positions at which it was computed.

    """

    median: float
    worst: float
    position: Vector
    weakest_joint: str
    is_positive_definite: bool
    has_mixed_units: bool
    samples: int


@dataclass(frozen=True)
class Finding:
    """
    One problem, warning or note about the robot.

    Attributes
    ----------
    severity : str
        One of SEVERITIES.
    kind : str
        Stable identifier, see `kinds.KINDS`.
    subjects : tuple of str
        Names of links or joints; empty for the whole robot.
    what : str
        A sentence with the numbers.
    effect : str
        The effect on torques or inertia, computed for this robot; '' if there is none.
    advice : str
        What to change.

    """

    severity: str
    kind: str
    subjects: tuple[str, ...]
    what: str
    effect: str
    advice: str


@dataclass(frozen=True)
class Report:
    """
    The report of one robot.

    Attributes
    ----------
    robot, source : str
        Its name, and the path of the URDF ('URDF text' for a text).
    root : str
        Root link; '' if there is no tree.
    gravity : tuple of 3 floats
        m/s², in the root link's frame.
    verdict : str
        'usable' or 'refused'.
    refusals : tuple of str
        Reasons why `RobotModel` refuses it.
    total_mass, moving_mass : float
        Of all links with a readable mass, and of those that joints move, kg.
    samples, seed : int
    joint_names : tuple of str
        The n independent joints, in the order of all positions of the report.
    links, bodies, joints, findings : tuple
        `LinkEntry`, `BodyEntry`, `JointEntry`, and `Finding` in descending severity.
    payload : PayloadEntry or None
    conditioning : ConditioningEntry or None
        Both None for a refused robot and one without movable joints.
    model : RobotModel or None
        For further computations; not part of the JSON.

    """

    robot: str
    source: str
    root: str
    gravity: Vector
    verdict: str
    refusals: tuple[str, ...]
    total_mass: float
    moving_mass: float
    samples: int
    seed: int
    joint_names: tuple[str, ...]
    links: tuple[LinkEntry, ...]
    bodies: tuple[BodyEntry, ...]
    joints: tuple[JointEntry, ...]
    findings: tuple[Finding, ...]
    payload: PayloadEntry | None = None
    conditioning: ConditioningEntry | None = None
    model: RobotModel | None = field(default=None, repr=False, compare=False)

    @property
    def counts(self) -> dict[str, int]:
        """Number of findings of each severity."""
        return {
            severity: sum(finding.severity == severity for finding in self.findings)
            for severity in SEVERITIES
        }

    @property
    def is_clean(self) -> bool:
        """Whether there are neither problems nor warnings, as `--strict` requires."""
        return not (self.counts['problem'] or self.counts['warning'])
