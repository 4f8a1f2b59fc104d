"""The textbook formulas of this library, literally: what the closed form is measured by."""

from dynamics_node.kernels import textbook

from .dynamics_node import PACKAGE, VERSION
from ..quantities import Call

__all__ = ['NAME', 'NOTE', 'PACKAGE', 'VERSION', 'calls']

NAME = 'textbook formulas'
NOTE = (
    'The sums of docs/mathematics.md, section 3, in numpy, slow on purpose: products of 4x4 '
    'matrices and their derivatives.'
)


def calls(robot):
    """
    Return the textbook's sums as calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    tree, g = robot.model.tree, robot.model.gravity

    def dynamics(q, qd):
        return (
            textbook.mass_matrix(tree, q),
            textbook.coriolis_matrix(tree, q, qd),
            textbook.gravity_torque(tree, q, g),
        )

    def mass_matrix(q):
        return (textbook.mass_matrix(tree, q),)

    def gravity(q):
        return (textbook.gravity_torque(tree, q, g),)

    return {
        'dynamics': Call(dynamics, ('D', 'C', 'G'), 'equations (6), (7) and (8)'),
        'mass_matrix': Call(mass_matrix, ('D',), 'equation (6)'),
        'gravity': Call(gravity, ('G',), 'equation (8)'),
    }
