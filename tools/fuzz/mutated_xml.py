"""XML with broken attributes, numbers, names, elements and text."""

from contextlib import suppress
import re
from xml.etree import ElementTree

_TAGS = (
    'robot',
    'link',
    'joint',
    'inertial',
    'mass',
    'inertia',
    'origin',
    'axis',
    'limit',
    'dynamics',
    'mimic',
    'parent',
    'child',
    'visual',
    'geometry',
    'mesh',
    'gazebo',
    'x',
    'xacro:include',
    'Link',
    'drake:link',
    'drake:x:y',
)
_ATTRIBUTES = (
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
    'filename',
    'xml:id',
    'xml:base',
    'xml:space',
    'xmlns',
    'drake:effort',
    'drake:x',
    'xmlns:xacro',
)
_NUMBERS = (
    'nan',
    'inf',
    '-inf',
    '1e999',
    '-1e999',
    '1e308',
    '-1e308',
    '1e200',
    '1e100',
    '1e31',
    '1e30',
    '-1e30',
    '1e16',
    '1e-320',
    '1e-30',
    '-0',
    '0',
    '-1',
    '1_0',
    '0x1',
    '1,5',
    '+1',
    '1e',
    '.',
    '--1',
    '1e+',
    '\u0661',
    '\uff11',
    '\u00b2',
    '\u30001',
    '1\xa0',
    '\x851',
    '9' * 400,
    '1' * 50_000 + 'x',
    '0.' + '0' * 5_000 + '1',
    '1.' * 20_000,
)
_TEXTS = (
    '',
    ' ',
    '0 0 0',
    '1 2 3',
    '1 2',
    '1 2 3 4',
    '1e30 1e30 1e30',
    '1e-200 0 0',
    'nan 0 0',
    'revolute',
    'continuous',
    'prismatic',
    'fixed',
    'floating',
    'planar',
    'base',
    'arm',
    'shoulder',
    'slide',
    '${x}',
    'package://a/b.stl',
    'file:///etc/passwd',
    '../../x',
    "'",
    'http://localhost:1/a',
    '\n[FATAL] a',
    '\u202e',
    '\ufeff',
    '\U0001f916',
    'x' * 3_000,
    'a b',
    'None',
    '\x7f',
    '\x85',
    '<',
    '&',
    '"',
)
_SNIPPETS = (
    '<!DOCTYPE robot>',
    '<!DOCTYPE robot SYSTEM "file:///etc/passwd">',
    '<!DOCTYPE r [<!ENTITY a "b"><!ENTITY c "&a;&a;">]>',
    '<!DOCTYPE r [<!ENTITY a SYSTEM "http://localhost:1/a">]>',
    '<!ENTITY a "b">',
    '&a;',
    '&lt;',
    '&#0;',
    '&#10;',
    '&#xD800;',
    '&#x110000;',
    '&#x1F916;',
    '<![CDATA[<link/>]]>',
    '<![CDATA[',
    ']]>',
    '<?xml version="1.0"?>',
    '<?xml version="1.1"?>',
    '<?a b?>',
    '<?xml-stylesheet a="b"?>',
    '<!-- a -->',
    '<!-- -- -->',
    '<!--',
    'xmlns="a"',
    ' xmlns:a="b" ',
    ' xmlns:a="" ',
    ' a:b="c" ',
    '<a:b xmlns:a="c d"/>',
    '<xi:include href="file:///etc/passwd"/>',
    '<xacro:include/>',
    '<a>' * 40,
    '<link name="a"/>',
    '<link/>',
    '<joint/>',
    '<inertial/>',
    '<joint name="j" type="fixed"/>',
    '</link>',
    '</robot>',
    '<robot name="b">',
    '<',
    '>',
    '"',
    '=',
    '\x00',
    '\x0b',
    '\ufeff',
    '\ufffe',
    '\ud800',
    '  ',
    '\r\n',
    'a',
    '<' + 'a' * 2_000 + '/>',
    '<a ' + 'b ' * 500 + '/>',
)

# Near the size limits, or beyond; rare, because they are slow.
_LARGE = (
    '<a>' * 50_000,
    '<x/>' * 190_000,
    '<x a="b"/>' * 95_000,
    '<!-- -->' * 190_000,
    '&lt;' * 1_200_000,
    '<link name="a"/>' * 2_000,
    ' ' * 5_000_000,
)


def changed_tree(rngs, text):
    """Return the text of a robot after one change of its elements per random generator."""
    robot = ElementTree.fromstring(text.encode())
    for rng in rngs:
        parents = [(parent, child) for parent in robot.iter() for child in parent]
        if parents:
            rng.choice(_WAYS)(rng, *rng.choice(parents), parents)
    return ElementTree.tostring(robot, encoding='unicode')


