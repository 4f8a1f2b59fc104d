"""From URDF to a checked robot description."""

import io
import math
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from .description import Inertial, Joint, Link, Mimic, RobotDescription, Stated
from .inertial import inertial_findings
from .input_limits import check_text, load_text
from .partial_read import Examination, sound_parts
from .validation import (
    is_number,
    LARGEST,
    moved_links,
    number_problems,
    root_link,
    structure_problems,
)
from .yourdfpy_parser import urdf_class
from ..errors import RobotDescriptionError

# What dynamics reads. Everything else (visuals, collisions, meshes, plugins, names of other name
# spaces) is left out before the text reaches yourdfpy, so no mesh address is ever looked at.
_PARTS = {
    'robot': {'link', 'joint'},
    'link': {'inertial'},
    'inertial': {'origin', 'mass', 'inertia'},
    'joint': {'parent', 'child', 'origin', 'axis', 'limit', 'dynamics', 'mimic'},
}
_ATTRIBUTES = {
    'name',
    'type',
    'link',
    'joint',
    'xyz',
    'rpy',
    'value',
    'ixx',
    'ixy',
    'ixz',
    'iyy',
    'iyz',
    'izz',
    'lower',
    'upper',
    'effort',
    'velocity',
    'damping',
    'friction',
    'multiplier',
    'offset',
}


def read_urdf(source):
    """
    Read a URDF and check everything that dynamics depends on.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the text itself.

    Returns
    -------
    RobotDescription
        With warnings for what was accepted but looks wrong.

    Raises
    ------
    RobotDescriptionError
        With all problems at once: link or joint, attribute, expected, got.

    """
    found = examine_urdf(source)
    if found.problems:
        raise RobotDescriptionError(found.problems)
    return found.description


def examine_urdf(source):
    """
    Read a URDF as far as that is possible, for a report to those who have to mend it.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the text itself.

    Returns
    -------
    Examination
        What could be read, and why it is refused, if it is.

    Raises
    ------
    RobotDescriptionError
        If it is no XML, no URDF, or refused before it is parsed: there is nothing to show then.

    """
    robot, name = _element(source)
    visual, collision = (
        {link.get('name') for link in robot.findall('link') if link.find(tag) is not None}
        for tag in ('visual', 'collision')
    )
    plugins = _hardware_plugins(robot)
    robot = _needed(robot)
    # yourdfpy asks for one, of no use to it.
    robot.set('name', 'robot')
    problems = structure_problems(robot) + number_problems(robot)
    unread: frozenset = frozenset()
    is_whole = not problems
    if problems:
        robot, unread = sound_parts(robot)
    stated = _take_soft_limits(robot)
    parsed = _parse(robot)
    moved = moved_links(robot) if is_whole else {link.name for link in parsed.links}
    links, link_problems, link_warnings = _links(parsed.links, moved, visual | collision, visual)
    joints, joint_problems, joint_warnings = _joints(parsed.joints, stated)
    description = RobotDescription(
        name,
        root_link(robot) if is_whole else '',
        tuple(links),
        tuple(joints),
        tuple(link_warnings + joint_warnings),
        plugins,
    )
    # Of parts, only what makes them parts: read_urdf says the rest when that is mended.
    return Examination(
        description, tuple(problems or link_problems + joint_problems), is_whole, unread
    )


def _element(source):
    # The <robot> element and the robot's name.
    text = load_text(source)
    check_text(text)
    robot = _tree(text)
    if _has_xacro(robot):
        raise RobotDescriptionError(
            [
                'it contains xacro elements: expand it first, with '
                '`xacro robot.urdf.xacro > robot.urdf`'
            ]
        )
    return robot, robot.get('name') or 'robot'


def _hardware_plugins(robot):
    # For safety alone: some drivers compensate gravity themselves.
    texts = (plugin.text or '' for plugin in robot.findall('ros2_control/hardware/plugin'))
    return tuple(dict.fromkeys(text.strip() for text in texts if text.strip()))


def _tree(text):
    # Without name spaces, as urdfdom reads it: public URDFs have attributes and elements of
    # prefixes that nothing declares (drake:acceleration), which nothing here looks at. The
    # encoding is settled; what an XML declaration says behind a byte order mark is not looked up.
    builder = ElementTree.TreeBuilder()
    parser = expat.ParserCreate(encoding='utf-8')
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data  # the names of hardware plugins are text
    parser.Parse(text, True)
    return builder.close()


def _has_xacro(robot):
    # Its elements are called so by a prefix, usually this one.
    prefixes = {'xacro'}
    for element in robot.iter():
        prefixes |= {
            name.removeprefix('xmlns:')
            for name, value in element.items()
            if name.startswith('xmlns:') and 'xacro' in value
        }
    return any(
        element.tag.partition(':')[0] in prefixes for element in robot.iter() if ':' in element.tag
    )


