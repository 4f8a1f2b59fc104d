"""This library with a payload: machine code for any payload."""

from .dynamics_node import calls_of, PACKAGE, VERSION

__all__ = ['NAME', 'NOTE', 'PACKAGE', 'VERSION', 'calls']

NAME = 'dynamics_node, payload'
NOTE = (
    'The machine code that reads the inertia of the bodies at run time: one variant serves '
    'every payload in the same time. Here 1e-15 kg on the last link, so that the results can '
    'be compared with the others.'
)
_MASS = 1e-15


def calls(robot):
    """
    Return the calls of a model with a payload.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    last = [link for link, frame in robot.model.tree.links.items() if frame.body >= 0][-1]
    loaded = robot.model.with_payload(last, _MASS)
    loaded.specialize()
    return calls_of(loaded)
