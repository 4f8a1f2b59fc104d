"""A choice of joints in an order of one's own: rows and columns of the robot's matrices."""

from collections import Counter

import numpy as np

from ..errors import ArgumentError, quoted, suggestion

# Names that an error message lists: a request may have a million wrong ones.
_MOST_SHOWN = 5
_MOST_AVAILABLE = 50


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
        self._available = available
        self._leaders = {
            name: available[place]
            for name, place in zip(robot.tree.moving_joint_names, robot.tree.q_index, strict=True)
        }
        # Counted once: looking for each name among all takes seconds for ten thousand.
        count = Counter(self.names)
        known = set(available)
        wrong = self._unknown([name for name in count if name not in known], available)
        wrong += _listed([name for name in count if count[name] > 1], 'is given twice')
        if wrong:
            raise ArgumentError(
                f'joints: {"; ".join(wrong)}; available: '
                + ', '.join(available[:_MOST_AVAILABLE])
                + (', ...' if len(available) > _MOST_AVAILABLE else '')
            )
        place = {name: i for i, name in enumerate(available)}
        self.index = np.array([place[name] for name in self.names], dtype=np.intp)

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
        if len(names) != len(self.names) or set(names) != set(self.names):
            raise ArgumentError(
                f'joint_names: {"; ".join(self._differences(names))}; expected '
                f'each of {len(self.names)} joints once, or no name at all'
            )
        return np.array([self.names.index(name) for name in names], dtype=np.intp)

    def _differences(self, names):
        count, known = Counter(names), set(self.names)
        wrong = self._unknown([name for name in count if name not in known], self.names)
        wrong += _listed([name for name in count if count[name] > 1], 'is given twice')
        return wrong + _listed([name for name in self.names if name not in count], 'is missing')

    def _unknown(self, unknown, expected):
        # What is wrong with names that are none of the expected ones.
        movable = set(self._available)
        not_chosen = [name for name in unknown if name in movable]
        followers = [name for name in unknown if name in self._leaders and name not in movable]
        strange = [name for name in unknown if name not in self._leaders]
        return [
            *_listed(
                strange,
                'is not a joint that can be moved',
                lambda name: suggestion(name, expected),
            ),
            *_listed(not_chosen, 'is not one of the chosen joints'),
            *_listed(
                followers, 'follows', lambda name: f' {quoted(self._leaders[name])}: leave it out'
            ),
        ]


def _listed(names, what, rest=lambda name: ''):
    sentences = [f'{quoted(name)} {what}{rest(name)}' for name in names[:_MOST_SHOWN]]
    if len(names) > _MOST_SHOWN:
        sentences.append(f'and {len(names) - _MOST_SHOWN} more like these')
    return sentences
