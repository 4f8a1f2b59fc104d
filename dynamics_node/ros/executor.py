"""Which executor runs the node's callbacks: rclpy's, or one that costs less."""

import argparse

from rclpy.executors import SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from .lean_executor import LeanExecutor

EXECUTORS = {'rclpy': SingleThreadedExecutor, 'lean': LeanExecutor}


def chosen_executor(arguments):
    """
    Return the executor that a command line asks for with --executor.

    Not a parameter, because it belongs to the process and not to the node.

    Parameters
    ----------
    arguments : list of str
        The command line, program first; what belongs to ROS or is unknown is passed over.

    Returns
    -------
    str
        A key of EXECUTORS; 'lean' unless there is another.

    """
    parser = argparse.ArgumentParser(description='Robot dynamics as a ROS 2 node.')
    parser.add_argument('--executor', choices=sorted(EXECUTORS), default='lean',
                        help="rclpy: rclpy's SingleThreadedExecutor; lean: the same for less "
                        'processor time, but resting on the inside of rclpy')
    return parser.parse_known_args(remove_ros_args(arguments)[1:])[0].executor


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
