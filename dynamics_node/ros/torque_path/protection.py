"""Checks that run while efforts are sent: other publishers, and the controllers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from ..context import NodeContext
from ..support.callback_errors import logged

if TYPE_CHECKING:
    from .command_output import CommandOutput
    from .controller_check import Controllers
    from .publisher_monitor import PublisherMonitor

# Period of the lifecycle check of the controllers while the output is off, s.
IDLE_EVERY = 1.0


class Protection:
    """
    Stops the output when another source of efforts appears or a controller does not fit.

    A check that raises is noticed by the torque path, which stops when the last completed check is
    too old.

    """

    def __init__(
        self,
        context: NodeContext,
        output: CommandOutput,
        monitor: PublisherMonitor,
        controllers: Controllers,
    ) -> None:
        """
        Create the checks; `check` runs them.

        Parameters
        ----------
        context : NodeContext
        output : CommandOutput
        monitor : PublisherMonitor
        controllers : Controllers

        """
        self.logger = context.logger
        self._context = context
        self._output = output
        self._path = output.path
        self._monitor = monitor
        self._controllers = controllers
        self._had_listener = True
        self._was_driving = False
        self._next_idle = 0.0

    @logged
    def check(self) -> None:
        """Search for other publishers and check the controllers; called every 0.2 s."""
        now = time.monotonic()
        if self._path.is_driving:
            self._check_driven(now)
        else:
            self._was_driving = False
            if self._path.is_on or now >= self._next_idle:
                self._next_idle = now + IDLE_EVERY
                self._follow_controllers(now)

    def _check_driven(self, now: float) -> None:
        if not self._was_driving:
            self._was_driving, self._had_listener = True, self._controllers.has_listener()
        conflicts = self._monitor.conflicts()
        if conflicts:
            self._path.fault(now, '; '.join(conflicts))
            return
        self._follow_controllers(now)
        has_listener = self._controllers.has_listener()
        new = self._controllers.renewed
        if has_listener and not self._had_listener:
            new = sorted(self._controllers.listeners) or ['a listener']
        if self._path.is_driving and new:
            # A new controller missed the start ramp: it would receive the whole effort at once.
            self._path.restart_from_zero(
                time.monotonic(), f'{", ".join(new)} has begun to listen to the commands'
            )
        self._had_listener = has_listener
        self._path.monitored(time.monotonic())

    def _follow_controllers(self, now: float) -> None:
        lost = self._controllers.update()
        if not self._path.is_on:
            return
        inactive = [
            reason for item in self._controllers.listeners.values() for reason in item.inactive()
        ]
        gone = [f'{name} no longer listens to the commands' for name in lost]
        if inactive or gone:
            self._lose(now, '; '.join(inactive + gone))
            return
        robot = self._context.robot
        assert robot is not None, 'an output that is on has a robot'
        mismatches = self._controllers.refusals(robot.joint_names)
        if mismatches:
            self._path.fault(now, '; '.join(mismatches))

    def _lose(self, now: float, reason: str) -> None:
        # Another controller must receive the whole stop, or it would keep the last effort.
        if not self._controllers.takes_commands():
            self._path.lose_controller(now, reason)
        elif self._path.is_driving:
            self._path.fault(
                now,
                f'{reason}; its hardware may hold the last efforts: '
                + self._path.output.limiter.describe_last(),
            )
