"""Callback groups: the torque path always runs; services run in short windows beside it."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import Any

from rclpy.callback_groups import CallbackGroup, ReentrantCallbackGroup

# Period of the service windows while efforts are sent, s.
EVERY = 0.1
# Duration of a service window, s.
WINDOW = 0.001
# Duration for which services stay open after a request, s.
BURST = 0.25


class TorqueGroup(ReentrantCallbackGroup):
    """
    Callbacks that may run at any time, one after another in the single executor thread.

    rclpy's default group takes a lock for every entity in every wait; this one does not.

    """


class ServiceGroup(CallbackGroup):
    """
    Excludes services from most waits while efforts are sent.

    rclpy prepares every wait anew, entity by entity, and waits twice for every joint state: a
    dozen idle services cost more than the torque. While the output is on, a request waits up to
    EVERY longer; requests that follow within BURST do not.

    """

    def __init__(
        self, is_driving: Callable[[], bool], clock: Callable[[], float] = time.monotonic
    ) -> None:
        """
        Create the group, open.

        Parameters
        ----------
        is_driving : callable() -> bool
            Whether efforts are sent.
        clock : callable() -> float
            Steady, s.

        """
        super().__init__()
        self._is_driving = is_driving
        self._clock = clock
        self._open_until = self._closed_until = 0.0

    def can_execute(self, entity: Any) -> bool:
        """Return whether the executor includes a service in its wait now."""
        # Called for every service in every wait: the most frequent answers come first.
        now = self._clock()
        if now < self._open_until:
            return True
        if now < self._closed_until:
            return False
        if self._is_driving():
            self._open_until, self._closed_until = now + WINDOW, now + EVERY
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Stay open for BURST: other requests may follow this one."""
        self._open_until = self._clock() + BURST
        return True

    def ending_execution(self, entity: Any) -> None:
        """Do nothing: one thread runs one callback at a time."""