def changed_text(rng, text):
    """Return a text with a snippet between or inside its tags."""
    ends = [match.end() for match in re.finditer('[<>" ]', text)]
    at = rng.choice(ends) if ends and rng.random() < 0.7 else rng.randint(0, len(text))
    snippets = _LARGE if rng.random() < 0.03 else _SNIPPETS
    return text[:at] + rng.choice(snippets) + text[at:]


def grown_text(rng):
    """Return meaningless XML of URDF's tags and attributes."""
    robot = _grown(rng, 'robot', 4)
    return ElementTree.tostring(robot, encoding='unicode')


def _grown(rng, tag, depth):
    attributes = {rng.choice(_ATTRIBUTES): _value(rng) for _ in range(rng.randrange(5))}
    return _element(
        tag,
        attributes,
        [
            _grown(rng, rng.choice(_TAGS), depth - 1)
            for _ in range(rng.randrange(6) if depth else 0)
        ],
    )


def _value(rng):
    way = rng.random()
    if way < 0.45:
        return rng.choice(_NUMBERS)
    if way < 0.7:
        return rng.choice(_TEXTS)
    if way < 0.8:
        return ' '.join(rng.choice(_NUMBERS) for _ in range(rng.randrange(5)))
    if way < 0.9:
        return f'{rng.gauss(0.0, 1.0) * 10.0 ** rng.randint(-20, 20):.{rng.randint(1, 17)}g}'
    return ''.join(
        chr(rng.choice((rng.randint(32, 126), rng.randint(160, 0xD7FF))))
        for _ in range(rng.randint(1, 5))
    )


def _element(tag, attributes, parts):
    element = ElementTree.Element(tag, attributes)
    element.extend(parts)
    return element


def _set(rng, parent, child, _):
    names = list(child.attrib) if child.attrib and rng.random() < 0.7 else _ATTRIBUTES
    child.set(rng.choice(names), _value(rng))


def _with_numbers(parents):
    return [
        (each, name)
        for _, each in parents
        for name, text in each.attrib.items()
        if text[:1] and text[0] in '-.0123456789'
    ]


def _set_one_number(rng, parent, child, parents):
    with_numbers = _with_numbers(parents)
    if with_numbers:
        element, name = rng.choice(with_numbers)
        parts = element.get(name).split() or ['']
        parts[rng.randrange(len(parts))] = rng.choice(_NUMBERS)
        element.set(name, ' '.join(parts))


def _scale(rng, parent, child, parents):
    # Far too large, far too small or negative, but numbers.
    with_numbers = _with_numbers(parents)
    if with_numbers:
        element, name = rng.choice(with_numbers)
        factor = rng.choice((-1.0, 0.0, 10.0 ** rng.randint(-40, 40)))
        with suppress(ValueError):
            element.set(
                name, ' '.join(repr(float(part) * factor) for part in element.get(name).split())
            )


def _unset(rng, parent, child, parents):
    with_attributes = [each for _, each in parents if each.attrib]
    if with_attributes:
        child = rng.choice(with_attributes)
        del child.attrib[rng.choice(list(child.attrib))]


def _swap(rng, parent, child, parents):
    name = rng.choice(('link', 'link', 'name', 'joint', 'type', 'value', 'xyz'))
    with_name = [each for _, each in parents if name in each.attrib]
    if len(with_name) > 1:
        one, other = rng.sample(with_name, 2)
        one.attrib[name], other.attrib[name] = other.attrib[name], one.attrib[name]


def _remove(rng, parent, child, _):
    parent.remove(child)


def _double(rng, parent, child, _):
    at = rng.randint(0, len(parent))
    count = rng.choice((1, 1, 1, 1, 1, 2, 3, 50, 50)) if rng.random() < 0.97 else 1_200
    # The same object many times: later changes apply to all copies.
    parent[at:at] = [child] * count


def _move(rng, parent, child, parents):
    target, _ = rng.choice(parents)
    # Not into itself or its descendants.
    if all(target is not inner for inner in child.iter()):
        parent.remove(child)
        target.append(child)


def _rename(rng, parent, child, _):
    child.tag = rng.choice(_TAGS)


def _wrap(rng, parent, child, _):
    parent.remove(child)
    tag = rng.choice(_TAGS)
    for _ in range(rng.choice((1, 2, 28, 40, 300))):
        child = _element(tag, {}, [child])
    parent.append(child)


def _set_text(rng, parent, child, _):
    child.text = _value(rng)


_WAYS = (
    _set,
    _set,
    _set_one_number,
    _set_one_number,
    _set_one_number,
    _scale,
    _scale,
    _unset,
    _swap,
    _swap,
    _remove,
    _double,
    _move,
    _rename,
    _wrap,
    _set_text,
)
