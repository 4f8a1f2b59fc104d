"""This library, called as a user calls it: checks of the arguments included."""

from xml.etree import ElementTree

from ..quantities import Call
from ..robots import ROOT

NAME = 'dynamics_node'
PACKAGE = 'dynamics_node'
# Of this checkout: a package of this name may be installed from somewhere else.
VERSION = ElementTree.parse(ROOT / 'package.xml').findtext('version')
NOTE = "Arguments are checked and copied, results are fresh arrays that stay the caller's."


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
    model = robot.model

    def dynamics(q, qd):
        return model.dynamics(q, qd)

    def mass_matrix(q):
        return (model.mass_matrix(q),)

    def gravity(q):
        return (model.gravity_torque(q),)

    def inverse(q, qd, qdd):
        return (model.inverse_dynamics(q, qd, qdd),)

    def forward(q, qd, tau):
        return (model.forward_dynamics(q, qd, tau),)

    return {
        'dynamics': Call(dynamics, ('D', 'C', 'G'), 'dynamics'),
        'mass_matrix': Call(mass_matrix, ('D',), 'mass_matrix'),
        'gravity': Call(gravity, ('G',), 'gravity_torque'),
        'inverse': Call(inverse, ('tau',), 'inverse_dynamics'),
        'forward': Call(forward, ('qdd',), 'forward_dynamics'),
    }
