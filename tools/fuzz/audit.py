"""Sees to it that no file, socket or process is opened while an input is looked at."""

from contextlib import contextmanager
import sys

_FORBIDDEN = (
    'open',
    'os.',
    'socket.',
    'urllib.',
    'http.',
    'ftplib.',
    'subprocess.',
    'shutil.',
    'glob.',
    'tempfile.',
    'mmap.',
    'import',
    'ctypes.dlopen',
    'exec',
    'compile',
)


class OpenedError(Exception):
    """Something was opened, loaded or started."""


class _Watch:
    """An audit hook, which can never be removed: it does nothing while it is off."""

    is_on = False
    is_hooked = False
    seen = ''

    def __call__(self, event, arguments):
        if self.is_on and event.startswith(_FORBIDDEN):
            self.is_on = False
            self.seen = f'{event} {arguments!r:.200}'
            raise OpenedError(self.seen)


_watch = _Watch()


@contextmanager
def nothing_opened():
    """
    Raise OpenedError where something inside is opened.

    An import counts too: what is loaded lazily must be loaded before.

    """
    if not _watch.is_hooked:
        sys.addaudithook(_watch)
        _watch.is_hooked = True
    _watch.seen, _watch.is_on = '', True
    try:
        yield
    finally:
        _watch.is_on = False
        # Also where somebody has caught it.
        if _watch.seen:
            raise OpenedError(_watch.seen)
