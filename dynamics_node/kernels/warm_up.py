"""
Compile every kernel once: `python -m dynamics_node.kernels.warm_up`.

The kernels do not depend on the robot, so after this no robot ever waits for the compiler.

"""

import numpy as np

from . import closed_form, specialised
from .packing import WIDTH


def warm_up():
    """Compile the kernels, or load them from the cache on disk."""
    structure = np.array([[-1, 0, 0]], dtype=np.int64)
    numbers = np.zeros((2, WIDTH))
    # As `pack` hands them over: numba compiles read-only arrays as a type of their own.
    structure.flags.writeable = numbers.flags.writeable = False
    q = np.zeros((1, 1))
    matrix, vector = np.empty((1, 1, 1)), np.empty((1, 1))
    closed_form.dynamics(structure, numbers, q, q, matrix, matrix, vector)
    closed_form.mass_matrix(structure, numbers, q, matrix)
    closed_form.gravity_torque(structure, numbers, q, vector, np.empty(1))
    closed_form.gravity_torque_of_one(structure, numbers, q[0], vector[0])
    closed_form.inverse_dynamics(structure, numbers, q, q, q, vector)
    closed_form.jacobian(structure, numbers, q, 0, np.zeros(3), np.empty((1, 6, 1)))
    closed_form.body_poses(
        structure, numbers, q, np.zeros(1, dtype=np.int64), np.empty((1, 1, 3, 4))
    )
    specialised.are_ordinary('dynamics', [q, q])
    closed_form.forward_dynamics(structure, numbers, q, q, q, vector, np.empty(1, dtype=bool))


if __name__ == '__main__':
    warm_up()
