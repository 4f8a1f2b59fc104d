"""Strict checks of a URDF before any value is used: numbers, and the tree of links and joints."""

from collections import Counter
from collections.abc import Collection, Sequence
import math
import re
from xml.etree.ElementTree import Element

from ..errors import quoted

# A number of a URDF: no 'nan', no 'inf', no '1_0', no hexadecimal. No two repetitions can match
# the same digits, so that a long text is matched in linear time.
_NUMBER = re.compile(r'[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?')
# White space of XML; that of Python has more characters.
_BLANKS = ' \t\r\n'

# Largest accepted number, in SI units: above those of all robots, and products of several such
# numbers are finite.
LARGEST = 1e30

# Accepted texts of an effort or velocity limit that is none.
_UNLIMITED = re.compile(r'[+-]?(inf|infinity|nan|1e999)|', re.IGNORECASE)

# Attribute, count of its numbers, whether it is required.
_Attribute = tuple[str, int, bool]
_INERTIA = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
# Element → attributes. Effort and velocity limits are checked apart: they may be missing, 0 or
# infinite, because a URDF without them still has dynamics.
_LINK_NUMBERS: dict[str, list[_Attribute]] = {
    'inertial/origin': [('xyz', 3, False), ('rpy', 3, False)],
    'inertial/mass': [('value', 1, True)],
    'inertial/inertia': [(name, 1, True) for name in _INERTIA],
}
_JOINT_NUMBERS: dict[str, list[_Attribute]] = {
    'origin': [('xyz', 3, False), ('rpy', 3, False)],
    'axis': [('xyz', 3, True)],
    'limit': [('lower', 1, False), ('upper', 1, False)],
    'dynamics': [('damping', 1, False), ('friction', 1, False)],
    'mimic': [('multiplier', 1, False), ('offset', 1, False)],
}
_INERTIAL_PARTS = ('inertial/mass', 'inertial/inertia')
# Elements without the bound LARGEST: huge position limits mean none; an axis has its own bounds.
_MAY_BE_LARGER = {'limit', 'axis'}

SUPPORTED_TYPES = ('revolute', 'continuous', 'prismatic', 'fixed')
UNSUPPORTED_TYPES = ('floating', 'planar')
# Longest name of a link or joint, characters: names are part of every message and log.
MAX_NAME = 255


def is_number(text: str) -> bool:
    """
    Tell whether a text is a finite decimal number.

    Parameters
    ----------
    text : str
        Value of an attribute; white space around it is ignored.

    Returns
    -------
    bool
        False for 'nan', 'inf', '1_0', '0x1', '1e999' and the like.

    """
    return bool(_NUMBER.fullmatch(text.strip(_BLANKS))) and math.isfinite(float(text))


def number_problems(robot: Element) -> list[str]:
    """
    List every missing attribute and every attribute with wrong numbers.

    Parameters
    ----------
    robot : xml.etree.ElementTree.Element
        The <robot> element.

    Returns
    -------
    list of str
        One sentence per problem: link or joint, element, attribute, expected, got.

    """
    problems = []
    for link in robot.findall('link'):
        where = f'link {quoted(link.get("name"))}'
        problems += _in_element(link, where, _LINK_NUMBERS)
        if link.find('inertial') is not None:
            problems += [
                f'{where}: <inertial> has no <{part.split("/")[1]}>'
                for part in _INERTIAL_PARTS
                if link.find(part) is None
            ]
    for joint in robot.findall('joint'):
        where = f'joint {quoted(joint.get("name"))}'
        problems += _in_element(joint, where, _JOINT_NUMBERS)
        problems += _soft_limits(joint, where)
    return problems


def _soft_limits(joint: Element, where: str) -> list[str]:
    limit = joint.find('limit')
    given = {} if limit is None else limit.attrib
    return [
        f'{where}: <limit> {name}: expected a number, got {_quoted_value(given[name])}'
        for name in ('effort', 'velocity')
        if name in given
        and not is_number(given[name])
        and not _UNLIMITED.fullmatch(given[name].strip(_BLANKS))
    ]


