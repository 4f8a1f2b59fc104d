"""
Machine code on disk, found by what it was made from.

One file per robot in `~/.cache/dynamics_node` (or where DYNAMICS_NODE_CACHE_DIR or XDG_CACHE_HOME
say). A file that is damaged, or that somebody else may have written, counts as missing.

"""

import functools
import hashlib
import os
from pathlib import Path
import stat
import tempfile

from . import machine

_MAGIC = b'dynamics_node machine code 1\n'


def folder():
    """Return where the machine code is kept."""
    own = os.environ.get('DYNAMICS_NODE_CACHE_DIR')
    if own:
        return Path(own)
    base = os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache'
    return Path(base) / 'dynamics_node'


@functools.cache
def _sources():
    # The formulas and all that turns them into machine code.
    here = Path(__file__).parent
    above = [here.parent / 'closed_form.py', here.parent / 'packing.py']
    files = sorted([*here.glob('*.py'), *above])
    return b''.join(path.read_bytes() for path in files)


def key(structure, numbers):
    """
    Return the name of a robot's machine code.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`; gravity does not matter.

    Returns
    -------
    str
        Hexadecimal digits: a hash of robot, formulas, compiler and processor.

    """
    digest = hashlib.sha256(_sources())
    digest.update(machine.description().encode())
    digest.update(repr(structure.shape).encode())
    digest.update(structure.tobytes())
    digest.update(numbers[:-1].tobytes())
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
    path = folder() / name
    try:
        with path.open('rb') as file:
            if not _is_ours(os.fstat(file.fileno())):
                return None
            content = file.read()
    except OSError:
        return None
    head, code = content[:len(_MAGIC) + 32], content[len(_MAGIC) + 32:]
    return code if head == _MAGIC + hashlib.sha256(code).digest() else None


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
        Whether it was kept; where the folder cannot be written, each process compiles anew.

    """
    try:
        folder().mkdir(mode=0o700, parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder(), delete=False) as file:
            file.write(_MAGIC + hashlib.sha256(code).digest() + code)
        # Complete or not there: other processes may look for it at the same time.
        Path(file.name).replace(folder() / name)
    except OSError:
        return False
    return True
