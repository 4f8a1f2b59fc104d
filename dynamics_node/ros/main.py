"""The executable `dynamics_node`: start, spin, and leave the arm in a defined state."""

import gc
import sys
import threading
import time
import traceback

from .signals import Signals

# Time that a stop may take after SIGINT or SIGTERM, s; launch kills after 5.
STOP_WITHIN = 2.5
GIVE_UP_AFTER = 3.0
# What only some services need is loaded so long after the start, which has enough to do, s.
LOAD_AFTER = 3.0
# The longest that the loop waits during that, s.
STOP_SLICE = 0.1


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
    # First of all, and rclpy after it: importing takes seconds, and Ctrl-C may come then.
    signals = Signals()
    gc.disable()  # until everything is loaded: importing makes much and drops nothing
    import rclpy
    import rclpy.logging
    from rclpy.signals import SignalHandlerOptions
    try:
        # rclpy's own handlers would end the context before the arm has been brought to rest.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        from .command_line import parse
        options = parse(sys.argv if args is None else args)
        node = _start(signals, options)
    except Exception as error:  # a command line, a parameter or a description that is refused
        rclpy.logging.get_logger('dynamics_node').fatal(str(error))
        rclpy.try_shutdown()
        return 1
    try:
        if node is not None:
            _spin(node, signals, options)
    finally:
        rclpy.try_shutdown()
    return 0


def _start(signals, options):
    # None if a signal came first. The compiled kernels and the URDF parser are loaded here,
    # before the first callback could wait for them.
    from .node import DynamicsNode
    from ..dynamics import RobotModel
    from ..kernels.warm_up import warm_up
    warm_up()
    RobotModel.from_urdf('<robot name="warm_up"><link name="base"/></robot>')
    return None if signals.name else DynamicsNode(raw_states=options.raw_states)


def _spin(node, signals, options):
    from .executor import make_executor
    executor = make_executor(options.executor, node.logger)
    executor.add_node(node)
    signals.call(node.create_guard_condition(lambda: None).trigger)
    _spare_the_garbage_collector()
    later = threading.Timer(LOAD_AFTER, _load_the_rest)
    later.daemon = True
    later.start()
    while not signals.name:
        _spin_once(node, executor)
    _bring_to_rest(node, executor, signals.name)
    executor.remove_node(node)
    node.destroy_node()


def _spare_the_garbage_collector():
    # What start-up has made stays for good. Without this, all of it, numba's half a million
    # objects, would be looked through in the middle of a control cycle.
    gc.freeze()
    gc.enable()


def _load_the_rest():
    # Imported by the first service that needs it, it would hold up the control loop for half a
    # second.
    import scipy.interpolate
    import scipy.spatial.transform  # noqa: F401
    gc.freeze()


def _spin_once(node, executor, timeout=None):
    try:
        executor.spin_once(timeout)
    except Exception as error:
        # Not from our callbacks, which let nothing out, but rclpy has some of its own: a
        # parameter of an unknown type raises in its parameter services.
        node.logger.error(f'error in rclpy: {error}\n{traceback.format_exc()}')


def _bring_to_rest(node, executor, reason):
    output = node.output
    if not output.channel.machine.is_on:
        return
    output.stop(reason, within=STOP_WITHIN)
    deadline = time.monotonic() + GIVE_UP_AFTER
    while output.channel.machine.is_on and time.monotonic() < deadline:
        _spin_once(node, executor, STOP_SLICE)
    if output.channel.machine.is_on:
        node.logger.error(
            f'the stop did not end within {GIVE_UP_AFTER:g} s: the last efforts stay in force, '
            f'{output.channel.limiter.describe_last()}; effort_rate_limits are too small for it')
    output.flush(0.2)


if __name__ == '__main__':
    sys.exit(main())
