"""docs/api.md as text."""

import enum
import inspect
from pathlib import Path
import re

from . import docstring, members, signature

PATH = Path(__file__).resolve().parents[2] / 'docs' / 'api.md'

HEAD = """# The library

Written by `scripts/write_api.py` from the public names and their docstrings; do not edit by hand.

The library needs no ROS: `pip install .`, then `from dynamics_node import RobotModel`. Every
package below works without ROS, too.

Units are SI: rad, rad/s and N m for revolute joints, m, m/s and N for prismatic ones. n is the
number of joints, in the order of `RobotModel.joint_names`. `...` in a shape stands for leading
batch axes: q of shape (N, n) gives a mass matrix of shape (N, n, n). Equation numbers refer to
[the mathematics](mathematics.md). Every error that the package raises on purpose is a
[DynamicsError](#dynamicserror)."""


def render():
    """
    Return the page.

    Returns
    -------
    str
        Markdown.

    """
    groups = [(members.LIBRARY, '', members.library_names())]
    groups += [
        (f'{members.LIBRARY}.{folder}', words, members.package_names(folder))
        for folder, words in members.PACKAGES.items()
    ]
    parts = [HEAD, *(_contents(package, names) for package, _, names in groups)]
    for package, words, names in groups:
        parts += [f'## {package}', words, *(_entry(name) for name in names)]
    return '\n\n'.join(part for part in parts if part) + '\n'


def _contents(package, names):
    links = ' · '.join(f'[{name.name}]({_anchor(name.name)})' for name in names)
    return f'**[{package}]({_anchor(package)})**: {links}'


def _anchor(heading):
    return '#' + re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-')


def _entry(entry):
    """Return the section of a class, function or constant."""
    if inspect.isclass(entry.value):
        return _class(entry)
    if callable(entry.value):
        return _function(f'### {entry.name}', entry.name, entry.value)
    return f'### {entry.name}\n\n`{entry.name} = {entry.value!r}`'


def _class(entry):
    kind = entry.value
    bases = [base.__name__ for base in kind.__bases__ if base not in (object, tuple)]
    properties, methods = members.public_members(kind)
    parts = [
        f'### {entry.name}',
        _code(f'class {signature.constructor(kind)}'),
        f'Bases: `{"`, `".join(bases)}`.' if bases else '',
        docstring.to_markdown(kind.__doc__),
        _constructor(kind),
        _members(kind),
        _properties(properties),
        *(_method(entry.name, name, value) for name, value in methods.items()),
    ]
    return '\n\n'.join(part for part in parts if part)


def _constructor(kind):
    """Return the docstring of a constructor that has its own."""
    own = vars(kind).get('__init__')
    if not inspect.isfunction(own) or not own.__doc__:
        return ''
    return f'**Constructor.** {docstring.to_markdown(own.__doc__)}'


def _members(kind):
    if not issubclass(kind, enum.Enum):
        return ''
    return '\n'.join(f'- `{member.name}` = {member.value!r}' for member in kind)


def _properties(properties):
    if not properties:
        return ''
    kinds = {
        name: signature.annotation(getattr(value, 'fget', None) or value.func)
        for name, value in properties.items()
    }
    has_kinds = any(kinds.values())
    rows = []
    for name, value in properties.items():
        kind = [f'`{kinds[name]}`'] if has_kinds else []
        rows.append([f'`{name}`', *kind, docstring.summary(value.__doc__)])
    head = ['property', *(['type'] if has_kinds else []), 'meaning']
    return _table([head, ['---'] * len(head), *rows])


def _table(rows):
    return '\n'.join(
        '| ' + ' | '.join(cell.replace('|', r'\|') for cell in row) + ' |' for row in rows
    )


def _method(owner, name, value):
    is_bound = isinstance(value, classmethod | staticmethod)  # called on the class itself
    return _function(
        f'#### {owner}.{name}',
        f'{owner}.{name}' if is_bound else name,
        value.__func__ if is_bound else value,
        is_method=not isinstance(value, staticmethod),
    )


def _function(heading, title, function, is_method=False):
    return '\n\n'.join(
        [
            heading,
            _code(signature.call(title, function, is_method)),
            docstring.to_markdown(function.__doc__),
        ]
    )


def _code(text):
    # Not `python`: blocks in that language are run by a test.
    return f'```py\n{text}\n```'
