"""No exception leaves a callback: rclpy would end the process, and the arm would drop."""

import functools
import traceback


def guarded(method):
    """
    Wrap a callback of an object that has `logger` and `on_internal_error`.

    An exception is logged with its traceback and handed to `on_internal_error(message)`; the
    callback then returns None.

    """
    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            report(self, method.__name__, error)
            return None
    return safe


def guarded_service(method):
    """Wrap a service callback like `guarded`; the answer then says that it failed."""
    @functools.wraps(method)
    def safe(self, request, response):
        try:
            return method(self, request, response)
        except Exception as error:
            report(self, method.__name__, error)
            failed = type(response)()
            failed.success = False
            failed.message = f'internal error: {error}'
            return failed
    return safe


def report(owner, where, error):
    """Log an exception with its traceback and tell the owner."""
    owner.logger.error(f'{where}: {error}\n{traceback.format_exc()}')
    owner.on_internal_error(f'internal error in {where}: {error}')
