"""This library without code for the robot: before its compilation, and for very large robots."""

import os

from dynamics_node import RobotModel

from .dynamics_node import calls_of, PACKAGE, VERSION

__all__ = ['NAME', 'NOTE', 'PACKAGE', 'VERSION', 'calls']

NAME = 'general kernel'
NOTE = 'This library with `DYNAMICS_NODE_SPECIALIZE=0`: compiled once for every robot.'


def calls(robot):
    """
    Return the calls of a model without machine code of its own.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    before = os.environ.get('DYNAMICS_NODE_SPECIALIZE')
    os.environ['DYNAMICS_NODE_SPECIALIZE'] = '0'
    try:
        model = RobotModel.from_urdf(robot.text)
    finally:
        del os.environ['DYNAMICS_NODE_SPECIALIZE']
        if before is not None:
            os.environ['DYNAMICS_NODE_SPECIALIZE'] = before
    return calls_of(model)
