"""Wrappers that let no exception leave a callback: it would end the process and drop the arm."""

from __future__ import annotations

from collections.abc import Callable
import functools
import time
import traceback
from typing import Any
import weakref

# Shortest time between two log messages about errors of the same callback, s.
LOG_EVERY = 1.0


def guarded(method: Callable[..., Any]) -> Callable[..., Any]:
    """
    Wrap a callback on the torque path, of an object with `logger` and `on_internal_error`.

    An exception is logged with its traceback and handed to `on_internal_error(message)`; the
    callback then returns None.

    """
    log = _ErrorLog(method)

    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            # The stop comes first: writing the log may take long.
            self.on_internal_error(f'internal error in {method.__name__}: {error}')
            log(self, error)
            return None

    return safe


def logged(method: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a callback outside the torque path: an exception is only logged."""
    log = _ErrorLog(method)

    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            log(self, error)
            return None

    return safe


def guarded_service(method: Callable[..., Any]) -> Any:
    """
    Wrap a service callback of an object with `logger` and `failed`.

    An exception is logged; the answer is `failed(response, message)` of a new response.

    """
    log = _ErrorLog(method)

    @functools.wraps(method)
    def safe(self, request, response):
        try:
            return method(self, request, response)
        except Exception as error:
            log(self, error)
            return self.failed(type(response)(), f'internal error: {error}')

    return safe


class _ErrorLog:
    """Logs the errors of one callback, and the number of omitted ones."""

    def __init__(self, method: Callable[..., Any]) -> None:
        self._name = method.__name__
        # Owner → time of the next report, and number of errors omitted since the last one.
        self._reports: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()

    def __call__(self, owner: Any, error: Exception) -> None:
        now = time.monotonic()
        due, omitted = self._reports.get(owner, (now, 0))
        if now < due:
            self._reports[owner] = due, omitted + 1
            return
        self._reports[owner] = now + LOG_EVERY, 0
        more = f' ({omitted} more since the last report)' if omitted else ''
        owner.logger.error(f'{self._name}: {error}{more}\n{traceback.format_exc()}')
