"""Where lines go that C code prints, past Python's own standard error."""

from contextlib import contextmanager
import os

NOWHERE = os.open(os.devnull, os.O_WRONLY)
_STDERR = 2
_seen = os.memfd_create('printed')


class PrintedError(Exception):
    """Something was printed that nobody throttles."""


@contextmanager
def stderr_to(file):
    """Send what is printed inside to another file descriptor."""
    usual = os.dup(_STDERR)
    os.dup2(file, _STDERR)
    try:
        yield
    finally:
        os.dup2(usual, _STDERR)
        os.close(usual)


@contextmanager
def nothing_printed():
    """Raise PrintedError if something inside prints to standard error."""
    before = os.lseek(_seen, 0, os.SEEK_END)
    try:
        with stderr_to(_seen):
            yield
    finally:
        text = os.pread(_seen, 200, before)
        if text:
            raise PrintedError(text.decode(errors='replace'))
