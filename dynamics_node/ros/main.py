"""The executable `dynamics_node`: start, spin, and leave the arm in a defined state."""

import signal
import sys
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from .node import DynamicsNode
from .parameter_table import ParameterError
from ..dynamics import RobotModel
from ..errors import DynamicsError
from ..kernels.warm_up import warm_up

# Time that a stop may take after SIGINT or SIGTERM, s; launch kills after 5.
STOP_WITHIN = 2.5
GIVE_UP_AFTER = 3.0
# The longest that a signal waits for Python to see it, s.
SPIN_SLICE = 0.1


def main(args=None):
    """
    Run the node until SIGINT or SIGTERM.

    Parameters
    ----------
    args : list of str, optional
        The command line.

    Returns
    -------
    int
        Exit code: 0 after a signal, 1 if the node could not start.

    """
    signals = _Signals()
    try:
        # rclpy's own handlers would end the context before the arm has been brought to rest.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:  # how rcl refuses a command line
        rclpy.logging.get_logger('dynamics_node').fatal(str(error))
        return 1
    try:
        _load_what_is_slow()
        node = DynamicsNode()
        _spin(node, signals)
        return 0
    except (DynamicsError, ParameterError) as error:
        rclpy.logging.get_logger('dynamics_node').fatal(str(error))
        return 1
    finally:
        rclpy.try_shutdown()


def _load_what_is_slow():
    # The compiled kernels and the URDF parser, before the first callback could wait for them.
    warm_up()
    RobotModel.from_urdf('<robot name="warm_up"><link name="base"/></robot>')


class _Signals:
    """Counts SIGINT and SIGTERM; the second one ends the process at once."""

    def __init__(self):
        self.name = ''
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._received)

    def _received(self, number, frame):
        if self.name:
            sys.exit(0)
        self.name = signal.Signals(number).name


def _spin(node, signals):
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not signals.name:
        executor.spin_once(timeout_sec=SPIN_SLICE)
    _bring_to_rest(node, executor, signals.name)
    executor.remove_node(node)
    node.destroy_node()


def _bring_to_rest(node, executor, reason):
    if not node.output.channel.machine.is_on:
        return
    node.output.stop(reason, within=STOP_WITHIN)
    deadline = time.monotonic() + GIVE_UP_AFTER
    while node.output.channel.machine.is_on and time.monotonic() < deadline:
        executor.spin_once(timeout_sec=SPIN_SLICE)
    node.output.flush(0.2)


if __name__ == '__main__':
    sys.exit(main())
