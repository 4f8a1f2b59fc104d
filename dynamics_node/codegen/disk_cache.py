"""
Machine code on disk, found by what it was made from.

One file per robot in `~/.cache/dynamics_node` (or where DYNAMICS_NODE_CACHE_DIR or XDG_CACHE_HOME
say). A file that is damaged or misplaced, or that somebody else may have written, counts as
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
# The files that were not used for longest go beyond this: some 30 MB.
_MOST_FILES = 100
# What `key` returns.
_NAME = re.compile('[0-9a-f]{64}')


def _read_sources():
    # The formulas and all that turns them into machine code.
    here = Path(__file__).parent
    files = sorted([*here.glob('*.py'), here.parent / 'kernels' / 'recursive.py'])
    return b''.join(path.read_bytes() for path in files)


# Read when they are imported: a package that is replaced under a running process must not file
# old code under the name of the new.
_SOURCES = hashlib.sha256(_read_sources())


def folder():
    """
    Return where the machine code is kept.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    RuntimeError
        If nothing says where: no variable, and no home.

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
        Numbers that are inputs of the programs do not matter.

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


def load(name):
    """
    Return a robot's machine code, if it is there.

    Parameters
    ----------
    name : str
        See `key`.

    Returns
    -------
    bytes or None

    """
    try:
        place = folder()
        if not _is_our_folder(place):
            return None
        # Neither a link to elsewhere nor a pipe that would never answer.
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


def _head(name, code):
    return _MAGIC + hashlib.sha256(name.encode() + code).digest()


def _is_our_folder(place):
    # A link that somebody else has set could lead to any other folder of ours.
    return place.lstat().st_uid in (os.getuid(), 0) and _is_ours(place.stat())


def _is_ours(status):
    others_write = stat.S_IWGRP | stat.S_IWOTH
    return status.st_uid == os.getuid() and not status.st_mode & others_write


def save(name, code):
    """
    Keep a robot's machine code, if there is a place for it.

    Parameters
    ----------
    name : str
        See `key`.
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
            return False  # it would not be loaded from there, and nothing there is ours to clear
        _clear(place)
        with tempfile.NamedTemporaryFile(dir=place, prefix='new-', delete=False) as file:
            unfinished = Path(file.name)
            try:
                file.write(_head(name, code) + code)
                file.flush()
                # Complete or not there: others may look for it at the same time.
                unfinished.replace(place / name)
            except OSError:
                unfinished.unlink()
                raise
    except (OSError, RuntimeError):
        return False
    return True


def _clear(place):
    # Only files of ours: the folder may be one that is used for other things too.
    ages = []
    for path in place.iterdir():
        if _NAME.fullmatch(path.name):
            with contextlib.suppress(OSError):  # gone already: another process clears too
                ages.append((path.stat().st_mtime, path))
    for _, path in sorted(ages, reverse=True)[_MOST_FILES - 1 :]:
        with contextlib.suppress(OSError):
            path.unlink()
