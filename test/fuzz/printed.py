"""Where lines go that C code prints, past Python's own standard error."""

from contextlib import contextmanager
import os

NOWHERE = os.open(os.devnull, os.O_WRONLY)
_STDERR = 2
_usual = os.dup(_STDERR)
_seen = os.memfd_create('printed')


class PrintedError(Exception):
    """Something was printed that nobody throttles."""


@contextmanager
def stderr_to(file):
    """Send what is printed inside to another file descriptor."""
    os.dup2(file, _STDERR)
    try:
        yield
    finally:
        os.dup2(_usual, _STDERR)


@contextmanager
def nothing_printed():
    """Raise PrintedError if something inside prints to standard error."""
    try:
        with stderr_to(_seen):
            yield
    finally:
        size = os.lseek(_seen, 0, os.SEEK_END)
        if size:
            text = os.pread(_seen, 200, 0)
            os.ftruncate(_seen, 0)
            os.lseek(_seen, 0, os.SEEK_SET)
            raise PrintedError(text.decode(errors='replace'))
