"""Forward dynamics of some joints while the others are locked."""

import numpy as np
from numpy.typing import NDArray

from .robot_model import RobotModel
from ..errors import SingularMassMatrixError
from ..kernels.recursive import solve_positive_definite


def forward_dynamics_locked(
    model: RobotModel,
    index: NDArray[np.intp],
    q: NDArray[np.float64],
    qd: NDArray[np.float64],
    tau: NDArray[np.float64],
) -> NDArray[np.float64]:
    """
    Return the accelerations caused by efforts while the other joints are locked.

    Parameters
    ----------
    model : RobotModel
    index : numpy.ndarray of int, shape (m,)
        Places of the free joints in q.
    q, qd, tau : numpy.ndarray, shape (n,)
        Positions (rad or m), velocities and efforts (N m or N) of all joints; efforts of locked
        joints are ignored.

    Returns
    -------
    numpy.ndarray, shape (n,)
        rad/s² or m/s²; 0 for the locked joints.

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
    pivots, pivot_margins = np.empty((2, len(index)))
    with np.errstate(all='ignore'):  # results of a pivot of zero are not used
        solve_positive_definite(D, qdd, pivots, pivot_margins)
    if (pivot_margins <= 0.0).any():
        raise SingularMassMatrixError(
            'the mass matrix of these joints is not positive definite, expected inertia behind '
            'every joint: check the <inertial> of the moving links'
        )
    result = np.zeros(len(q))
    result[index] = qdd
    return result
