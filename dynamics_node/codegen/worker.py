"""
Compilation in a separate process: `python -m dynamics_node.codegen.worker`.

The process gets the robot on its standard input and leaves the machine code on disk. A thread
would stop its caller for tenths of a second, because recording and compiling hold Python's lock
and the compiler's lock, and trigger the garbage collector.

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
from ..kernels.packing import PackedModel

# Cache key → the process that compiles it, so that no robot is compiled twice.
_processes: dict[str, subprocess.Popen[bytes]] = {}
# Compilers that run at the same time. The publishers of robot descriptions determine how many
# robots there are, and each process takes a core and some 60 MB for seconds.
_MAX_PROCESSES = 2


def start(packed: PackedModel) -> subprocess.Popen[bytes] | None:
    """
    Start to compile a robot's machine code, unless a process does so already.

    The process continues when this one ends, for some seconds.

    Parameters
    ----------
    packed : PackedModel

    Returns
    -------
    subprocess.Popen or None
        Its exit code is 0 if the machine code is on disk. None if the maximum number of compilers
        is running: ask again later.

    Raises
    ------
    OSError
        If no process can be started.

    """
    name = disk_cache.key(packed)
    if name not in _processes:
        if sum(process.poll() is None for process in _processes.values()) >= _MAX_PROCESSES:
            return None
        # The child finds the same packages, and no others: with -m alone, Python would search the
        # current folder first and run a numpy.py that lies there. It has a session of its own, so
        # Ctrl-C in the terminal does not reach it.
        search_path = os.pathsep.join(place or str(Path.cwd()) for place in sys.path)
        environment = dict(os.environ, PYTHONPATH=search_path, PYTHONSAFEPATH='1')
        process = subprocess.Popen(
            [sys.executable, '-m', __name__],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
            start_new_session=True,
        )
        _processes[name] = process
        assert process.stdin is not None
        with contextlib.suppress(BrokenPipeError), process.stdin as stream:
            stream.write(_to_bytes(packed))
    return _processes[name]


def _to_bytes(packed: PackedModel) -> bytes:
    buffer = io.BytesIO()
    np.savez(
        buffer,
        structure=packed.structure,
        numbers=packed.numbers,
        payload_variant=np.array(packed.payload_variant),
    )
    return buffer.getvalue()


def _from_bytes(content: bytes) -> PackedModel:
    with np.load(io.BytesIO(content)) as arrays:
        return PackedModel(arrays['structure'], arrays['numbers'], bool(arrays['payload_variant']))


@atexit.register
def _abandon_processes() -> None:
    # Python would warn of a process that still runs.
    for process in _processes.values():
        if process.poll() is None:
            process.returncode = 0


def main() -> int:
    """
    Compile the machine code of the robot on standard input.

    Returns
    -------
    int
        Exit code: 0 if the machine code is on disk, 1 otherwise.

    """
    with contextlib.suppress(OSError, AttributeError):
        os.nice(10)
    packed = _from_bytes(sys.stdin.buffer.read())
    object_files = compile.compile_robot(packed)
    if object_files is None:
        return 1
    return 0 if disk_cache.save(disk_cache.key(packed), object_files) else 1


if __name__ == '__main__':
    sys.exit(main())