def _needed(element):
    # A copy: to remove a hundred thousand elements one by one takes more than a second.
    copy = ElementTree.Element(
        element.tag, {name: value for name, value in element.items() if name in _ATTRIBUTES}
    )
    parts = _PARTS.get(element.tag, ())
    copy.extend([_needed(part) for part in element if part.tag in parts])
    return copy


def _take_soft_limits(robot):
    # A URDF without usable effort or velocity limits still has dynamics: these two may be
    # missing, 0, 'inf' or nonsense, and then they are unknown (NaN). yourdfpy would call
    # float() on them, so they are taken out before it sees them.
    limits = {}
    for joint in robot.findall('joint'):
        limit = joint.find('limit')
        attributes = {} if limit is None else limit.attrib
        stated = {
            name: _number_or_nan(attributes.get(name, ''))
            for name in ('lower', 'upper', 'effort', 'velocity')
        }
        for name in ('effort', 'velocity'):
            attributes.pop(name, '')
        # yourdfpy fills in its default axis, so this has to be seen before.
        limits[joint.get('name')] = Stated(**stated, has_axis=joint.find('axis') is not None)
    return limits


def _number_or_nan(text):
    return float(text) if is_number(text) else math.nan


def _positive_or_nan(value):
    return value if value > 0.0 else math.nan


def _parse(robot):
    return (
        urdf_class()
        .load(io.BytesIO(ElementTree.tostring(robot)), build_scene_graph=False, load_meshes=False)
        .robot
    )


def _links(parsed, moved, shaped, visual):
    links, problems, warnings = [], [], []
    for link in parsed:
        inertial = None
        if link.inertial is not None:
            inertial = Inertial(
                float(link.inertial.mass),
                _placement(link.inertial.origin),
                np.array(link.inertial.inertia, dtype=float),
            )
            found = inertial_findings(link.name, inertial, link.name in moved)
            problems += found[0]
            warnings += found[1]
        links.append(Link(link.name, inertial, link.name in shaped, link.name in visual))
    return links, problems, warnings


def _joints(parsed, stated):
    joints, problems, warnings = [], [], []
    for joint in parsed:
        axis, problem, warning = _axis(joint, not stated[joint.name].has_axis)
        problems += problem
        warnings += warning
        lower, upper = _position_limits(joint)
        friction, warning = _friction(joint)
        warnings += warning
        joints.append(
            Joint(
                joint.name,
                joint.type,
                joint.parent,
                joint.child,
                _placement(joint.origin),
                axis,
                lower,
                upper,
                _positive_or_nan(stated[joint.name].effort),
                _positive_or_nan(stated[joint.name].velocity),
                **friction,
                mimic=_mimic(joint),
                stated=stated[joint.name],
            )
        )
    return joints, problems, warnings


def _axis(joint, is_missing):
    axis = np.array(joint.axis, dtype=float)
    if joint.type == 'fixed':
        return axis, [], []
    where = f"joint '{joint.name}': axis"
    if is_missing:
        return axis, [], [f'{where} is missing, (1, 0, 0) is used']
    with np.errstate(over='ignore'):
        length = np.linalg.norm(axis)
    if not 1e-9 < length < 1e9:
        return axis, [f'{where} has length {length:.3g}, must be a direction'], []
    if abs(length - 1.0) > 1e-6:
        return axis / length, [], [f'{where} has length {length:.6g}, it is normalized to 1']
    return axis / length, [], []


def _position_limits(joint):
    limit = joint.limit
    if limit is None or joint.type == 'continuous':
        return -math.inf, math.inf
    lower = 0.0 if limit.lower is None else limit.lower
    upper = 0.0 if limit.upper is None else limit.upper
    if not lower < upper:
        return -math.inf, math.inf
    return (
        lower if abs(lower) <= LARGEST else -math.inf,
        upper if abs(upper) <= LARGEST else math.inf,
    )


def _friction(joint):
    # yourdfpy returns these as text; number_problems has checked it.
    values, warnings = {}, []
    for name in ('damping', 'friction'):
        text = None if joint.dynamics is None else getattr(joint.dynamics, name)
        value = 0.0 if text is None else float(text)
        if value < 0.0:
            warnings.append(f"joint '{joint.name}': {name} is {value:g}, must be >= 0: 0 is used")
        values[name] = max(value, 0.0)
    return values, warnings


def _mimic(joint):
    if joint.mimic is None or joint.type == 'fixed':
        return None
    return Mimic(joint.mimic.joint, float(joint.mimic.multiplier), float(joint.mimic.offset))


def _placement(matrix):
    return np.eye(4) if matrix is None else np.array(matrix, dtype=float)
