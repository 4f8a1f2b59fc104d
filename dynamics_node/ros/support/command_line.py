"""Options of the process, as opposed to parameters of the node."""

from __future__ import annotations

import argparse

from rclpy.utilities import remove_ros_args

from .executor import EXECUTORS


def parse(arguments: list[str]) -> argparse.Namespace:
    """
    Read the command line.

    Parameters
    ----------
    arguments : list of str
        Program first; ROS arguments and unknown ones are ignored.

    Returns
    -------
    argparse.Namespace
        executor : str, one of EXECUTORS. raw_states : bool.

    """
    return parser().parse_known_args(remove_ros_args(arguments)[1:])[0]


def parser() -> argparse.ArgumentParser:
    """
    Return the parser of the options, for the process and for docs/reference.md.

    Returns
    -------
    argparse.ArgumentParser

    """
    options = argparse.ArgumentParser(description='Robot dynamics as a ROS 2 node.')
    options.add_argument(
        '--executor',
        choices=EXECUTORS,
        default='rclpy',
        help="rclpy: rclpy's SingleThreadedExecutor; events: its EventsExecutor, "
        'experimental, refused where a self-test at start fails',
    )
    options.add_argument(
        '--raw-states',
        action=argparse.BooleanOptionalAction,
        default=True,
        help='read joint_states from the bytes on the wire: less time from state to command',
    )
    return options
