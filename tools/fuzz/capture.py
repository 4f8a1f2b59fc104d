"""Redirection of standard error, also of C code."""

from contextlib import contextmanager
import os

NOWHERE = os.open(os.devnull, os.O_WRONLY)
_STDERR = 2
_captured = os.memfd_create('printed')


class PrintedError(Exception):
    """Code printed to standard error, without a throttle."""


@contextmanager
def stderr_to(file):
    """Redirect standard error of the code inside to another file descriptor."""
    usual = os.dup(_STDERR)
    os.dup2(file, _STDERR)
    try:
        yield
    finally:
        os.dup2(usual, _STDERR)
        os.close(usual)


@contextmanager
def nothing_printed():
    """Raise PrintedError if the code inside prints to standard error."""
    before = os.lseek(_captured, 0, os.SEEK_END)
    try:
        with stderr_to(_captured):
            yield
    finally:
        text = os.pread(_captured, 200, before)
        if text:
            raise PrintedError(text.decode(errors='replace'))
