"""No exception leaves a callback: rclpy would end the process, and the arm would drop."""

import functools
import traceback


def guarded(method):
    """
    Wrap a callback on the way of the torque, of an object with `logger` and `on_internal_error`.

    An exception is logged with its traceback and handed to `on_internal_error(message)`; the
    callback then returns None.

    """
    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            _log(self, method, error)
            self.on_internal_error(f'internal error in {method.__name__}: {error}')
            return None
    return safe


def logged(method):
    """Wrap a callback that no torque depends on: an exception is logged, and that is all."""
    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            _log(self, method, error)
            return None
    return safe


def guarded_service(method):
    """
    Wrap a service callback of an object with `logger` and `failed`.

    An exception is logged; the answer is what `failed(response, message)` makes of a new response.

    """
    @functools.wraps(method)
    def safe(self, request, response):
        try:
            return method(self, request, response)
        except Exception as error:
            _log(self, method, error)
            return self.failed(type(response)(), f'internal error: {error}')
    return safe


def _log(owner, method, error):
    owner.logger.error(f'{method.__name__}: {error}\n{traceback.format_exc()}')
