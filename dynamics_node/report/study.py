"""One robot under the lens: its model, the positions looked at, and the torques there."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .climb import Climber
from .sampling import sample_positions, sampling_ranges
from ..dynamics import one_off_model, RobotModel
from ..model import build_tree
from ..urdf import RobotDescription

# States that are asked for at once, in numbers: what fits into a cache.
_NUMBERS_AT_ONCE = 500_000
# So many of the samples are climbed from, up and down, for each joint: the best of all, and the
# best of so many parts of the samples, for the best of all may lie side by side below a lower top.
# With another inertia the top is seldom elsewhere.
STARTS, PARTS, PARTS_AGAIN = 8, 128, 32
# A joint that changes a torque by less than this share of it does not matter there.
_NOT_MATTERING = 1e-12
# Torques below this share of the weight of all that moves, at the length of all links in a row.
_ROUNDING = 1e-13


@dataclass(frozen=True)
class Study:
    """
    A robot and the positions at which it is looked at.

    Attributes
    ----------
    description : RobotDescription
    model : RobotModel
    ranges : numpy.ndarray, shape (n, 2)
        Where each joint is looked at, rad or m.
    range_notes : tuple of n str
    positions : numpy.ndarray, shape (S, n)
        The samples.

    """

    description: RobotDescription
    model: RobotModel
    ranges: np.ndarray
    range_notes: tuple
    positions: np.ndarray

    @classmethod
    def begin(cls, description, gravity, samples, seed):
        """
        Make the model of a description that is not refused, and draw the positions.

        Parameters
        ----------
        description : RobotDescription
        gravity : array_like, shape (3,)
            m/s², in the root link's frame.
        samples, seed : int

        Returns
        -------
        Study

        Raises
        ------
        RobotDescriptionError, ArgumentError
            As the model does.

        """
        model = one_off_model(build_tree(description), gravity)
        ranges, notes = sampling_ranges(model)
        return cls(description, model, ranges, notes, sample_positions(ranges, samples, seed))

    @cached_property
    def torques(self):
        """Gravity torques at the samples, shape (S, n), N m or N."""
        return self.model.gravity_torque(self.positions)

    @cached_property
    def climber(self):
        """Finds this robot's largest gravity torques."""
        return Climber(self.model, self.ranges)

    def starts(self, joint, torques=None, parts=PARTS):
        """
        Return samples at which a joint's torque is largest and smallest, from all over.

        Parameters
        ----------
        joint : int
        torques : numpy.ndarray, shape (S, n), optional
            Of another inertia.
        parts : int
            From so many parts of the samples.

        Returns
        -------
        positions : numpy.ndarray, shape (B, n)
        sign : numpy.ndarray, shape (B,)
            1 for the largest, -1 for the smallest.

        """
        own = (self.torques if torques is None else torques)[:, joint]
        order = np.argsort(own, kind='stable')
        pieces = np.array_split(np.arange(len(own)), min(parts, len(own)))
        low = np.unique([*order[:STARTS], *(piece[own[piece].argmin()] for piece in pieces)])
        high = np.unique([*order[-STARTS:], *(piece[own[piece].argmax()] for piece in pieces)])
        return (
            self.positions[np.concatenate((low, high))],
            np.repeat([-1.0, 1.0], [len(low), len(high)]),
        )

    @cached_property
    def worst(self):
        """Of each joint, position and signed torque where gravity pulls most: list of pairs."""
        return [self._worst(joint) for joint in range(len(self.model.joint_names))]

    def _worst(self, joint):
        if np.abs(self.torques[:, joint]).max() <= self.rounding:
            return self._readable(self.positions[0], joint, 0.0), 0.0
        position, torque = self.climber.climb(joint, *self.starts(joint))
        torque = torque if abs(torque) > self.rounding else 0.0
        return self._readable(position, joint, torque), torque

    def _readable(self, position, joint, torque):
        # Joints that do not matter stand where they are in the middle of things, and not where
        # the sample happened to have them.
        position = position.copy()
        for other, neutral in enumerate(self.model.neutral_position):
            trial = position.copy()
            trial[other] = neutral
            change = self.model.gravity_torque(trial)[joint] - torque
            if abs(change) <= max(_NOT_MATTERING * abs(torque), self.rounding):
                position = trial
        return position

    @cached_property
    def rounding(self):
        """What is smaller than this is no torque but rounding, N m or N."""
        tree = self.model.tree
        lengths = np.linalg.norm(tree.joint_placement[:, :3, 3], axis=1).sum() + np.abs(
            tree.inertia[:, :3, 3]
        ).sum() / max(self.model.moving_mass, 1e-300)
        weight = self.model.moving_mass * float(np.linalg.norm(self.model.gravity))
        return _ROUNDING * weight * max(lengths, 1.0)

    def worst_with(self, model, joint):
        """
        Return the largest gravity torque of a joint with other inertia: (position, torque).

        Parameters
        ----------
        model : RobotModel
            Of the same joints.
        joint : int

        """
        torques = model.gravity_torque(self.positions)
        starts, sign = self.starts(joint, torques, PARTS_AGAIN)
        before = self.worst[joint][0]
        return self.climber.with_model(model).climb(
            joint,
            np.concatenate((starts, before[None], before[None])),
            np.concatenate((sign, [1.0, -1.0])),
        )

    def with_inertials(self, inertials):
        """
        Return the model of the robot with other inertial parameters of some links.

        Parameters
        ----------
        inertials : dict of str to Inertial or None
            By the names of the links.

        Returns
        -------
        RobotModel

        """
        links = tuple(
            replace(link, inertial=inertials[link.name]) if link.name in inertials else link
            for link in self.description.links
        )
        tree = build_tree(replace(self.description, links=links))
        return one_off_model(tree, self.model.gravity)

    def joints_under(self, link):
        """Return the indices of the independent joints that carry a link, the nearest first."""
        tree, found = self.model.tree, []
        body = tree.links[link].body
        while body >= 0:
            joint = int(tree.q_index[body])
            if joint not in found:
                found.append(joint)
            body = tree.parent[body]
        return found

    def batches(self, numbers_per_state, count=None):
        """
        Yield slices over the samples, so that their answers stay small.

        Parameters
        ----------
        numbers_per_state : int
        count : int, optional
            Over the first so many.

        """
        count = len(self.positions) if count is None else min(count, len(self.positions))
        size = max(1, _NUMBERS_AT_ONCE // max(1, numbers_per_state))
        for first in range(0, count, size):
            yield slice(first, min(first + size, count))
