"""Pinocchio: model and data made once, results used as returned."""

import pinocchio

from ..quantities import Call

NAME = 'Pinocchio'
PACKAGE = 'pin'
NOTE = (
    'Results are views into its data, overwritten by the next call; a user who keeps them '
    'pays for a copy that is not counted here.'
)


def model_of(robot):
    """
    Return Pinocchio's model of a robot.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    pinocchio.Model

    Raises
    ------
    ValueError
        If its order of joints differs.

    """
    model = pinocchio.buildModelFromXML(robot.text)
    names = tuple(model.names)[1:]
    robot.check_joint_order(names)
    return model


def calls(robot):
    """
    Return Pinocchio's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    model = model_of(robot)
    data = model.createData()
    crba, coriolis = pinocchio.crba, pinocchio.computeCoriolisMatrix
    generalized_gravity = pinocchio.computeGeneralizedGravity
    rnea, aba = pinocchio.rnea, pinocchio.aba

    def dynamics(q, qd):
        return (
            crba(model, data, q),
            coriolis(model, data, q, qd),
            generalized_gravity(model, data, q),
        )

    def mass_matrix(q):
        return (crba(model, data, q),)

    def gravity(q):
        return (generalized_gravity(model, data, q),)

    def inverse(q, qd, qdd):
        return (rnea(model, data, q, qd, qdd),)

    def forward(q, qd, tau):
        return (aba(model, data, q, qd, tau),)

    return {
        'dynamics': Call(
            dynamics, ('D', 'C', 'G'), 'crba, computeCoriolisMatrix, computeGeneralizedGravity'
        ),
        'mass_matrix': Call(mass_matrix, ('D',), 'crba'),
        'gravity': Call(gravity, ('G',), 'computeGeneralizedGravity'),
        'inverse': Call(inverse, ('tau',), 'rnea'),
        'forward': Call(forward, ('qdd',), 'aba'),
    }
