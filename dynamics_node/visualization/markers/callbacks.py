"""Limits on callbacks, and reports of their exceptions."""

from collections.abc import Callable
import functools
import traceback
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

from ...ros.support.throttling import Throttle

# Shortest time between two reports of errors in the same callback, s.
REPORT_EVERY = 10.0


class LimitedGroup(MutuallyExclusiveCallbackGroup):
    """
    A callback group that runs an allowed number of callbacks.

    The executor does not wait for a subscription of a group without allowance. Of 500 messages a
    second, the middleware keeps the newest, and Python reads only the drawn ones.

    """

    def __init__(self) -> None:
        super().__init__()
        self._allowed = 0

    def allow(self, count: int) -> None:
        """Set the number of callbacks that may run."""
        self._allowed = count

    def can_execute(self, entity: Any) -> bool:
        """Return whether a callback may run."""
        return self._allowed > 0 and super().can_execute(entity)

    def ending_execution(self, entity: Any) -> None:
        """Count a callback."""
        self._allowed -= 1
        super().ending_execution(entity)


class ErrorReport:
    """Logs exceptions with their tracebacks, for each callback at most every REPORT_EVERY."""

    def __init__(self, logger: Any) -> None:
        """
        Create a report without errors.

        Parameters
        ----------
        logger : rclpy.impl.rcutils_logger.RcutilsLogger

        """
        self._logger = logger
        self._due: dict[str, Throttle] = {}

    def log(self, where: str, error: Exception) -> None:
        """
        Log an exception that is being handled.

        Parameters
        ----------
        where : str
            Name of the callback.
        error : Exception

        """
        if self._due.setdefault(where, Throttle(REPORT_EVERY)).is_due():
            self._logger.error(f'error in {where}: {error}\n{traceback.format_exc()}')


def reported(method: Callable[..., Any]) -> Callable[..., Any]:
    """Wrap a callback of an object with `errors`, an ErrorReport: no exception leaves it."""

    @functools.wraps(method)
    def safe(self: Any, *arguments: Any) -> Any:
        try:
            return method(self, *arguments)
        except Exception as error:
            self.errors.log(method.__name__, error)
            return None

    return safe
