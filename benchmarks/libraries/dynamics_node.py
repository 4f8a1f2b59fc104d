"""This library through its public methods, which check their arguments."""

from xml.etree import ElementTree

from ..quantities import Call
from ..robots import ROOT

NAME = 'dynamics_node'
PACKAGE = 'dynamics_node'
# Of this checkout: another version may be installed.
VERSION = ElementTree.parse(ROOT / 'package.xml').findtext('version')
NOTE = (
    "Machine code of the robot's own, the methods of `RobotModel` themselves: arguments are "
    'checked, and returned arrays are never overwritten while referenced.'
)


def calls(robot):
    """
    Return this library's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    robot.model.specialize()
    return calls_of(robot.model)


def calls_of(model):
    """
    Return a model's calls.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    dict of str to Call

    """
    return {
        'dynamics': Call(model.dynamics, ('D', 'C', 'G'), 'dynamics'),
        'mass_matrix': Call(model.mass_matrix, ('D',), 'mass_matrix'),
        'gravity': Call(model.gravity_torque, ('G',), 'gravity_torque'),
        'inverse': Call(model.inverse_dynamics, ('tau',), 'inverse_dynamics'),
        'forward': Call(model.forward_dynamics, ('qdd',), 'forward_dynamics'),
    }
