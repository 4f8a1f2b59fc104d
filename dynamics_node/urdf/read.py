"""
From URDF to a checked robot description.

The text is parsed twice: strictly, within limits, by `input_limits`, and then, reduced to what
dynamics needs, by yourdfpy, which returns its numbers and poses.

"""

import io
import math
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from .description import Inertial, Joint, Link, Mimic, RobotDescription, Stated
from .inertial import inertial_findings
from .input_limits import check_text, load_text, parse, Source
from .partial_read import PartialRead, readable_parts
from .validation import (
    is_number,
    LARGEST,
    moved_links,
    number_problems,
    root_link,
    structure_problems,
)
from ..errors import RobotDescriptionError

# Elements that dynamics reads. All others (visuals, collisions, meshes, plugins, other name
# spaces) are removed before the text reaches yourdfpy, so no mesh address is ever resolved.
_PARTS: dict[str, set[str]] = {
    'robot': {'link', 'joint'},
    'link': {'inertial'},
    'inertial': {'origin', 'mass', 'inertia'},
    'joint': {'parent', 'child', 'origin', 'axis', 'limit', 'dynamics', 'mimic'},
}
_ATTRIBUTES = {
    *('name', 'type', 'link', 'joint', 'xyz', 'rpy', 'value'),
    *('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz'),
    *('lower', 'upper', 'effort', 'velocity'),
    *('damping', 'friction', 'multiplier', 'offset'),
}


def read_urdf(source: Source) -> RobotDescription:
    """
    Read a URDF and check everything that dynamics depends on.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the text itself.

    Returns
    -------
    RobotDescription
        With warnings for accepted but suspicious values.

    Raises
    ------
    RobotDescriptionError
        With all problems at once: link or joint, attribute, expected, got.

    """
    result = examine_urdf(source)
    if result.problems:
        raise RobotDescriptionError(result.problems)
    return result.description


def examine_urdf(source: Source) -> PartialRead:
    """
    Read a URDF as far as possible, for a report about it.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path or the text itself.

    Returns
    -------
    PartialRead
        The readable parts, and the reasons for which the URDF is refused, if any.

    Raises
    ------
    RobotDescriptionError
        If the text is not XML, not a URDF, or refused before parsing: nothing is readable.

    """
    robot, name = _element(source)
    visual, collision = (
        {link.get('name') for link in robot.findall('link') if link.find(tag) is not None}
        for tag in ('visual', 'collision')
    )
    plugins = _hardware_plugins(robot)
    robot = _needed(robot)
    # yourdfpy requires a name and does not use it.
    robot.set('name', 'robot')
    problems = structure_problems(robot) + number_problems(robot)
    unread: frozenset[str] = frozenset()
    is_whole = not problems
    if problems:
        robot, unread = readable_parts(robot)
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
    # Of a partial robot only the problems that make it partial: the values of its remaining
    # parts are judged when it is whole.
    return PartialRead(
        description, tuple(problems or link_problems + joint_problems), is_whole, unread
    )


def _element(source: Source) -> tuple[ElementTree.Element, str]:
    # The <robot> element and the robot's name.
    text = load_text(source)
    check_text(text)
    robot = parse(text)
    if _has_xacro(robot):
        raise RobotDescriptionError(
            [
                'it contains xacro elements: expand it first, with '
                '`xacro robot.urdf.xacro > robot.urdf`'
            ]
        )
    return robot, robot.get('name') or 'robot'


def _hardware_plugins(robot: ElementTree.Element) -> tuple[str, ...]:
    # For safety alone: some drivers compensate gravity themselves.
    texts = (plugin.text or '' for plugin in robot.findall('ros2_control/hardware/plugin'))
    return tuple(dict.fromkeys(text.strip() for text in texts if text.strip()))


def _has_xacro(robot: ElementTree.Element) -> bool:
    # Elements of xacro have a prefix, usually this one.
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


def _needed(element: ElementTree.Element) -> ElementTree.Element:
    # A copy: removing 100 000 elements one by one takes more than a second.
    copy = ElementTree.Element(
        element.tag, {name: value for name, value in element.items() if name in _ATTRIBUTES}
    )
    parts = _PARTS.get(element.tag, set())
    copy.extend([_needed(part) for part in element if part.tag in parts])
    return copy


def _take_soft_limits(robot: ElementTree.Element) -> dict[str, Stated]:
    # A URDF without usable effort or velocity limits still has dynamics: these two may be
    # missing, 0 or 'inf', and are then unknown (NaN). yourdfpy would call float() on them, so
    # they are removed first.
    limits: dict[str, Stated] = {}
    for joint in robot.findall('joint'):
        limit = joint.find('limit')
        attributes = {} if limit is None else limit.attrib
        stated = {
            name: _number_or_nan(attributes.get(name, ''))
            for name in ('lower', 'upper', 'effort', 'velocity')
        }
        for name in ('effort', 'velocity'):
            attributes.pop(name, '')
        # yourdfpy fills in a default axis, so a missing one is noted first.
        limits[joint.attrib['name']] = Stated(**stated, has_axis=joint.find('axis') is not None)
    return limits


def _number_or_nan(text: str) -> float:
    return float(text) if is_number(text) else math.nan


def _positive_or_nan(value: float) -> float:
    return value if value > 0.0 else math.nan


def _parse(robot: ElementTree.Element) -> Any:
    # Imported here: it takes about a second (trimesh), which a start without a robot saves.
    from yourdfpy import URDF

    text = io.BytesIO(ElementTree.tostring(robot))
    return URDF.load(text, build_scene_graph=False, load_meshes=False).robot


def _links(
    parsed: Any, moved: set[str], shaped: set[str | None], visual: set[str | None]
) -> tuple[list[Link], list[str], list[str]]:
    links, problems, warnings = [], [], []
    for link in parsed:
        inertial = None
        if link.inertial is not None:
            inertial = Inertial(
                float(link.inertial.mass),
                _placement(link.inertial.origin),
                np.array(link.inertial.inertia, dtype=float),
            )
            refused, suspicious = inertial_findings(link.name, inertial, link.name in moved)
            problems += refused
            warnings += suspicious
        links.append(Link(link.name, inertial, link.name in shaped, link.name in visual))
    return links, problems, warnings


def _joints(parsed: Any, stated: dict[str, Stated]) -> tuple[list[Joint], list[str], list[str]]:
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


def _axis(joint: Any, is_missing: bool) -> tuple[NDArray[np.float64], list[str], list[str]]:
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


def _position_limits(joint: Any) -> tuple[float, float]:
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


def _friction(joint: Any) -> tuple[dict[str, float], list[str]]:
    # yourdfpy returns these as text, checked by number_problems.
    values: dict[str, float] = {}
    warnings = []
    for name in ('damping', 'friction'):
        text = None if joint.dynamics is None else getattr(joint.dynamics, name)
        value = 0.0 if text is None else float(text)
        if value < 0.0:
            warnings.append(f"joint '{joint.name}': {name} is {value:g}, must be >= 0: 0 is used")
        values[name] = max(value, 0.0)
    return values, warnings


def _mimic(joint: Any) -> Mimic | None:
    if joint.mimic is None or joint.type == 'fixed':
        return None
    return Mimic(joint.mimic.joint, float(joint.mimic.multiplier), float(joint.mimic.offset))


def _placement(matrix: Any) -> NDArray[np.float64]:
    return np.eye(4) if matrix is None else np.array(matrix, dtype=float)
