"""Centers of mass outside the robot."""

from __future__ import annotations

from functools import partial

import numpy as np

from .context import FindingContext
from .effects import changed, torque_effect
from .grouping import group_findings, Occurrence
from .kinds import WARNING
from ..formatting import plain_number
from ..report import Finding, LinkEntry

# Distance of a suspicious center of mass, as a share of the robot's reach.
_OF_REACH = 0.6
# The same, in units of the size of the link and of its neighbors.
_OF_NEIGHBORS = 3.0
# A misplaced decimal point, centimeters or millimeters: the first that leads into the link.
_FACTORS = (
    (1e-1, 'a tenth of that'),
    (1e-2, 'a hundredth of that'),
    (1e-3, 'a thousandth of that'),
)


def find_distant_centers(context: FindingContext) -> list[Finding]:
    """Return links whose center of mass is implausibly far from their frame."""
    occurrences = []
    for entry in context.moved_with_mass:
        distance = float(np.linalg.norm(entry.com or (0.0, 0.0, 0.0)))
        around = _size_with_children(context, entry.name)
        if (
            context.reach > 0.0
            and distance > _OF_REACH * context.reach
            and distance > _OF_NEIGHBORS * around
        ):
            occurrences.append(_occurrence(context, entry, distance, around))
    return group_findings(
        occurrences, lambda count: f'{count} links have their center of mass outside the robot'
    )


def _size_with_children(context: FindingContext, link: str) -> float:
    children = [joint.child for joint in context.description.joints if joint.parent == link]
    return max(context.size_without_com(name) for name in (link, *children))


def _occurrence(
    context: FindingContext, entry: LinkEntry, distance: float, around: float
) -> Occurrence:
    factor, text = next(
        ((factor, text) for factor, text in _FACTORS if factor * distance < 2.0 * around),
        _FACTORS[-1],
    )
    com = factor * np.array(entry.com)
    return Occurrence(
        WARNING,
        'far_com',
        entry.name,
        f"link '{entry.name}' has its center of mass {plain_number(distance)} m from its frame, "
        f'in a robot whose joints reach {plain_number(context.reach)} m',
        f'{plain_number(distance)} m',
        partial(
            torque_effect,
            context,
            {entry.name: changed(context.inertial(entry.name), com=com)},
            f'if it were {text}, {plain_number(factor * distance)} m',
        ),
        'URDF has meters: were centimeters or millimeters written, or the coordinates of the '
        'whole robot instead of those in the link frame?',
        distance / context.reach,
    )
