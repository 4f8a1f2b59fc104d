"""Selected joints in the user's order: rows and columns of the robot's matrices."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import ArgumentError, quoted, suggestion

if TYPE_CHECKING:
    from .robot_model import RobotModel

# Wrong names that an error message lists: a request may have a million.
_MAX_WRONG = 5
# Available names that an error message lists.
_MAX_AVAILABLE = 50


class JointSelection:
    """
    Joints of a robot selected by the user, in the user's order.

    The other joints are locked at given positions; their links keep their mass.

    Attributes
    ----------
    names : tuple of str
        m joint names.
    index : numpy.ndarray of int, shape (m,)
        Their places in the robot's q.

    """

    def __init__(self, robot: RobotModel, names: Sequence[str] = ()):
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
            If a name is unknown, belongs to a fixed or mimic joint, or is given twice.

        """
        available = robot.joint_names
        self.names = tuple(names) or available
        self._available = available
        self._leaders = {
            name: available[place]
            for name, place in zip(robot.tree.moving_joint_names, robot.tree.q_index, strict=True)
        }
        # Counting once takes linear time; comparing each name with all others takes seconds for
        # ten thousand.
        count = Counter(self.names)
        known = set(available)
        wrong = self._unknown([name for name in count if name not in known], available)
        wrong += _listed([name for name in count if count[name] > 1], 'is given twice')
        if wrong:
            raise ArgumentError(
                f'joints: {"; ".join(wrong)}; available: '
                + ', '.join(available[:_MAX_AVAILABLE])
                + (', ...' if len(available) > _MAX_AVAILABLE else '')
            )
        place = {name: i for i, name in enumerate(available)}
        self.index = np.array([place[name] for name in self.names], dtype=np.intp)

    def permutation(self, names: Sequence[str]) -> NDArray[np.intp]:
        """
        Return the place of each name in this selection.

        Parameters
        ----------
        names : sequence of str
            Empty: this selection's order. Otherwise a permutation of its names.

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

    def _differences(self, names: Iterable[str]) -> list[str]:
        count, known = Counter(names), set(self.names)
        wrong = self._unknown([name for name in count if name not in known], self.names)
        wrong += _listed([name for name in count if count[name] > 1], 'is given twice')
        return wrong + _listed([name for name in self.names if name not in count], 'is missing')

    def _unknown(self, unknown: Sequence[str], expected: Sequence[str]) -> list[str]:
        # Reasons why these names are not among the expected ones.
        movable = set(self._available)
        not_selected = [name for name in unknown if name in movable]
        followers = [name for name in unknown if name in self._leaders and name not in movable]
        not_joints = [name for name in unknown if name not in self._leaders]
        return [
            *_listed(
                not_joints,
                'is not a joint that can be moved',
                lambda name: suggestion(name, expected),
            ),
            *_listed(not_selected, 'is not one of the chosen joints'),
            *_listed(
                followers, 'follows', lambda name: f' {quoted(self._leaders[name])}: leave it out'
            ),
        ]


def _listed(
    names: Sequence[str], problem: str, detail: Callable[[str], str] = lambda name: ''
) -> list[str]:
    sentences = [f'{quoted(name)} {problem}{detail(name)}' for name in names[:_MAX_WRONG]]
    if len(names) > _MAX_WRONG:
        sentences.append(f'and {len(names) - _MAX_WRONG} more like these')
    return sentences
