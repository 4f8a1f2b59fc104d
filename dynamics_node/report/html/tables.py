"""The tables of the page as data: joints, links and bodies; templates/macros.html renders them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
import math

from .plots import tone
from ..formatting import MISSING, number, percent, position, vector
from ..report import BodyEntry, JointEntry, LinkEntry, Report

# Class of the style sheet by the tone of a share.
_SHARE_CLASSES = {'problem': 'bad', 'warning': 'doubt', 'accent': '', 'faint': 'missing'}


@dataclass(frozen=True)
class Column:
    """
    One column.

    Attributes
    ----------
    title : str
    unit : str
        Below the title; '' for none.
    is_number : bool
        Numbers are aligned to the right.

    """

    title: str
    unit: str = ''
    is_number: bool = False


@dataclass(frozen=True)
class Cell:
    """
    One cell; its content is `text`, or `names`, or `pose`.

    Attributes
    ----------
    text : str
    value : float or None
        Sort key; None to sort by the text, NaN for a missing number.
    tone : str
        Class of the style sheet: 'bad', 'doubt', 'fine', 'missing' or ''.
    names : tuple of str
        Names from the URDF.
    pose : tuple of (str, str)
        Joints and their positions.
    meter : float or None
        Width of a bar before the text, percent.

    """

    text: str = ''
    value: float | None = None
    tone: str = ''
    names: tuple[str, ...] = ()
    pose: tuple[tuple[str, str], ...] = ()
    meter: float | None = None

    @property
    def sort_key(self) -> str | None:
        """The value as JavaScript reads it; '' for a missing number, None without value."""
        if self.value is None:
            return None
        return '' if math.isnan(self.value) else repr(self.value).replace('inf', 'Infinity')


@dataclass(frozen=True)
class Table:
    """
    One table.

    Attributes
    ----------
    label : str
        For screen readers.
    columns : tuple of Column
    rows : tuple of tuple of Cell
        The first cell of each row is its heading.

    Raises
    ------
    ValueError
        If a row does not have one cell per column.

    """

    label: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(
                    f'{self.label}: expected {len(self.columns)} cells in a row, got {len(row)}'
                )


def name(value: str) -> Cell:
    """Return a cell with a name from the URDF."""
    return Cell(names=(value,))


def amount(value: float | None, digits: int = 4, tone: str = '') -> Cell:
    """Return a cell with a number; '–' for None and NaN."""
    value = math.nan if value is None else float(value)
    tone = tone or ('missing' if math.isnan(value) else '')
    return Cell(number(value, digits), value, tone)


def joints_table(joints: Iterable[JointEntry], names: Sequence[str]) -> Table:
    """
    Return the table of all movable joints.

    Parameters
    ----------
    joints : iterable of JointEntry
    names : sequence of str
        The independent joints, in the order of every position.

    Returns
    -------
    Table

    """
    joints = tuple(joints)
    unit = ' or '.join(sorted({joint.effort_unit for joint in joints}, reverse=True))
    columns = (
        Column('joint'),
        Column('kind'),
        Column('range'),
        Column('worst gravity torque', unit, True),
        Column('effort limit', unit, True),
        Column('share of the limit', '', True),
        Column('payload left there', 'kg', True),
        Column('velocity limit', 'per s', True),
        Column('friction', 'dry, viscous', True),
        Column('worst at'),
    )
    is_prismatic = {joint.name: joint.kind == 'prismatic' for joint in joints}
    return Table('joints', columns, tuple(_joint(joint, names, is_prismatic) for joint in joints))


def links_table(links: Iterable[LinkEntry]) -> Table:
    """
    Return the table of all links, as written in the URDF.

    Parameters
    ----------
    links : iterable of LinkEntry

    Returns
    -------
    Table

    """
    columns = (
        Column('link'),
        Column('mass', 'kg', True),
        Column('center of mass', 'm', True),
        Column('principal moments', 'kg m²', True),
        Column('physically possible'),
        Column('moved by'),
    )
    return Table('links', columns, tuple(_link(link) for link in links))


def bodies_table(bodies: Iterable[BodyEntry]) -> Table:
    """
    Return the table of the rigid bodies that the joints move.

    Parameters
    ----------
    bodies : iterable of BodyEntry

    Returns
    -------
    Table

    """
    columns = (
        Column('joint'),
        Column('link it moves'),
        Column('fixed to it'),
        Column('mass', 'kg', True),
        Column('center of mass', 'm', True),
        Column('principal moments', 'kg m²', True),
        Column('physically possible'),
    )
    return Table('bodies', columns, tuple(_body(body) for body in bodies))


def pose(report: Report, values: Sequence[float]) -> tuple[tuple[str, str], ...]:
    """
    Return a position of all joints as pairs of joint and text.

    Parameters
    ----------
    report : Report
    values : sequence of n floats
        In the order of `report.joint_names`, rad or m.

    Returns
    -------
    tuple of (str, str)

    """
    is_prismatic = {joint.name: joint.kind == 'prismatic' for joint in report.joints}
    return _pose(report.joint_names, values, is_prismatic)


def _pose(
    names: Sequence[str], values: Sequence[float], is_prismatic: dict[str, bool]
) -> tuple[tuple[str, str], ...]:
    return tuple(
        (joint, position(value, is_prismatic[joint]))
        for joint, value in zip(names, values, strict=True)
    )


def _joint(
    joint: JointEntry, names: Sequence[str], is_prismatic: dict[str, bool]
) -> tuple[Cell, ...]:
    load = joint.gravity
    missing = Cell(MISSING, math.nan, 'missing')
    worst, share, left, where = missing, missing, missing, Cell(MISSING, tone='missing')
    if load is not None:
        worst = Cell(number(load.worst), load.magnitude)
        share = _share(load.share)
        left = amount(load.payload_left, 3, tone='bad' if load.payload_left == 0.0 else '')
        where = Cell(pose=_pose(names, load.position, is_prismatic))
    velocity = amount(joint.velocity)
    if math.isfinite(joint.velocity):
        velocity = Cell(position(joint.velocity, is_prismatic[joint.name]), joint.velocity)
    return (
        name(joint.name),
        Cell(joint.kind if joint.mimics is None else f'{joint.kind}, follows {joint.mimics}'),
        _range(joint),
        worst,
        amount(joint.effort, tone='' if joint.effort > 0.0 else 'doubt'),
        share,
        left,
        velocity,
        Cell(f'{number(joint.friction, 3)}, {number(joint.damping, 3)}', joint.friction),
        where,
    )


def _range(joint: JointEntry) -> Cell:
    is_prismatic = joint.kind == 'prismatic'
    if math.isinf(joint.lower) and math.isinf(joint.upper):
        return Cell('no limits' if is_prismatic else 'without end')
    ends = f'{position(joint.lower, is_prismatic)} to {position(joint.upper, is_prismatic)}'
    return Cell(ends, tone='firm doubt' if joint.lower >= joint.upper else 'firm')


def _share(share: float) -> Cell:
    if math.isnan(share):
        return Cell(MISSING, share, 'missing')
    return Cell(percent(share), share, _SHARE_CLASSES[tone(share)], meter=100.0 * min(share, 1.0))


def _link(link: LinkEntry) -> tuple[Cell, ...]:
    mass = amount(link.mass)
    if not link.has_inertial:
        mass = Cell(
            '0, no <inertial>' if link.has_shape else '0',
            0.0,
            'doubt' if link.has_shape and link.carrier else 'missing',
        )
    return (
        name(link.name),
        mass,
        _vector(link.com),
        _vector(link.principal_moments),
        _is_possible(link.is_physical, link.has_inertial, link.violations),
        Cell('stands on the base', tone='missing') if link.carrier is None else name(link.carrier),
    )


def _body(body: BodyEntry) -> tuple[Cell, ...]:
    return (
        name(body.joint),
        name(body.link),
        Cell(names=body.lumped) if body.lumped else Cell(MISSING, tone='missing'),
        amount(body.mass, tone='' if body.mass > 0.0 else 'doubt'),
        _vector(body.com),
        _vector(body.principal_moments),
        _is_possible(body.is_physical, body.mass > 0.0),
    )


def _vector(values: Sequence[float] | None) -> Cell:
    return Cell(vector(values, 3), tone='missing' if values is None else '')


def _is_possible(is_physical: bool, has_mass: bool, violations: Sequence[str] = ()) -> Cell:
    if not is_physical:
        return Cell('no: ' + '; '.join(violations) if violations else 'no', tone='bad')
    return Cell('yes', tone='fine') if has_mass else Cell('no mass', tone='missing')
