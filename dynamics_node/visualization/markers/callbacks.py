"""When callbacks run, and what happens to their exceptions."""

import functools
import traceback

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

from ...ros.support.throttling import Throttle

# Shortest time between two reports of errors in the same callback, s.
REPORT_EVERY = 10.0


class LimitedGroup(MutuallyExclusiveCallbackGroup):
    """
    A callback group that runs only as many callbacks as it has been allowed.

    The executor does not wait for a subscription whose group allows nothing. Of 500 messages a
    second, the middleware then keeps the newest, and Python takes only those that are shown.

    """

    def __init__(self):
        """Allow nothing."""
        super().__init__()
        self._allowed = 0

    def allow(self, count):
        """Allow a number of callbacks from now on, instead of those that are left."""
        self._allowed = count

    def can_execute(self, entity):
        """Tell whether a callback may run."""
        return self._allowed > 0 and super().can_execute(entity)

    def ending_execution(self, entity):
        """Count a callback that has run."""
        self._allowed -= 1
        super().ending_execution(entity)


class ErrorReport:
    """Logs exceptions with their tracebacks, those of one place at most every REPORT_EVERY."""

    def __init__(self, logger):
        """
        Use a logger.

        Parameters
        ----------
        logger : rclpy.impl.rcutils_logger.RcutilsLogger

        """
        self._logger = logger
        self._due = {}

    def log(self, where, error):
        """
        Log an exception that is being handled.

        Parameters
        ----------
        where : str
            The callback that raised it.
        error : Exception

        """
        if self._due.setdefault(where, Throttle(REPORT_EVERY)).is_due():
            self._logger.error(f'error in {where}: {error}\n{traceback.format_exc()}')


def reported(method):
    """Wrap a callback of an object with `errors`, an ErrorReport: no exception leaves it."""

    @functools.wraps(method)
    def safe(self, *arguments):
        try:
            return method(self, *arguments)
        except Exception as error:
            self.errors.log(method.__name__, error)
            return None

    return safe
