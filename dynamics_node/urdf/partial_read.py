"""What could be read of a description that may be broken."""

from dataclasses import dataclass
from xml.etree import ElementTree

from .description import RobotDescription
from .validation import MAX_NAME, number_problems, part_problems


@dataclass(frozen=True)
class Examination:
    """
    A robot description, and why it is refused, if it is.

    Attributes
    ----------
    description : RobotDescription
        The whole robot, or the links and joints that could be read; then it has no root.
    problems : tuple of str
        One sentence each; empty for a robot that is taken.
    is_whole : bool
        Whether links and joints are complete and one tree; their numbers may still be refused.
    unread : frozenset of str
        Links whose <inertial> has no numbers that could be read.

    """

    description: RobotDescription
    problems: tuple
    is_whole: bool
    unread: frozenset


def sound_parts(robot):
    """
    Keep the links and joints that can be read one by one.

    Parameters
    ----------
    robot : xml.etree.ElementTree.Element
        The <robot> element, with nothing in it but what dynamics reads.

    Returns
    -------
    sound : xml.etree.ElementTree.Element
        Each name once; links whose <inertial> cannot be read are there without it.
    unread : frozenset of str
        The names of these links.

    """
    sound = ElementTree.Element(robot.tag, robot.attrib)
    unread = set()
    known: dict[str, set] = {'link': set(), 'joint': set()}
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
        sound.append(element)
    children: set = set()
    for joint in sound.findall('joint'):
        parent, child = (
            end.get('link') for tag in ('parent', 'child') for end in joint.findall(tag)
        )
        if parent not in known['link'] or child not in known['link'] or child in children:
            sound.remove(joint)
        children.add(child)
    return sound, frozenset(unread)
