"""Where the description comes from: a path or the text itself."""

import os
from pathlib import Path

from ..errors import RobotDescriptionError


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
