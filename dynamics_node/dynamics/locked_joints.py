"""Forward dynamics of some joints while the others are held."""

import numpy as np

from ..errors import SingularMassMatrixError
from ..kernels.recursive import solve_positive_definite


def forward_dynamics_locked(model, index, q, qd, tau):
    """
    Return the accelerations that efforts cause while the other joints are held where they are.

    Parameters
    ----------
    model : RobotModel
    index : numpy.ndarray of int, shape (m,)
        Places of the joints that are free to move.
    q, qd, tau : numpy.ndarray, shape (n,)
        Positions (rad or m), velocities and efforts (N m or N) of all joints; what efforts say
        of those that are held does not matter.

    Returns
    -------
    numpy.ndarray, shape (n,)
        rad/s² or m/s²; 0 for the joints that are held.

    Raises
    ------
    SingularMassMatrixError
        If D of the free joints is not positive definite beyond rounding.

    References
    ----------
    docs/mathematics.md, equation (25) with the rows and columns of the free joints.

    """
    if len(index) == len(q):
        return model.forward_dynamics(q, qd, tau)
    bias = model.inverse_dynamics(q, qd, np.zeros(len(q)))
    D = model.mass_matrix(q)[np.ix_(index, index)]
    qdd = (tau - bias)[index]
    pivots, margins = np.empty((2, len(index)))
    with np.errstate(all='ignore'):  # what comes of a pivot that is zero is not used
        solve_positive_definite(D, qdd, pivots, margins)
    if (margins <= 0.0).any():
        raise SingularMassMatrixError(
            'the mass matrix of these joints is not positive definite, expected inertia behind '
            'every joint: check the <inertial> of the moving links'
        )
    result = np.zeros(len(q))
    result[index] = qdd
    return result
