"""
Compiling in a process of its own: `python -m dynamics_node.codegen.worker`.

The process gets the robot on its standard input and leaves the machine code on disk. A thread
would not do: recording and compiling would stop the caller for tenths of a second, through
Python's lock, its garbage collector and the compiler's lock.

"""

import atexit
import contextlib
import io
import os
from pathlib import Path
import subprocess
import sys

import numpy as np

from . import compile, disk_cache

# Name of the machine code → the process that makes it, so that no robot is compiled twice.
_processes: dict = {}
# Robots that are compiled at the same time. Whoever publishes robot descriptions decides how many
# there are, and each process takes a core and some 60 MB for seconds.
_MOST_AT_ONCE = 2


def start(structure, numbers, any_inertia=False):
    """
    Start to make a robot's machine code, unless that is being done.

    The process runs on when this one ends, for some seconds.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    any_inertia : bool
        See `quantities`.

    Returns
    -------
    subprocess.Popen or None
        Its exit code is 0 if the machine code is on disk. None if enough others are being made:
        ask again later.

    Raises
    ------
    OSError
        If no process can be started.

    """
    name = disk_cache.key(structure, numbers, any_inertia)
    if name not in _processes:
        if sum(process.poll() is None for process in _processes.values()) >= _MOST_AT_ONCE:
            return None
        # It finds the same packages, is nobody's foreground, and gives way to everything else.
        # The same and no others: with -m alone, Python would look into the current folder first,
        # and a numpy.py that somebody left there would run.
        places = os.pathsep.join(place or str(Path.cwd()) for place in sys.path)
        environment = dict(os.environ, PYTHONPATH=places, PYTHONSAFEPATH='1')
        process = subprocess.Popen(
            [sys.executable, '-m', __name__],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
            start_new_session=True,
        )
        _processes[name] = process
        np.savez(
            buffer := io.BytesIO(), structure=structure, numbers=numbers, any_inertia=any_inertia
        )
        assert process.stdin is not None
        with contextlib.suppress(BrokenPipeError), process.stdin as stream:
            stream.write(buffer.getvalue())
    return _processes[name]


@atexit.register
def _let_go():
    # Python would complain of a process that still runs.
    for process in _processes.values():
        if process.poll() is None:
            process.returncode = 0


def main():
    """
    Make the machine code of the robot on standard input.

    Returns
    -------
    int
        0 if it is on disk, 1 if there is none.

    """
    with contextlib.suppress(OSError, AttributeError):
        os.nice(10)
    with np.load(io.BytesIO(sys.stdin.buffer.read())) as robot:
        packed = robot['structure'], robot['numbers'], bool(robot['any_inertia'])
    object_files = compile.compile_robot(*packed)
    if object_files is None:
        return 1
    return 0 if disk_cache.save(disk_cache.key(*packed), object_files) else 1


if __name__ == '__main__':
    sys.exit(main())
