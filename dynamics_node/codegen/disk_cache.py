"""
Machine code on disk, named by a hash of its sources.

One file per robot in DYNAMICS_NODE_CACHE_DIR, by default `dynamics_node` in XDG_CACHE_HOME or
`~/.cache`. A file that is damaged or misplaced, or that another user may have written, counts as
missing.

"""

import contextlib
import hashlib
import os
from pathlib import Path
import re
import stat
import tempfile

import numpy as np

from . import llvm_target, trace
from ..kernels.packing import PackedModel

_MAGIC = b'dynamics_node machine code 2\n'
# Number of files kept, some 30 MB; those unused for longest are removed.
_MAX_FILES = 100
# Form of the names that `key` returns.
_NAME = re.compile('[0-9a-f]{64}')


def _read_sources() -> bytes:
    # The formulas and the code generator.
    here = Path(__file__).parent
    files = sorted([*here.glob('*.py'), here.parent / 'kernels' / 'recursive.py'])
    return b''.join(path.read_bytes() for path in files)


# Read when this module is imported: if the package is replaced under a running process, code of
# the old sources must not get the name of the new ones.
_SOURCES = hashlib.sha256(_read_sources())


def folder() -> Path:
    """
    Return the folder of the machine code.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    RuntimeError
        If neither variable is set and the user has no home.

    """
    own = os.environ.get('DYNAMICS_NODE_CACHE_DIR')
    if own:
        return Path(own)
    base = os.environ.get('XDG_CACHE_HOME')
    return (Path(base) if base else Path.home() / '.cache') / 'dynamics_node'


def key(packed: PackedModel) -> str:
    """
    Return the name of a robot's machine code.

    Parameters
    ----------
    packed : PackedModel
        The numbers that are inputs of the programs are left out of the hash.

    Returns
    -------
    str
        Hexadecimal digits: a hash of robot, formulas, compiler and processor.

    """
    digest = _SOURCES.copy()
    digest.update(llvm_target.description().encode())
    digest.update(repr(packed.structure.shape).encode())
    digest.update(packed.structure.tobytes())
    constants = np.array(packed.numbers)
    for place in trace.input_places(packed):
        constants[place] = 0.0
    digest.update(repr(packed.payload_variant).encode())
    digest.update(constants.tobytes())
    return digest.hexdigest()


def load(name: str) -> bytes | None:
    """
    Return a robot's machine code, if its file exists and can be trusted.

    Parameters
    ----------
    name : str
        Returned by `key`.

    Returns
    -------
    bytes or None

    """
    try:
        place = folder()
        if not _is_our_folder(place):
            return None
        # Neither follow a link nor wait for a pipe.
        file = os.open(place / name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with os.fdopen(file, 'rb') as stream:
            status = os.fstat(file)
            if not stat.S_ISREG(status.st_mode) or not _is_ours(status):
                return None
            content = stream.read()
            os.utime(file)
    except (OSError, RuntimeError):
        return None
    size = len(_head(name, b''))
    head, code = content[:size], content[size:]
    return code if head == _head(name, code) else None


def _head(name: str, code: bytes) -> bytes:
    return _MAGIC + hashlib.sha256(name.encode() + code).digest()


def _is_our_folder(place: Path) -> bool:
    # A link set by another user could lead to any other folder of this user.
    return place.lstat().st_uid in (os.getuid(), 0) and _is_ours(place.stat())


def _is_ours(status: os.stat_result) -> bool:
    others_write = stat.S_IWGRP | stat.S_IWOTH
    return status.st_uid == os.getuid() and not status.st_mode & others_write


def save(name: str, code: bytes) -> bool:
    """
    Keep a robot's machine code, if the folder can be written and is private.

    Parameters
    ----------
    name : str
        Returned by `key`.
    code : bytes

    Returns
    -------
    bool
        Whether it was kept.

    """
    try:
        place = folder()
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_our_folder(place):
            return False  # `load` would ignore the file, and its other files must not be removed
        _remove_oldest(place)
        with tempfile.NamedTemporaryFile(dir=place, prefix='new-', delete=False) as file:
            unfinished = Path(file.name)
            try:
                file.write(_head(name, code) + code)
                file.flush()
                # Atomic: another process may look for the file at the same time.
                unfinished.replace(place / name)
            except OSError:
                unfinished.unlink()
                raise
    except (OSError, RuntimeError):
        return False
    return True


def _remove_oldest(place: Path) -> None:
    # Only files with our form of name: the folder may hold other files too.
    ages = []
    for path in place.iterdir():
        if _NAME.fullmatch(path.name):
            with contextlib.suppress(OSError):  # another process has removed it
                ages.append((path.stat().st_mtime, path))
    for _, path in sorted(ages, reverse=True)[_MAX_FILES - 1 :]:
        with contextlib.suppress(OSError):
            path.unlink()
