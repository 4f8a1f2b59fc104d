"""A choice of joints in an order of one's own: rows and columns of the robot's matrices."""

from collections import Counter

import numpy as np

from ..errors import ArgumentError, quoted

# Wrong names that an error message lists: somebody may send a million.
_MOST_SHOWN = 5


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
        # Counted once: looking for each name among all takes seconds for ten thousand.
        count, known = Counter(self.names), set(available)
        followers = dict(zip(robot.tree.body_names, robot.tree.coordinate, strict=True))
        unknown = [name for name in count if name not in known]
        wrong = _listed([name for name in unknown if name not in followers],
                        'is not a joint that can be moved')
        wrong += [f'{quoted(name)} follows {available[followers[name]]!r}: leave it out'
                  for name in unknown if name in followers][:_MOST_SHOWN]
        wrong += _listed(sorted(name for name in count if count[name] > 1), 'is given twice')
        if wrong:
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


def _listed(names, what):
    sentences = [f'{quoted(name)} {what}' for name in names[:_MOST_SHOWN]]
    if len(names) > _MOST_SHOWN:
        sentences.append(f'so it is for {len(names) - _MOST_SHOWN} more')
    return sentences
