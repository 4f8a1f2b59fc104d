"""From a path or a text to an XML tree, within limits that hold before memory is used."""

import os
from pathlib import Path
import re
from typing import NoReturn
from xml.etree import ElementTree
from xml.parsers import expat

from ..errors import quoted, RobotDescriptionError

# A path, or the URDF text itself.
Source = str | bytes | os.PathLike[str]

# Largest text, bytes.
MAX_BYTES = 5_000_000
# Largest number of links, and of joints.
MAX_LINKS = 1_000
# Largest number of '<': three times that of 1000 links of the most elaborate public robots.
MAX_TAGS = 200_000
# Largest number of '=', by the same measure.
MAX_ATTRIBUTES = 100_000
# Largest depth of nested elements.
MAX_DEPTH = 32


def load_text(source: Source) -> bytes:
    """
    Return the URDF text of a path or of a text.

    Parameters
    ----------
    source : str, bytes or os.PathLike
        A path, or the description itself: a string that contains '<' or a line break.

    Returns
    -------
    bytes
        UTF-8 text.

    Raises
    ------
    RobotDescriptionError
        If it is empty, or a path that cannot be read.

    """
    if isinstance(source, bytes):
        return source
    if isinstance(source, os.PathLike):
        return _read(Path(source))
    if not isinstance(source, str):
        _refuse(f'expected URDF text or a path, got {type(source).__name__}')
    if not source.strip():
        _refuse('it is empty: expected URDF text or a path')
    if '<' in source or '\n' in source:
        return source.encode('utf-8', errors='surrogatepass')
    return _read(Path(source))


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or error
        # A launch file often runs in another folder than its user expects.
        where = '' if path.is_absolute() else f' (looked in {Path.cwd()}; give an absolute path)'
        raise RobotDescriptionError([f"cannot read '{path}': {reason}{where}"]) from error


def check_text(text: bytes) -> None:
    """
    Refuse a text that is too large to parse, or not UTF-8.

    Parameters
    ----------
    text : bytes
        URDF text.

    Raises
    ------
    RobotDescriptionError
        If it is empty, not UTF-8, declares another encoding, or exceeds 5 MB, 200 000 tags or
        100 000 attributes.

    """
    if len(text) > MAX_BYTES:
        _refuse(f'it has {len(text)} bytes, at most {MAX_BYTES} are accepted')
    for counted, sign, limit in (('tags', b'<', MAX_TAGS), ('attributes', b'=', MAX_ATTRIBUTES)):
        if text.count(sign) > limit:
            _refuse(f'it has {text.count(sign)} {counted}, at most {limit} are accepted')
    if not text.strip():
        _refuse('it is empty: expected URDF text')
    try:
        text.decode('utf-8')
    except UnicodeDecodeError as error:
        _refuse(f'it is not UTF-8 text: byte {error.start}: {error.reason}')
    declared = re.match(rb'\s*<\?xml[^>]*encoding\s*=\s*["\']([^"\']+)', text)
    if declared and declared[1].lower() not in (b'utf-8', b'us-ascii', b'ascii'):
        _refuse(
            f'its encoding is {quoted(declared[1].decode())}, expected UTF-8: save it as UTF-8'
        )


def parse(text: bytes) -> ElementTree.Element:
    """
    Parse a checked text; stop where it is refused.

    Follows no reference of any kind. Without name spaces, as urdfdom reads it: public URDFs have
    attributes and elements with undeclared prefixes (drake:acceleration), which dynamics does
    not use.

    Parameters
    ----------
    text : bytes
        URDF text that `check_text` accepts.

    Returns
    -------
    xml.etree.ElementTree.Element
        The <robot> element.

    Raises
    ------
    RobotDescriptionError
        If it is not XML (with the parser's line), has another root element than <robot>, a
        document type, more than 1000 links or joints, or more than 32 levels.

    """
    try:
        return _LimitedTree().parse(text)
    except expat.ExpatError as error:
        _refuse(
            f'it is not XML: {expat.ErrorString(error.code)}, '
            f'line {error.lineno}, column {error.offset}'
        )


class _LimitedTree:
    """Builds the tree; counts depth, links and joints before each element is added."""

    def __init__(self) -> None:
        self._builder = ElementTree.TreeBuilder()
        self._depth = 0
        self._counts = {'link': 0, 'joint': 0}

    def parse(self, text: bytes) -> ElementTree.Element:
        # A declared encoding behind a byte order mark is ignored: `check_text` requires UTF-8.
        parser = expat.ParserCreate(encoding='utf-8')
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._builder.data  # the names of hardware plugins
        parser.StartDoctypeDeclHandler = self._doctype
        parser.Parse(text, True)
        return self._builder.close()

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth == 1 and tag != 'robot':
            _refuse(
                f'its root element is <{quoted(tag)[1:-1]}>, expected <robot>; '
                'a xacro file must be expanded first'
            )
        if self._depth > MAX_DEPTH:
            _refuse(f'its elements are nested more than {MAX_DEPTH} deep')
        if self._depth == 2 and tag in self._counts:
            self._counts[tag] += 1
            if self._counts[tag] > MAX_LINKS:
                _refuse(f'it has more than {MAX_LINKS} {tag}s')
        self._builder.start(tag, attributes)

    def _end(self, tag: str) -> None:
        self._depth -= 1
        self._builder.end(tag)

    def _doctype(self, *_: object) -> NoReturn:
        _refuse('it has a DOCTYPE, which is not accepted: remove it')


def _refuse(problem: str) -> NoReturn:
    raise RobotDescriptionError([problem])
