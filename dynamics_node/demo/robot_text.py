"""
The simulator's own reader of URDF texts, with the standard library alone.

The simulation judges the node, so it shares no code with the node's URDF reader.

"""

from dataclasses import dataclass
import itertools
import math
from xml.etree import ElementTree as ET
from xml.parsers import expat

ONE_DEGREE_OF_FREEDOM = ('revolute', 'continuous', 'prismatic')


class RobotRefusedError(ValueError):
    """The simulator cannot run this robot; the message states the reason in one sentence."""


@dataclass(frozen=True)
class Mimic:
    """A mimic tag: position = multiplier * source + offset."""

    source: str
    multiplier: float
    offset: float


@dataclass(frozen=True)
class MovableJoint:
    """
    A joint with one degree of freedom.

    Positions in rad or m, velocity per s, effort in N m or N. Defaults where the URDF states no
    value: infinite `lower` and `upper`, 0.0 for `effort`, `velocity` and `damping`.

    """

    name: str
    kind: str
    lower: float
    upper: float
    effort: float
    velocity: float
    damping: float
    mimic: Mimic | None

    @property
    def turns(self) -> bool:
        """True for a revolute or continuous joint (rad), False for a prismatic one (m)."""
        return self.kind != 'prismatic'


def parse(text: str) -> ET.Element:
    """Return the <robot> element of a URDF text."""
    # Without name spaces, as MuJoCo reads it: URDFs use undeclared prefixes.
    builder = ET.TreeBuilder()
    parser = expat.ParserCreate(encoding='utf-8')
    parser.StartElementHandler, parser.EndElementHandler = builder.start, builder.end
    try:
        parser.Parse(text.strip().encode(errors='surrogatepass'), True)
    except expat.ExpatError as error:
        raise RobotRefusedError(f'the robot description is not XML: {error}') from error
    root = builder.close()
    if root.tag != 'robot':
        raise RobotRefusedError(f'expected a URDF with <robot> at its top, got <{root.tag}>')
    return root


def movable_joints(text: str) -> list[MovableJoint]:
    """Return the movable joints of a URDF text in the order of the document."""
    elements = parse(text).findall('joint')
    for element in elements:
        if element.get('type') in ('floating', 'planar'):
            raise RobotRefusedError(
                f'joint {element.get("name")!r} is {element.get("type")}: the '
                'simulated robot has joints of one degree of freedom only'
            )
    joints = [_joint(e) for e in elements if e.get('type') in ONE_DEGREE_OF_FREEDOM]
    if not joints:
        raise RobotRefusedError('the robot has no movable joint: there is nothing to simulate')
    return joints


def mujoco_text(text: str) -> str:
    """
    Return the URDF text for MuJoCo.

    Removed: collision shapes (the arm moves freely), meshes (the motion does not need their
    files) and mimic tags (`mujoco_model` couples these joints). The inertia is the file's.

    """
    root = parse(text)
    _rename_world(root)
    for link in root.findall('link'):
        for shape in link.findall('collision') + link.findall('visual'):
            if shape.tag == 'collision' or shape.find('geometry/mesh') is not None:
                link.remove(shape)
    for joint in root.findall('joint'):
        for mimic in joint.findall('mimic'):
            joint.remove(mimic)
    for old in root.findall('mujoco'):
        root.remove(old)
    ET.SubElement(
        ET.SubElement(root, 'mujoco'),
        'compiler',
        {'discardvisual': 'false', 'fusestatic': 'true', 'inertiafromgeom': 'false'},
    )
    return ET.tostring(root, encoding='unicode')


def _rename_world(root: ET.Element) -> None:
    """Rename a link called 'world', which MuJoCo takes for the ground."""
    names = {link.get('name') for link in root.findall('link')}
    free = next(name for i in itertools.count() if (name := f'world_link_{i}') not in names)
    for tag, key in (('link', 'name'), ('joint/parent', 'link'), ('joint/child', 'link')):
        for element in root.findall(tag):
            if element.get(key) == 'world':
                element.set(key, free)


def robot_name(text: str) -> str:
    """Return the robot's name in the URDF, or 'robot'."""
    return parse(text).get('name') or 'robot'


def _joint(element: ET.Element) -> MovableJoint:
    """Return one <joint> element as a MovableJoint."""
    limit = _attributes(element.find('limit'))
    # URDF's default is 0 for both bounds. As in MuJoCo, an empty range is no limit.
    lower, upper = limit.get('lower', 0.0), limit.get('upper', 0.0)
    bounded = element.get('type') != 'continuous' and lower < upper
    return MovableJoint(
        name=element.get('name', ''),
        kind=element.get('type', ''),
        lower=lower if bounded else -math.inf,
        upper=upper if bounded else math.inf,
        effort=limit.get('effort', 0.0),
        velocity=limit.get('velocity', 0.0),
        damping=_attributes(element.find('dynamics')).get('damping', 0.0),
        mimic=_mimic(element.find('mimic')),
    )


def _mimic(element: ET.Element | None) -> Mimic | None:
    """Return a <mimic> element, if there is one."""
    if element is None:
        return None
    values = _attributes(element)
    return Mimic(
        element.get('joint', ''), values.get('multiplier', 1.0), values.get('offset', 0.0)
    )


def _attributes(element: ET.Element | None) -> dict[str, float]:
    """Return the numeric attributes of an element."""
    values = {}
    for key, text in (element.attrib if element is not None else {}).items():
        try:
            values[key] = float(text)
        except ValueError:
            pass  # names, and vendors' own attributes
    return values
