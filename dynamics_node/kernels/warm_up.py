"""
Compile every kernel in advance: `python -m dynamics_node.kernels.warm_up`.

The kernels do not depend on the robot, so after this no call waits for the compiler.

"""

import numpy as np

from . import recursive


def warm_up() -> None:
    """Compile the kernels, or load them from the cache on disk."""
    structure = np.array([[-1, 0, 0]], dtype=np.int64)
    numbers = np.zeros((2, recursive.WIDTH))
    # Read-only as those of `pack`: numba compiles for read-only arrays separately.
    structure.flags.writeable = numbers.flags.writeable = False
    q = np.zeros((1, 1))
    matrix, vector = np.empty((1, 1, 1)), np.empty((1, 1))
    recursive.dynamics(structure, numbers, q, q, matrix, matrix, vector)
    recursive.mass_matrix(structure, numbers, q, matrix)
    recursive.gravity_torque(structure, numbers, q, vector, np.empty(1))
    recursive.gravity_torque_of_one(structure, numbers, q[0], vector[0])
    recursive.inverse_dynamics(structure, numbers, q, q, q, vector)
    recursive.regressor(structure, numbers, q, q, q, np.empty((1, 1, 10)))
    recursive.jacobian(structure, numbers, q, 0, np.zeros(3), np.empty((1, 6, 1)))
    recursive.body_poses(
        structure, numbers, q, np.zeros(1, dtype=np.int64), np.empty((1, 1, 3, 4))
    )
    recursive.forward_dynamics(structure, numbers, q, q, q, vector, np.empty(1, dtype=bool))


if __name__ == '__main__':
    warm_up()
