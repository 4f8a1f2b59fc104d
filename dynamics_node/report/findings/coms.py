"""Centers of mass that are outside the robot."""

import numpy as np

from .effects import changed, torque_effect
from .hit import Hit, told
from .kinds import WARNING
from .words import number

# A center of mass further than this share of the reach, and so many times further than the
# joints of the link and of its neighbors, is no part of it.
_OF_REACH, _FURTHER = 0.6, 3.0


def find_coms(case):
    """Return links whose center of mass cannot be where it is said to be."""
    hits = []
    for entry in case.moved_with_mass:
        com = np.array(entry.com)
        distance, reach = float(np.linalg.norm(com)), case.reach
        around = max(
            [
                case.size_without_com(entry.name),
                *(
                    case.size_without_com(other.child)
                    for other in case.description.joints
                    if other.parent == entry.name
                ),
            ]
        )
        if not (reach > 0.0 and distance > _OF_REACH * reach and distance > _FURTHER * around):
            continue
        # A misplaced decimal point, if that is enough; or else millimeters.
        is_near = 0.1 * distance < 2.0 * around
        right, said = (
            (0.1 * com, 'a tenth of that') if is_near else (1e-3 * com, 'a thousandth of that')
        )
        hits.append(
            Hit(
                WARNING,
                'far_com',
                entry.name,
                f"link '{entry.name}' has its center of mass {number(distance)} m from its frame, "
                f'in a robot whose joints reach {number(reach)} m',
                f'{number(distance)} m',
                _later(
                    case,
                    entry.name,
                    right,
                    f'if it were {said}, {number(float(np.linalg.norm(right)))} m',
                ),
                'URDF has meters: were millimeters written, or the coordinates of the whole robot '
                'instead of those in the link frame?',
                distance / reach,
            )
        )
    return told(hits, lambda count: f'{count} links have their center of mass outside the robot')


def _later(case, link, com, if_what):
    inertial = changed(case.links[link].inertial, com=com)
    return lambda: torque_effect(case, {link: inertial}, if_what)
