"""A choice of joints in an order of one's own: rows and columns of the robot's matrices."""

import numpy as np

from ..errors import ArgumentError, quoted


class JointSelection:
    """
    The joints that a user works with, in the user's order.

    The robot's other joints keep their mass: they stand still at given positions.

    Attributes
    ----------
    names : tuple of str
        m joint names.
    index : numpy.ndarray of int, shape (m,)
        Their places in the robot's q.

    """

    def __init__(self, robot, names=()):
        """
        Select joints of a robot.

        Parameters
        ----------
        robot : RobotModel
        names : sequence of str
            Empty selects all joints in the order of the URDF.

        Raises
        ------
        ArgumentError
            If a name is unknown, of a fixed or mimic joint, or given twice.

        """
        available = robot.joint_names
        self.names = tuple(names) or available
        unknown = [name for name in dict.fromkeys(self.names) if name not in available]
        twice = sorted({name for name in self.names if self.names.count(name) > 1})
        if unknown or twice:
            wrong = [f"'{name}' is not a joint that can be moved" for name in unknown]
            wrong += [f"'{name}' is given twice" for name in twice]
            raise ArgumentError(f'joints: {"; ".join(wrong)}; available: {", ".join(available)}')
        self.index = np.array([available.index(name) for name in self.names], dtype=np.intp)

    def permutation(self, names):
        """
        Return where each of some names stands in this selection.

        Parameters
        ----------
        names : sequence of str
            Empty: this selection's own order. Otherwise a permutation of its names.

        Returns
        -------
        numpy.ndarray of int, shape (m,)

        Raises
        ------
        ArgumentError
            If names are not a permutation of the selected joints.

        """
        if not names:
            return np.arange(len(self.names))
        if len(names) != len(self.names) or sorted(names) != sorted(self.names):
            # As many as it takes to see the mistake: somebody may send a million.
            shown = [quoted(name) for name in names[:len(self.names) + 1]]
            more = f' and {len(names) - len(shown)} more' if len(names) > len(shown) else ''
            raise ArgumentError(f'joint_names: expected a permutation of {list(self.names)}, '
                                f'got [{", ".join(shown)}]{more}')
        return np.array([self.names.index(name) for name in names], dtype=np.intp)
