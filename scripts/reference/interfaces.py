"""The .msg and .srv files: every field with its comment."""

from dataclasses import dataclass, field
import re

_FIELD = re.compile(r'^([A-Za-z][\w/\[\]<>=]*)\s+(\w+)\s*(?:=\s*(\S+)\s*)?(?:#\s*(.*))?$')


@dataclass
class Field:
    """A field or a constant (with `value`) of an interface, and what its file says of it."""

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

    A comment above a field, with no blank line between, is that field's, as is one behind it
    and the indented comments that follow. A comment before the first blank line is about all.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Interface

    Raises
    ------
    ValueError
        If there is a line that is none of this, or a field without any comment.

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