def _in_element(parent: Element, where: str, table: dict[str, list[_Attribute]]) -> list[str]:
    problems: list[str] = []
    for path, attributes in table.items():
        element = parent.find(path)
        if element is None:
            continue
        for name, count, required in attributes:
            problems += _in_attribute(
                element, f'{where}: <{element.tag}> {name}', name, count, required
            )
    return problems


def _in_attribute(
    element: Element, where: str, name: str, count: int, required: bool
) -> list[str]:
    text = element.get(name)
    if text is None:
        return [f'{where} is missing'] if required else []
    parts = [part for part in re.split(f'[{_BLANKS}]+', text) if part]
    if len(parts) != count or not all(is_number(part) for part in parts):
        expected = 'a finite number' if count == 1 else f'{count} finite numbers'
    elif element.tag not in _MAY_BE_LARGER and any(abs(float(part)) > LARGEST for part in parts):
        expected = f'at most {LARGEST:g}'
    else:
        return []
    return [f'{where}: expected {expected}, got {_quoted_value(text)}']


def _quoted_value(text: str) -> str:
    # The beginning of an expression or a substitution of xacro.
    is_xacro = '${' in text or '$(' in text
    return quoted(text) + ('; a xacro file must be expanded first' if is_xacro else '')


def structure_problems(robot: Element) -> list[str]:
    """
    List everything that prevents the links and joints from forming one tree.

    Parameters
    ----------
    robot : xml.etree.ElementTree.Element
        The <robot> element, reduced to the parts that dynamics reads.

    Returns
    -------
    list of str
        One sentence per problem. Empty: each name and element once, one root, no cycle,
        printable names of existing links, supported joint types, and mimic chains that end at a
        movable joint.

    """
    links = [link.get('name') for link in robot.findall('link')]
    joints = robot.findall('joint')
    problems = _naming_problems('link', links)
    problems += _naming_problems('joint', [joint.get('name') for joint in joints])
    if not links:
        problems.append('it has no <link>')
    for element in robot:
        problems += _repetition_problems(element)
    known = set(links)
    for joint in joints:
        problems += _joint_problems(joint, known)
    if not problems:
        problems += _tree_problems(links, joints)
        problems += _mimic_problems(joints)
    return problems


def part_problems(element: Element) -> list[str]:
    """Return the problems of one <link> or <joint> on its own, one sentence each."""
    problems = _repetition_problems(element)
    if element.tag == 'joint':
        ends = {end.get('link') for tag in ('parent', 'child') for end in element.findall(tag)}
        problems += _joint_problems(element, ends)
        problems += [
            f'joint {quoted(element.get("name"))}: <mimic> names no joint'
            for mimic in element.findall('mimic')
            if not mimic.get('joint')
        ]
    return problems


def root_link(robot: Element) -> str:
    """Return the name of the link that is no joint's child, of a robot without problems."""
    children = {_end(joint, 'child') for joint in robot.findall('joint')}
    names = (link.attrib['name'] for link in robot.findall('link'))
    return next(name for name in names if name not in children)


def moved_links(robot: Element) -> set[str]:
    """Return the links that any movable joint carries, of a robot without problems."""
    joint_of = {_end(joint, 'child'): joint for joint in robot.findall('joint')}
    is_moved: dict[str, bool] = {}
    for name in joint_of:
        # Up to a movable joint, to a link with a known answer, or to the root.
        path, link = [], name
        while link in joint_of and link not in is_moved and joint_of[link].get('type') == 'fixed':
            path.append(link)
            link = _end(joint_of[link], 'parent')
        answer = is_moved.get(link, link in joint_of)
        is_moved.update(dict.fromkeys([*path, link], answer))
    return {link for link, answer in is_moved.items() if answer}


def _end(joint: Element, end: str) -> str:
    # Name of the parent or child link of a checked joint.
    [element] = joint.findall(end)
    return element.attrib['link']


