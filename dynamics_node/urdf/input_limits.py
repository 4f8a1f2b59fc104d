"""Where the description comes from: a path or the text itself."""

import os
from pathlib import Path
import re
from xml.parsers import expat

from ..errors import quoted, RobotDescriptionError


def load_text(source):
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
        raise RobotDescriptionError([f'expected URDF text or a path, got {type(source).__name__}'])
    if not source.strip():
        raise RobotDescriptionError(['it is empty: expected URDF text or a path'])
    if '<' in source or '\n' in source:
        return source.encode('utf-8', errors='surrogatepass')
    return _read(Path(source))


def _read(path):
    try:
        return path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or error
        # A launch file's folder is seldom the one that its user thinks of.
        where = '' if path.is_absolute() else f' (looked in {Path.cwd()}; give an absolute path)'
        raise RobotDescriptionError([f"cannot read '{path}': {reason}{where}"]) from error


MAX_BYTES = 5_000_000
MAX_LINKS = 1_000
# So many '<' and '=': three times what 1000 links of the most elaborate public robots have.
MAX_TAGS = 200_000
MAX_ATTRIBUTES = 100_000
MAX_DEPTH = 32


class _RefusedError(Exception):
    """Stops the scan at the first thing that is refused."""


def check_text(text):
    """
    Refuse a description that is dangerous or hopeless to parse.

    Reads the text once as a stream, without building anything and without following
    a reference of any kind.

    Parameters
    ----------
    text : bytes
        URDF text.

    Raises
    ------
    RobotDescriptionError
        If it is not UTF-8, not XML (with the parser's line), has a document type or an entity
        definition, or exceeds 5 MB, 200 000 tags, 100 000 attributes, 1000 links or joints,
        or 32 levels.

    """
    if len(text) > MAX_BYTES:
        _refuse(f'it has {len(text)} bytes, at most {MAX_BYTES} are accepted')
    for what, sign, most in (('tags', b'<', MAX_TAGS), ('attributes', b'=', MAX_ATTRIBUTES)):
        if text.count(sign) > most:
            _refuse(f'it has {text.count(sign)} {what}, at most {most} are accepted')
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
    try:
        _Scan().run(text)
    except _RefusedError as error:
        _refuse(str(error))
    except expat.ExpatError as error:
        _refuse(
            f'it is not XML: {expat.ErrorString(error.code)}, '
            f'line {error.lineno}, column {error.offset}'
        )


class _Scan:
    """Counts depth, links and joints while the stream passes."""

    def __init__(self):
        self.depth = 0
        self.counts = {'link': 0, 'joint': 0}

    def run(self, text):
        parser = expat.ParserCreate(encoding='utf-8')
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.StartDoctypeDeclHandler = self._doctype
        parser.Parse(text, True)

    def _start(self, tag, attributes):
        self.depth += 1
        if self.depth == 1 and tag != 'robot':
            raise _RefusedError(
                f'its root element is <{quoted(tag)[1:-1]}>, expected <robot>; '
                'a xacro file must be expanded first'
            )
        if self.depth > MAX_DEPTH:
            raise _RefusedError(f'its elements are nested more than {MAX_DEPTH} deep')
        if self.depth == 2 and tag in self.counts:
            self.counts[tag] += 1
            if self.counts[tag] > MAX_LINKS:
                raise _RefusedError(f'it has more than {MAX_LINKS} {tag}s')

    def _end(self, tag):
        self.depth -= 1

    def _doctype(self, *_):
        raise _RefusedError('it has a DOCTYPE, which is not accepted: remove it')


def _refuse(problem):
    raise RobotDescriptionError([problem])
