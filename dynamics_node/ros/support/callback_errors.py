"""No exception leaves a callback: rclpy would end the process, and the arm would drop."""

import functools
import time
import traceback
import weakref

# Shortest time between two logged errors of one callback, s.
LOG_EVERY = 1.0


def guarded(method):
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
            # The stop first: logging may take long.
            self.on_internal_error(f'internal error in {method.__name__}: {error}')
            log(self, error)
            return None

    return safe


def logged(method):
    """Wrap a callback off the torque path: an exception is only logged."""
    log = _ErrorLog(method)

    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            log(self, error)
            return None

    return safe


def guarded_service(method):
    """
    Wrap a service callback of an object with `logger` and `failed`.

    An exception is logged; the answer is what `failed(response, message)` makes of a new response.

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
    """Logs the errors of one callback, and the number omitted in between."""

    def __init__(self, method):
        self._name = method.__name__
        # Owner → time of the next report, s, and number of errors omitted.
        self._reports: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()

    def __call__(self, owner, error):
        now = time.monotonic()
        due, left_out = self._reports.get(owner, (now, 0))
        if now < due:
            self._reports[owner] = due, left_out + 1
            return
        self._reports[owner] = now + LOG_EVERY, 0
        more = f' ({left_out} more since the last report)' if left_out else ''
        owner.logger.error(f'{self._name}: {error}{more}\n{traceback.format_exc()}')
