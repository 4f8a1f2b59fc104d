"""Callback groups: the torque path always runs, services only in short windows beside it."""

import time

from rclpy.callback_groups import CallbackGroup, ReentrantCallbackGroup

# While efforts are sent, services run in windows of this period, s.
EVERY = 0.1
# Length of a window, s.
WINDOW = 0.001
# Length of a window after a request, s.
BURST = 0.25


class TorqueGroup(ReentrantCallbackGroup):
    """
    Callbacks that may always run, one after another in the single thread of the executor.

    rclpy's default group takes a lock for every entity in every wait.

    """


class ServiceGroup(CallbackGroup):
    """
    Leaves services out of most waits while efforts are sent.

    rclpy prepares every wait anew, entity by entity, and waits twice for every joint state: a
    dozen rarely called services cost more than the torque. While the output is on,
    a request waits up to EVERY longer; those that follow it do not.

    """

    def __init__(self, is_driving, clock=time.monotonic):
        """
        Make a group for services.

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

    def can_execute(self, entity):
        """Return whether services are waited for now."""
        # Called for every service in every wait: the usual case comes first.
        now = self._clock()
        if now < self._open_until:
            return True
        if now < self._closed_until:
            return False
        if self._is_driving():
            self._open_until, self._closed_until = now + WINDOW, now + EVERY
        return True

    def beginning_execution(self, entity):
        """Open a longer window: more requests may follow."""
        self._open_until = self._clock() + BURST
        return True

    def ending_execution(self, entity):
        """Nothing to release: one thread runs one callback at a time."""
