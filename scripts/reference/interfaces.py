"""The .msg and .srv files: every field with its comment."""

from dataclasses import dataclass, field
import re

_FIELD = re.compile(r'^([A-Za-z][\w/\[\]<>=]*)\s+(\w+)\s*(?:=\s*(\S+)\s*)?(?:#\s*(.*))?$')


@dataclass
class Field:
    """A field or a constant (with `value`) of an interface, with its comment."""

    kind: str
    name: str
    words: str
    value: str | None = None


@dataclass
class Interface:
    """An interface file: its introduction, and its fields, a list for each part."""

    title: str
    introduction: list[str] = field(default_factory=list)
    parts: list[list[Field]] = field(default_factory=lambda: [[]])


def read(path):
    """
    Read an interface file.

    A comment belongs to a field if it is directly above it, behind it, or indented below it. A
    comment before the first blank line describes the whole interface.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Interface

    Raises
    ------
    ValueError
        If a line is neither a comment nor a field.

    """
    interface = Interface(path.stem)
    above: list[str] = []
    for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), start=1):
        fields = interface.parts[-1]
        if line.strip() == '---':
            interface.parts.append([])
        elif not line.strip():
            interface.introduction += above
            above = []
        elif line.startswith('#'):
            above.append(line.lstrip('# '))
        elif line.lstrip().startswith('#'):
            fields[-1].words += ' ' + line.lstrip('# ')
        elif match := _FIELD.match(line):
            kind, name, value, words = match.groups()
            fields.append(Field(kind, name, ' '.join([*above, *filter(None, [words])]), value))
            above = []
        else:
            raise ValueError(f'{path.name}, line {number}: expected a field, got {line!r}')
    return interface
