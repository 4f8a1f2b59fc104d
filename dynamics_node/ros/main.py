"""The executable `dynamics_node`: start, spin, and leave the arm in a defined state."""

from __future__ import annotations

import gc
import os
import sys
import threading
import time
import traceback
from typing import TYPE_CHECKING

from .support.process import Signals, UnblockedOutput

if TYPE_CHECKING:
    import argparse

    from rclpy.executors import Executor

    from .node import DynamicsNode

# Longest duration of the stop after the first signal, s; launch kills after 5 s.
STOP_WITHIN = 2.5
# Longest duration of the stop after the second signal, s.
HURRY_WITHIN = 0.3
# Time after the first signal at which the process ends, whatever the state of the output, s.
GIVE_UP_AFTER = 3.0
# Longest wait of the loop during the stop, s.
STOP_SLICE = 0.01
# Duration of uninterrupted exceptions after which an executor has failed, s.
FAILING_FOR = 0.5
# Number of uninterrupted exceptions, at least, of a failed executor.
MAX_FAILURES = 5
# Time after the start at which scipy is loaded, which only some services need, s.
LOAD_AFTER = 3.0


def main(args: list[str] | None = None) -> int:
    """
    Run the node until a signal asks it to end.

    Parameters
    ----------
    args : list of str, optional
        The command line.

    Returns
    -------
    int
        Exit code: 0 after a signal, 1 if the node could not start, if its executor failed, or
        if it left an effort in force.

    """
    # Before rclpy is imported: that takes seconds, in which Ctrl-C may arrive.
    signals = Signals()
    if os.isatty(2):
        os.environ.setdefault('RCUTILS_COLORIZED_OUTPUT', '1')
    # A paused terminal or an unread pipe must not block the arm.
    outputs = [UnblockedOutput(descriptor) for descriptor in (1, 2)]
    try:
        return _run(args, signals)
    finally:
        for output in outputs:
            output.close()


def _run(args: list[str] | None, signals: Signals) -> int:
    gc.disable()  # until everything is loaded: imports allocate much and release nothing
    import rclpy
    import rclpy.logging
    from rclpy.signals import SignalHandlerOptions

    try:
        # rclpy's own handlers would end the context before the arm has been brought to rest.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        from .support.command_line import parse

        options = parse(sys.argv if args is None else args)
        node, executor = _start(signals, options)
    except Exception as error:  # a command line, a parameter or a description that is refused
        rclpy.logging.get_logger('dynamics_node').fatal(str(error))
        rclpy.try_shutdown()
        return 1
    code = 0
    try:
        if node is not None and executor is not None:
            code = _Loop(node, executor, signals).run()
    finally:
        rclpy.try_shutdown()
    return code


def _start(
    signals: Signals, options: argparse.Namespace
) -> tuple[DynamicsNode | None, Executor | None]:
    # Without a node if a signal came first. Compiled kernels and URDF parser are loaded here, so
    # that no callback waits for them.
    from .node import DynamicsNode
    from .support.executor import make_executor
    from ..dynamics import RobotModel
    from ..kernels.warm_up import warm_up

    warm_up()
    RobotModel.from_urdf('<robot name="warm_up"><link name="base"/></robot>')
    if signals.name:
        return None, None
    executor = make_executor(options.executor)
    return DynamicsNode(raw_states=options.raw_states), executor


class _Loop:
    """Spins the node, and brings the arm to rest at the end."""

    def __init__(self, node: DynamicsNode, executor: Executor, signals: Signals) -> None:
        self._node = node
        self._executor = executor
        self._signals = signals
        self._failures = 0
        self._failing_since = 0.0
        # The wait of the events executor needs a timeout: a signal may not end it.
        from rclpy.executors import SingleThreadedExecutor

        self._timeout = None if isinstance(executor, SingleThreadedExecutor) else 0.1

    def run(self) -> int:
        """Spin until a signal comes or the executor fails; return the exit code."""
        node, executor = self._node, self._executor
        executor.add_node(node)
        # A task, because rclpy continues to wait after a wake-up without one, and a guard
        # condition of the node would cost time in every wait.
        self._signals.call(lambda: executor.create_task(_do_nothing))
        _freeze_startup_objects()
        loading = threading.Timer(LOAD_AFTER, _load_scipy)
        loading.daemon = True
        loading.start()
        while not self._signals.name and not self._has_failed():
            self._spin_once(self._timeout)
        if self._has_failed():
            node.logger.fatal('the executor keeps failing: stopping the output and ending')
        is_at_rest = self._bring_to_rest(self._signals.name or 'the executor keeps failing')
        code = 0 if is_at_rest and not self._has_failed() else 1
        executor.remove_node(node)
        node.destroy_node()
        return code

    def _has_failed(self):
        return (
            self._failures >= MAX_FAILURES
            and time.monotonic() - self._failing_since >= FAILING_FOR
        )

    def _spin_once(self, timeout):
        try:
            self._executor.spin_once(timeout)
            self._failures = 0
        except Exception as error:
            # Not from the callbacks of the node, which are guarded, but from those of rclpy: a
            # parameter of an unknown type raises in its parameter services.
            self._failures += 1
            if self._failures == 1:
                self._failing_since = time.monotonic()
                self._node.logger.error(f'error in rclpy: {error}\n{traceback.format_exc()}')
            else:
                time.sleep(0.001)

    def _bring_to_rest(self, reason: str) -> bool:
        # Returns whether the last effort is zero and the subscribers have it.
        output, path = self._node.output, self._node.path
        path.close(time.monotonic(), reason, STOP_WITHIN)
        handled, deadline = self._signals.count, time.monotonic() + GIVE_UP_AFTER
        while path.is_on and time.monotonic() < deadline:
            if self._signals.count > handled:
                handled = self._signals.count
                self._node.logger.warning(
                    'second signal: the efforts go to zero within '
                    f'{HURRY_WITHIN:g} s; now ' + path.output.limiter.describe_last()
                )
                path.close(time.monotonic(), reason, HURRY_WITHIN)
            if self._has_failed():
                time.sleep(STOP_SLICE)
            else:
                self._spin_once(STOP_SLICE)
            try:
                output.tick()  # in case the executor no longer runs timers
            except Exception as error:  # the context has been shut down: nothing can be sent
                self._node.logger.error(f'the stop cannot be sent: {error}')
                break
        is_at_rest = not path.output.limiter.last.any()
        if not is_at_rest:
            self._node.logger.error(
                'the last efforts may stay in force: ' + path.output.limiter.describe_last()
            )
        try:
            output.flush(0.2)
        except Exception:
            return False
        return is_at_rest


def _do_nothing() -> None:
    pass


def _freeze_startup_objects() -> None:
    # Objects of the start-up live as long as the process. Unfrozen, a garbage collection would
    # traverse all of them, half a million of numba alone, in the middle of a control cycle.
    gc.freeze()
    gc.enable()


def _load_scipy() -> None:
    # Imported by the first service that needs it, it would block the control loop for half a
    # second.
    import scipy.interpolate
    import scipy.spatial.transform  # noqa: F401

    gc.freeze()


if __name__ == '__main__':
    sys.exit(main())
