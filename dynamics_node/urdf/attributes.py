"""Strict reading of the attributes that dynamics depends on, before any value is used."""

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
