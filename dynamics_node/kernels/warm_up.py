"""
Compile every kernel once: `python -m dynamics_node.kernels.warm_up`.

The kernels do not depend on the robot, so after this no robot ever waits for the compiler.

"""

import numpy as np

from . import recursive
from .packing import WIDTH


def warm_up():
    """Compile the kernels, or load them from the cache on disk."""
    structure = np.array([[-1, 0, 0]], dtype=np.int64)
    numbers = np.zeros((2, WIDTH))
    # As `pack` hands them over: numba compiles read-only arrays as a type of their own.
    structure.flags.writeable = numbers.flags.writeable = False
    q = np.zeros((1, 1))
    matrix, vector = np.empty((1, 1, 1)), np.empty((1, 1))
    recursive.dynamics(structure, numbers, q, q, matrix, matrix, vector)
    recursive.mass_matrix(structure, numbers, q, matrix)
    recursive.gravity_torque(structure, numbers, q, vector, np.empty(1))
    recursive.gravity_torque_of_one(structure, numbers, q[0], vector[0])
    recursive.inverse_dynamics(structure, numbers, q, q, q, vector)
    recursive.jacobian(structure, numbers, q, 0, np.zeros(3), np.empty((1, 6, 1)))
    recursive.body_poses(
        structure, numbers, q, np.zeros(1, dtype=np.int64), np.empty((1, 1, 3, 4))
    )
    recursive.forward_dynamics(structure, numbers, q, q, q, vector, np.empty(1, dtype=bool))


if __name__ == '__main__':
    warm_up()
