"""The whole report as plain data: what is shown in a terminal, as JSON and as a page."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..dynamics import RobotModel

# From worst to harmless. Problems and warnings fail `--strict`, notes do not.
SEVERITIES = ('problem', 'warning', 'note')


@dataclass(frozen=True)
class LinkEntry:
    """
    One link of the URDF, as it stands there.

    Attributes
    ----------
    name : str
    has_inertial, has_shape : bool
        Whether the URDF gives it an <inertial>, and a <visual> or a <collision>.
    mass : float
        kg; 0 without <inertial>, NaN where its numbers cannot be read.
    com : tuple of 3 floats or None
        Center of mass in the link's frame, m; None without mass.
    principal_moments : tuple of 3 floats or None
        About the center of mass, kg m², ascending; None without <inertial>.
    violations : tuple of str
        Why no real body has this mass and inertia.
    carrier : str or None
        The joint whose body it belongs to, a movable one; None: it stands on the base, or the
        tree could not be read.

    """

    name: str
    has_inertial: bool
    has_shape: bool
    mass: float
    com: tuple | None
    principal_moments: tuple | None
    violations: tuple
    carrier: str | None

    @property
    def is_physical(self):
        """Whether a real body has this mass and inertia."""
        return not self.violations


@dataclass(frozen=True)
class BodyEntry:
    """
    What one joint moves as one piece: its child link and all that fixed joints attach to it.

    Attributes
    ----------
    joint, link : str
        The movable joint, and its child link, whose frame is the body's.
    parent : str or None
        The joint of the body that carries it; None: the base.
    lumped : tuple of str
        Links that fixed joints attach, with and without mass.
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
    lumped: tuple
    mass: float
    com: tuple | None
    principal_moments: tuple
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
        Where it is, in the order of `Report.joint_names`, rad or m.
    share : float
        Its magnitude over the effort limit; NaN without limit.
    payload_left : float
        Point mass, kg, that may be added at `Report.payload`'s point there until this joint is
        at its limit; 0 if it is over it, infinite where the mass does not turn it, NaN without
        limit.
    sampled : float
        The largest magnitude among the samples alone, before it was climbed to the top.
    levels, quantiles : tuple of floats
        Of the magnitude over the samples; levels from 0 to 1.
    edges, counts : tuple of numbers
        Histogram of the magnitude over the samples; one more edge than counts.
    curve_positions, curve_torques : tuple of floats
        G of this joint over its own position, all other joints as at `position`.

    """

    worst: float
    position: tuple
    share: float
    payload_left: float
    sampled: float
    levels: tuple
    quantiles: tuple
    edges: tuple
    counts: tuple
    curve_positions: tuple
    curve_torques: tuple

    @property
    def magnitude(self):
        """The largest gravity torque without its sign, N m or N."""
        return abs(self.worst)


@dataclass(frozen=True)
class JointEntry:
    """
    One movable joint.

    Attributes
    ----------
    name, parent, child : str
        Of the joint, and the links that it connects.
    kind : str
        'revolute', 'continuous' or 'prismatic'.
    mimics : str or None
        The joint that it follows in the end, with `multiplier` and `offset`.
    multiplier, offset : float
        1 and 0 unless it mimics.
    lower, upper : float
        rad or m, infinite without limit.
    velocity, effort : float
        rad/s or m/s, N m or N; NaN without limit.
    damping, friction : float
        N m s/rad or N s/m, N m or N.
    range_note : str
        How positions were drawn where the limits do not say it; '' where they do.
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
    def unit(self):
        """Unit of positions."""
        return 'm' if self.kind == 'prismatic' else 'rad'

    @property
    def effort_unit(self):
        """Unit of efforts."""
        return 'N' if self.kind == 'prismatic' else 'N m'


@dataclass(frozen=True)
class PayloadEntry:
    """
    What the effort limits leave for a point mass.

    Attributes
    ----------
    link : str
    point : tuple of 3 floats
        In the link's frame, m.
    is_moved : bool
        Whether any joint moves the link; if not, a payload has no effect.
    everywhere : float
        kg that can be held at every position; 0 if some joint is over its limit already,
        infinite if none has a limit in the way.
    limiting_joint : str or None
    limiting_position : tuple of n floats or None
        Where that joint is at its limit with `everywhere`.
    best : float
        kg that can be held at the best of the sampled positions.
    best_position : tuple of n floats
    best_joint : str or None
        The limiting joint there.
    unlimited_joints : tuple of str
        Joints that carry the point and have no effort limit: they were not counted.
    is_guessed : bool
        Whether the link that carries it was guessed, see `RobotModel.tip_link`.

    """

    link: str
    point: tuple
    is_moved: bool
    everywhere: float
    limiting_joint: str | None
    limiting_position: tuple | None
    best: float
    best_position: tuple
    best_joint: str | None
    unlimited_joints: tuple
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
        Of the worst.
    weakest_joint : str
        The joint with the largest part in the eigenvector of the smallest eigenvalue there.
    is_positive_definite : bool
        Beyond rounding, at every sample.
    has_mixed_units : bool
        Whether some joints slide and some turn: then the number depends on the units, m and rad.
    samples : int
        How many positions it was computed at.

    """

    median: float
    worst: float
    position: tuple
    weakest_joint: str
    is_positive_definite: bool
    has_mixed_units: bool
    samples: int


@dataclass(frozen=True)
class Finding:
    """
    Something that its reader should know, or mend.

    Attributes
    ----------
    severity : str
        One of SEVERITIES.
    kind : str
        Stable identifier, see `kinds.KINDS`.
    subjects : tuple of str
        Names of links or joints; empty for the robot.
    what : str
        A sentence with the numbers.
    effect : str
        What it does to which torque, computed for this robot; '' if nothing.
    advice : str
        What to change or type.

    """

    severity: str
    kind: str
    subjects: tuple
    what: str
    effect: str
    advice: str


@dataclass(frozen=True)
class Report:
    """
    Everything about one robot.

    Attributes
    ----------
    robot, source : str
        Its name, and the path it was read from ('URDF text' for a text).
    root : str
        Root link; '' if there is no tree.
    gravity : tuple of 3 floats
        m/s², in the root link's frame.
    verdict : str
        'usable' or 'refused'.
    refusals : tuple of str
        Why it is refused.
    total_mass, moving_mass : float
        kg; of all links whose mass could be read, and of those that joints move.
    samples, seed : int
    joint_names : tuple of str
        The n independent joints in the order of every position in here.
    links, bodies, joints, findings : tuple
        `LinkEntry`, `BodyEntry`, `JointEntry`; `Finding`, the worst first.
    payload : PayloadEntry or None
    conditioning : ConditioningEntry or None
        Both None for a refused robot and one without movable joints.
    model : RobotModel or None
        For those who want to compute more; not part of the JSON.

    """

    robot: str
    source: str
    root: str
    gravity: tuple
    verdict: str
    refusals: tuple
    total_mass: float
    moving_mass: float
    samples: int
    seed: int
    joint_names: tuple
    links: tuple
    bodies: tuple
    joints: tuple
    findings: tuple
    payload: PayloadEntry | None = None
    conditioning: ConditioningEntry | None = None
    model: RobotModel | None = field(default=None, repr=False, compare=False)

    @property
    def counts(self):
        """How many findings there are of each severity, dict of str to int."""
        return {
            severity: sum(finding.severity == severity for finding in self.findings)
            for severity in SEVERITIES
        }

    @property
    def is_clean(self):
        """Whether there is neither a problem nor a warning: what `--strict` asks for."""
        return not (self.counts['problem'] or self.counts['warning'])
