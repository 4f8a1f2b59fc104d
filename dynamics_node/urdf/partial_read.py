"""Best-effort reading of a defective URDF."""

from dataclasses import dataclass
from xml.etree import ElementTree

from .description import RobotDescription
from .validation import MAX_NAME, number_problems, part_problems


@dataclass(frozen=True)
class PartialRead:
    """
    A robot description as far as it is readable, and the reasons for which it is refused.

    Attributes
    ----------
    description : RobotDescription
        The whole robot; or its readable links and joints, then without a root.
    problems : tuple of str
        One sentence each; empty for an accepted robot.
    is_whole : bool
        Whether links and joints are complete and one tree; their numbers may still be refused.
    unread : frozenset of str
        Links whose <inertial> has no readable numbers.

    """

    description: RobotDescription
    problems: tuple[str, ...]
    is_whole: bool
    unread: frozenset[str]


def readable_parts(robot: ElementTree.Element) -> tuple[ElementTree.Element, frozenset[str]]:
    """
    Keep the links and joints that are readable on their own.

    Parameters
    ----------
    robot : xml.etree.ElementTree.Element
        The <robot> element, reduced to the parts that dynamics reads.

    Returns
    -------
    readable : xml.etree.ElementTree.Element
        Each name once; a link with an unreadable <inertial> is kept without it.
    unread : frozenset of str
        The names of these links.

    """
    readable = ElementTree.Element(robot.tag, robot.attrib)
    unread = set()
    known: dict[str, set[str]] = {'link': set(), 'joint': set()}
    for element in robot:
        name, names = element.get('name'), known[element.tag]
        if not name or name in names or len(name) > MAX_NAME or not name.isprintable():
            continue
        alone = ElementTree.Element('robot')
        alone.append(element)
        if part_problems(element) or number_problems(alone):
            if element.tag == 'joint':
                continue
            unread.add(name)
            element = ElementTree.Element('link', element.attrib)
        names.add(name)
        readable.append(element)
    _remove_loose_joints(readable, known['link'])
    return readable, frozenset(unread)


def _remove_loose_joints(robot: ElementTree.Element, links: set[str]) -> None:
    # Joints between unknown links, and all but the first joint of a child link.
    children = set()
    for joint in robot.findall('joint'):
        parent, child = (
            end.get('link') for tag in ('parent', 'child') for end in joint.findall(tag)
        )
        if parent not in links or child not in links or child in children:
            robot.remove(joint)
        children.add(child)