def _naming_problems(kind: str, names: Sequence[str | None]) -> list[str]:
    problems = [f'a <{kind}> has no name' for name in names if not name]
    counts = Counter(name for name in names if name)
    problems += [
        f'{kind} {quoted(name)} is defined {count} times'
        for name, count in counts.items()
        if count > 1
    ]
    problems += [
        f'{kind} {quoted(name)}: its name has {len(name)} characters, at most '
        f'{MAX_NAME} are accepted'
        for name in counts
        if len(name) > MAX_NAME
    ]
    problems += [
        f'{kind} {quoted(name)}: its name has characters that cannot be printed'
        for name in counts
        if not name.isprintable()
    ]
    return problems


def _repetition_problems(element: Element) -> list[str]:
    # Parsers disagree on which duplicate wins.
    where = f'{element.tag} {quoted(element.get("name"))}'
    problems = []
    for owner, parent in (
        (where, element),
        *((f'{where}: <inertial>', inertial) for inertial in element.findall('inertial')),
    ):
        counts = Counter(part.tag for part in parent)
        problems += [
            f'{owner} has {count} <{tag}>, expected one'
            for tag, count in counts.items()
            if count > 1
        ]
    return problems


def _joint_problems(joint: Element, links: Collection[str | None]) -> list[str]:
    where = f'joint {quoted(joint.get("name"))}'
    problems = []
    kind = joint.get('type')
    if kind in UNSUPPORTED_TYPES:
        problems.append(
            f'{where}: type {kind} is not supported; use one of {", ".join(SUPPORTED_TYPES)}'
        )
    elif kind not in SUPPORTED_TYPES:
        problems.append(
            f'{where}: type {quoted(kind)} is unknown; use one of {", ".join(SUPPORTED_TYPES)}'
        )
    for end in ('parent', 'child'):
        element = joint.find(end)
        name = None if element is None else element.get('link')
        if name is None:
            problems.append(f'{where}: <{end} link="..."/> is missing')
        elif name not in links:
            problems.append(f'{where}: {end} link {quoted(name)} does not exist')
    return problems


def _tree_problems(links: Sequence[str | None], joints: Sequence[Element]) -> list[str]:
    parents = [
        (joint.get('name'), _end(joint, 'parent'), _end(joint, 'child')) for joint in joints
    ]
    problems = [
        f'link {quoted(name)} is the child of {count} joints, must be of one'
        for name, count in Counter(child for _, _, child in parents).items()
        if count > 1
    ]
    parent_of = {child: parent for _, parent, child in parents}
    roots = [name for name in links if name not in parent_of]
    if len(roots) > 1:
        problems.append(
            f'it has {len(roots)} root links, must be one: ' + ', '.join(map(quoted, roots))
        )
    cycle = _cycle(parent_of)
    if cycle:
        problems.append('its links form a cycle: ' + ' -> '.join(map(quoted, cycle)))
    return problems


def _mimic_problems(joints: Sequence[Element]) -> list[str]:
    movable = {joint.get('name') for joint in joints if joint.get('type') != 'fixed'}
    leader_of: dict[str, str] = {}
    problems = []
    for joint in joints:
        mimic = joint.find('mimic')
        if mimic is None or joint.get('type') == 'fixed':
            continue
        name, leader = joint.attrib['name'], mimic.get('joint')
        if leader is None or leader not in movable:
            problems.append(
                f'joint {quoted(name)}: mimics {quoted(leader)}, which is not a movable joint'
            )
        else:
            leader_of[name] = leader
    cycle = _cycle(leader_of)
    if cycle:
        problems.append('mimic joints form a cycle: ' + ' -> '.join(map(quoted, cycle)))
    return problems


def _cycle(next_of: dict[str, str]) -> list[str]:
    # The names along the first cycle, the first one repeated at the end, or [].
    done: set[str] = set()
    for start in next_of:
        path = []
        name = start
        while name in next_of and name not in done:
            done.add(name)
            path.append(name)
            name = next_of[name]
        if name in path:
            return [*path[path.index(name) :], name]
    return []
