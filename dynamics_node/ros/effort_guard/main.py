"""The executable `effort_guard`: start, spin, and leave no effort behind."""

from __future__ import annotations

import gc
import os
import sys
import time
import traceback
from typing import TYPE_CHECKING

from ..support.process import Signals, UnblockedOutput

if TYPE_CHECKING:
    from rclpy.executors import Executor

    from .node import EffortGuardNode

# Longest duration of the fade after the first signal, s; launch kills after 5 s.
STOP_WITHIN = 2.5
# Longest duration of the fade after the second signal, s.
HURRY_WITHIN = 0.3
# Time after the first signal at which a remaining effort is set to zero at once, s.
GIVE_UP_AFTER = 3.0
# Time for the controller to acknowledge the last command, s.
ACKNOWLEDGE_WITHIN = 0.5


def main(args: list[str] | None = None) -> int:
    """
    Run the guard until a signal.

    Parameters
    ----------
    args : list of str, optional
        The command line.

    Returns
    -------
    int
        Exit code: 0 after a signal without an effort in force; 1 if one may be in force, or if the
        guard could not start.

    """
    signals = Signals()
    if os.isatty(2):
        os.environ.setdefault('RCUTILS_COLORIZED_OUTPUT', '1')
    outputs = [UnblockedOutput(descriptor) for descriptor in (1, 2)]
    try:
        return _run(args, signals)
    finally:
        for output in outputs:
            output.close()


def _run(args: list[str] | None, signals: Signals) -> int:
    import rclpy
    import rclpy.logging
    from rclpy.signals import SignalHandlerOptions

    try:
        # rclpy's own handlers would end the context before the effort is at zero.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        from .node import EffortGuardNode

        node = EffortGuardNode()
    except Exception as error:  # a command line or a parameter that is refused
        rclpy.logging.get_logger('effort_guard').fatal(str(error))
        rclpy.try_shutdown()
        return 1
    try:
        return _spin(node, signals)
    finally:
        rclpy.try_shutdown()


def _spin(node: EffortGuardNode, signals: Signals) -> int:
    from rclpy.executors import SingleThreadedExecutor

    executor = SingleThreadedExecutor()
    executor.add_node(node)
    signals.call(node.create_guard_condition(lambda: None).trigger)
    gc.collect()
    gc.freeze()  # objects of the start-up stay, and are excluded from later collections
    while not signals.count:
        _spin_once(node, executor)
    is_left = not _bring_to_rest(node, executor, signals)
    executor.remove_node(node)
    node.destroy_node()
    return int(is_left)


def _spin_once(node: EffortGuardNode, executor: Executor) -> None:
    try:
        executor.spin_once()
    except Exception as error:
        # Not from the callbacks of the node, which are guarded, but from those of rclpy.
        node.logger.error(f'error in rclpy: {error}\n{traceback.format_exc()}')
        time.sleep(0.01)  # a repeated error must not take the processor from the timer


def _bring_to_rest(node: EffortGuardNode, executor: Executor, signals: Signals) -> bool:
    # Returns whether no effort is in force.
    guard = node.guard
    if not guard.has_effort:
        return True
    deadline, count = time.monotonic() + GIVE_UP_AFTER, signals.count
    node.end(STOP_WITHIN, f'{signals.name}: commands pass no more')
    while guard.has_effort and time.monotonic() < deadline:
        _spin_once(node, executor)
        if signals.count > count:
            count = signals.count
            node.end(HURRY_WITHIN, f'{signals.name} again')
    if guard.has_effort:
        node.drop()
    if node.flush(ACKNOWLEDGE_WITHIN):
        return True
    node.logger.error(
        'the controller has not acknowledged the last command, zero: an effort may be left'
    )
    return False


if __name__ == '__main__':
    sys.exit(main())
