"""Strict reading of the attributes that dynamics depends on, before any value is used."""

from collections import Counter
import math
import re

from ..errors import quoted

# What URDF writes as a number: no 'nan', no 'inf', no '1_0', no hexadecimal. No two repetitions
# that could share the same digits: a long text would be tried in every division.
_NUMBER = re.compile(r'[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?')
# XML's blanks; Python knows others.
_BLANKS = ' \t\r\n'

# No robot has larger numbers, and products of a few of them are still finite.
LARGEST = 1e30

# What a limit may be instead, and then counts as none.
_UNLIMITED = re.compile(r'[+-]?(inf|infinity|nan|1e999)|', re.IGNORECASE)

_INERTIA = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')

# Element → (attribute, how many numbers, required). The effort and velocity limits may also
# be missing, 0 or infinite: a URDF without them still has dynamics.
_LINK_NUMBERS = {
    'inertial/origin': [('xyz', 3, False), ('rpy', 3, False)],
    'inertial/mass': [('value', 1, True)],
    'inertial/inertia': [(name, 1, True) for name in _INERTIA],
}
_JOINT_NUMBERS = {
    'origin': [('xyz', 3, False), ('rpy', 3, False)],
    'axis': [('xyz', 3, True)],
    'limit': [('lower', 1, False), ('upper', 1, False)],
    'dynamics': [('damping', 1, False), ('friction', 1, False)],
    'mimic': [('multiplier', 1, False), ('offset', 1, False)],
}
_INERTIAL_PARTS = ('inertial/mass', 'inertial/inertia')
# A position limit that large is how others write none; an axis has its own bounds.
_MAY_BE_LARGER = {'limit', 'axis'}


def is_number(text):
    """
    Tell whether a text is a finite decimal number as URDF writes it.

    Parameters
    ----------
    text : str
        One attribute's value; blanks around it do not matter.

    Returns
    -------
    bool
        False for 'nan', 'inf', '1_0', '0x1', '1e999' and the like.

    """
    return bool(_NUMBER.fullmatch(text.strip(_BLANKS))) and math.isfinite(float(text))


def number_problems(robot):
    """
    List every attribute that is missing or is not the numbers it should be.

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


def _soft_limits(joint, where):
    limit = joint.find('limit')
    given = {} if limit is None else limit.attrib
    return [
        f'{where}: <limit> {name}: expected a number, got {_shown(given[name])}'
        for name in ('effort', 'velocity')
        if name in given
        and not is_number(given[name])
        and not _UNLIMITED.fullmatch(given[name].strip(_BLANKS))
    ]


def _in_element(parent, where, table):
    problems = []
    for path, attributes in table.items():
        element = parent.find(path)
        if element is None:
            continue
        for name, count, required in attributes:
            problems += _in_attribute(
                element, f'{where}: <{element.tag}> {name}', name, count, required
            )
    return problems


def _in_attribute(element, where, name, count, required):
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
    return [f'{where}: expected {expected}, got {_shown(text)}']


def _shown(text):
    # The beginning of what xacro computes or replaces.
    is_xacro = '${' in text or '$(' in text
    return quoted(text) + ('; a xacro file must be expanded first' if is_xacro else '')


SUPPORTED_TYPES = ('revolute', 'continuous', 'prismatic', 'fixed')
UNSUPPORTED_TYPES = ('floating', 'planar')
# Names stand in every message and log.
MAX_NAME = 255


def structure_problems(robot):
    """
    List everything that keeps the links and joints from being one tree.

    Parameters
    ----------
    robot : xml.etree.ElementTree.Element
        The <robot> element, with nothing in it but what dynamics reads.

    Returns
    -------
    list of str
        One sentence per problem; empty means that nothing is said twice, exactly one root, no
        cycle, known names that can be printed, joint types that are supported, and mimic chains
        that end at a movable joint.

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


def part_problems(element):
    """Return what is wrong with one <link> or <joint> by itself, whatever else there is."""
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


def root_link(robot):
    """Return the name of the link that is no joint's child; the structure must be sound."""
    children = {joint.find('child').get('link') for joint in robot.findall('joint')}
    return next(
        link.get('name') for link in robot.findall('link') if link.get('name') not in children
    )


def moved_links(robot):
    """Return the set of links that any movable joint carries; the structure must be sound."""
    joint_of = {joint.find('child').get('link'): joint for joint in robot.findall('joint')}
    is_moved: dict[str, bool] = {}
    for name in joint_of:
        # Up to a joint that moves, to a link whose answer is known, or to the root.
        path, link = [], name
        while link in joint_of and link not in is_moved and joint_of[link].get('type') == 'fixed':
            path.append(link)
            link = joint_of[link].find('parent').get('link')
        answer = is_moved.get(link, link in joint_of)
        is_moved.update(dict.fromkeys([*path, link], answer))
    return {link for link, answer in is_moved.items() if answer}


def _naming_problems(kind, names):
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


def _repetition_problems(element):
    # Of two, each parser may take another one.
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


def _joint_problems(joint, links):
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


def _tree_problems(links, joints):
    parents = [
        (joint.get('name'), joint.find('parent').get('link'), joint.find('child').get('link'))
        for joint in joints
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


def _mimic_problems(joints):
    movable = {joint.get('name') for joint in joints if joint.get('type') != 'fixed'}
    leader_of = {}
    problems = []
    for joint in joints:
        mimic = joint.find('mimic')
        if mimic is None or joint.get('type') == 'fixed':
            continue
        name, leader = joint.get('name'), mimic.get('joint')
        if leader not in movable:
            problems.append(
                f'joint {quoted(name)}: mimics {quoted(leader)}, which is not a movable joint'
            )
        else:
            leader_of[name] = leader
    cycle = _cycle(leader_of)
    if cycle:
        problems.append('mimic joints form a cycle: ' + ' -> '.join(map(quoted, cycle)))
    return problems


def _cycle(next_of):
    """Return the names along the first cycle, the first one repeated at the end, or []."""
    done = set()
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
