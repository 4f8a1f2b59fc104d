"""Which executor runs the node's callbacks: rclpy's, or one that costs less."""

from rclpy.executors import SingleThreadedExecutor

from .lean_executor import LeanExecutor

EXECUTORS = {'rclpy': SingleThreadedExecutor, 'lean': LeanExecutor}


def make_executor(choice, logger):
    """
    Make an executor, or rclpy's own where the chosen one does not fit rclpy.

    Parameters
    ----------
    choice : str
        A key of EXECUTORS.
    logger : rclpy.impl.rcutils_logger.RcutilsLogger
        Hears why it is not the chosen one.

    Returns
    -------
    rclpy.executors.Executor

    """
    try:
        return EXECUTORS[choice]()
    except NotImplementedError as error:
        logger.warning(f"executor {choice} does not work here, rclpy's own is used: {error}")
        return SingleThreadedExecutor()
