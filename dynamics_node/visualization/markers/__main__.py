"""The executable `markers`: start, spin, and end with exit code 0 on SIGINT or SIGTERM."""

import signal
import sys
from types import FrameType


class StopRequest:
    """
    Notes the first SIGINT or SIGTERM; the second one ends the process at once.

    Attributes
    ----------
    came : bool
        Whether one of them has been received.

    """

    def __init__(self) -> None:
        """Replace Python's handlers, whose KeyboardInterrupt can come at any line."""
        self.came = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._on_signal)

    def ignore(self) -> None:
        """Ignore both signals from now on: the process is about to end."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if self.came:
            sys.exit(0)
        self.came = True


def main(args: list[str] | None = None) -> int:
    """
    Publish markers until SIGINT or SIGTERM.

    Parameters
    ----------
    args : list of str, optional
        The command line.

    Returns
    -------
    int
        Exit code: 0 after a signal, 1 if the node could not start.

    """
    # Before the imports, which take seconds: Ctrl-C may come during them.
    stop = StopRequest()
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    import rclpy.logging
    from rclpy.signals import SignalHandlerOptions

    from .node import MarkersNode

    try:
        # rclpy's own handlers would end the context inside a wait, which raises.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        node = MarkersNode()
    except Exception as error:  # an invalid command line or parameter
        rclpy.logging.get_logger('markers').fatal(str(error))
        rclpy.try_shutdown()
        return 1
    try:
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while not stop.came:
            # Without a timeout: the node's timer ends every wait, and a signal is seen then.
            node.spin_once(executor)
    finally:
        stop.ignore()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
