"""When the services' callbacks may run beside the torque."""

import time

from rclpy.callback_groups import CallbackGroup

# While efforts are sent, the services are waited for this often, for this long, and for this
# long after a request, s.
EVERY = 0.02
WINDOW = 0.003
BURST = 0.05


class ServiceGroup(CallbackGroup):
    """
    Leaves services out of most waits while efforts are sent.

    rclpy prepares every wait anew, entity by entity, and waits twice for every joint state: a
    dozen services that are hardly ever called cost more than the torque. While the output is on,
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
        self._open_until = self._next = 0.0

    def can_execute(self, entity):
        """Tell whether a service is waited for now."""
        if not self._is_driving():
            return True
        now = self._clock()
        if now < self._open_until:
            return True
        if now < self._next:
            return False
        self._next, self._open_until = now + EVERY, now + WINDOW
        return True

    def beginning_execution(self, entity):
        """Note that a request is answered: others may follow."""
        self._open_until = self._clock() + BURST
        return True

    def ending_execution(self, entity):
        """Do nothing: one thread runs one callback at a time."""
