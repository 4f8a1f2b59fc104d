"""Sampled workspace analysis of one robot: positions, gravity torques and worst cases."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .worst_case_search import CoordinateAscent
from ..dynamics import RobotModel
from ..model import build_tree
from ..model.tree import PRISMATIC
from ..urdf import Inertial, RobotDescription

# Upper bound of the numbers in the result of one batch, so that it fits into the cache.
_NUMBERS_AT_ONCE = 500_000
# Number of extreme samples from which the search starts, per joint and sign.
STARTS = 8
# The extreme sample of each part of the samples is a start too: the best samples may all lie
# below a lower maximum.
PARTS = 128
# The same for a changed inertia, which rarely moves the maximum.
PARTS_AGAIN = 32
# A joint that changes a torque by less than this share of it does not affect it.
_NEGLIGIBLE = 1e-12
# Rounding error of a torque, as a share of the moving weight times the summed link lengths.
_ROUNDING = 1e-13


@dataclass(frozen=True)
class WorkspaceAnalysis:
    """
    A robot model with the positions at which it is evaluated.

    Attributes
    ----------
    description : RobotDescription
    model : RobotModel
    ranges : numpy.ndarray, shape (n, 2)
        Range of positions of each joint, rad or m.
    range_notes : tuple of n str
        See `sampling_ranges`.
    positions : numpy.ndarray, shape (S, n)
        The samples, rad or m.

    """

    description: RobotDescription
    model: RobotModel
    ranges: NDArray[np.float64]
    range_notes: tuple[str, ...]
    positions: NDArray[np.float64]

    @classmethod
    def from_description(
        cls, description: RobotDescription, gravity: ArrayLike, samples: int, seed: int
    ) -> WorkspaceAnalysis:
        """
        Build the model of a valid description and draw the positions.

        Parameters
        ----------
        description : RobotDescription
        gravity : array_like, shape (3,)
            m/s², in the root link's frame.
        samples, seed : int

        Returns
        -------
        WorkspaceAnalysis

        Raises
        ------
        RobotDescriptionError, ArgumentError
            As `RobotModel` does.

        """
        model = RobotModel(build_tree(description), gravity, compile=False)
        ranges, notes = sampling_ranges(model)
        return cls(description, model, ranges, notes, sample_positions(ranges, samples, seed))

    @cached_property
    def torques(self) -> NDArray[np.float64]:
        """Gravity torques at the samples, shape (S, n), N m or N."""
        return self.model.gravity_torque(self.positions)

    @cached_property
    def search(self) -> CoordinateAscent:
        """Search for the largest gravity torques of this robot."""
        return CoordinateAscent(self.model, self.ranges)

    def starts(
        self, joint: int, torques: NDArray[np.float64] | None = None, parts: int = PARTS
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        Return the samples at which a joint's torque is largest and smallest.

        Parameters
        ----------
        joint : int
            Index into the n joints.
        torques : numpy.ndarray, shape (S, n), optional
            Gravity torques of a model with another inertia, N m or N.
        parts : int
            Number of parts of the samples that contribute their own extremes.

        Returns
        -------
        positions : numpy.ndarray, shape (B, n)
            rad or m.
        sign : numpy.ndarray, shape (B,)
            1 for the largest, -1 for the smallest.

        """
        own = (self.torques if torques is None else torques)[:, joint]
        order = np.argsort(own, kind='stable')
        pieces = np.array_split(np.arange(len(own)), min(parts, len(own)))
        low = np.unique([*order[:STARTS], *(piece[np.argmin(own[piece])] for piece in pieces)])
        high = np.unique([*order[-STARTS:], *(piece[np.argmax(own[piece])] for piece in pieces)])
        return (
            self.positions[np.concatenate((low, high))],
            np.repeat([-1.0, 1.0], [len(low), len(high)]),
        )

    @cached_property
    def worst(self) -> list[tuple[NDArray[np.float64], float]]:
        """Position and signed torque of the largest gravity torque of each joint."""
        return [self._worst(joint) for joint in range(len(self.model.joint_names))]

    def _worst(self, joint: int) -> tuple[NDArray[np.float64], float]:
        if np.abs(self.torques[:, joint]).max() <= self.rounding:
            return self._neutral_where_irrelevant(self.positions[0], joint, 0.0), 0.0
        position, torque = self.search.maximize(joint, *self.starts(joint))
        torque = torque if abs(torque) > self.rounding else 0.0
        return self._neutral_where_irrelevant(position, joint, torque), torque

    def _neutral_where_irrelevant(
        self, position: NDArray[np.float64], joint: int, torque: float
    ) -> NDArray[np.float64]:
        # A joint without effect on the torque goes to its neutral position: a reported pose with
        # random angles in it is hard to read.
        position = position.copy()
        for other, neutral in enumerate(self.model.neutral_position):
            trial = position.copy()
            trial[other] = neutral
            change = self.model.gravity_torque(trial)[joint] - torque
            if abs(change) <= max(_NEGLIGIBLE * abs(torque), self.rounding):
                position = trial
        return position

    @cached_property
    def rounding(self) -> float:
        """Torque below which a result is rounding error, N m or N."""
        tree = self.model.tree
        lengths = np.linalg.norm(tree.joint_placement[:, :3, 3], axis=1).sum() + np.abs(
            tree.inertia[:, :3, 3]
        ).sum() / max(self.model.moving_mass, 1e-300)
        weight = self.model.moving_mass * float(np.linalg.norm(self.model.gravity))
        return _ROUNDING * weight * max(lengths, 1.0)

    def worst_with(self, model: RobotModel, joint: int) -> tuple[NDArray[np.float64], float]:
        """
        Return the largest gravity torque of a joint of a model with another inertia.

        Parameters
        ----------
        model : RobotModel
            With the same joints.
        joint : int
            Index into the n joints.

        Returns
        -------
        position : numpy.ndarray, shape (n,)
            rad or m.
        torque : float
            Signed, N m or N.

        """
        torques = model.gravity_torque(self.positions)
        starts, sign = self.starts(joint, torques, PARTS_AGAIN)
        before = self.worst[joint][0]
        return self.search.with_model(model).maximize(
            joint,
            np.concatenate((starts, before[None], before[None])),
            np.concatenate((sign, [1.0, -1.0])),
        )

    def with_inertials(self, inertials: Mapping[str, Inertial | None]) -> RobotModel:
        """
        Return the model of the robot with other inertial parameters of some links.

        Parameters
        ----------
        inertials : mapping of str to Inertial or None
            By link name; None removes the inertial parameters.

        Returns
        -------
        RobotModel

        """
        links = tuple(
            replace(link, inertial=inertials[link.name]) if link.name in inertials else link
            for link in self.description.links
        )
        tree = build_tree(replace(self.description, links=links))
        return RobotModel(tree, self.model.gravity, compile=False)

    def supporting_joints(self, link: str) -> list[int]:
        """Return the indices of the independent joints that carry a link, the nearest first."""
        tree = self.model.tree
        joints: list[int] = []
        body = tree.links[link].body
        while body >= 0:
            joint = int(tree.q_index[body])
            if joint not in joints:
                joints.append(joint)
            body = tree.parent[body]
        return joints

    def batches(self, numbers_per_state: int, count: int | None = None) -> Iterator[slice]:
        """
        Yield slices over the samples that bound the memory of one evaluation.

        Parameters
        ----------
        numbers_per_state : int
            Size of the result for one sample.
        count : int, optional
            Number of samples to cover, by default all.

        Yields
        ------
        slice

        """
        count = len(self.positions) if count is None else min(count, len(self.positions))
        size = max(1, _NUMBERS_AT_ONCE // max(1, numbers_per_state))
        for first in range(0, count, size):
            yield slice(first, min(first + size, count))


def prismatic_joints(model: RobotModel) -> list[bool]:
    """Return whether each independent joint is prismatic, in the order of q."""
    tree = model.tree
    types = dict(zip(tree.moving_joint_names, tree.joint_type.tolist(), strict=True))
    return [types[name] == PRISMATIC for name in model.joint_names]


def sampling_ranges(model: RobotModel) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """
    Return the range of positions in which each joint is sampled.

    Parameters
    ----------
    model : RobotModel

    Returns
    -------
    ranges : numpy.ndarray, shape (n, 2)
        rad or m. Without limits: one turn for a rotating joint, the neutral position alone for a
        prismatic one.
    notes : tuple of n str
        What replaces missing limits; '' where both limits are finite.

    """
    ranges, notes = np.array(model.position_limits), []
    for i, is_prismatic in enumerate(prismatic_joints(model)):
        lower, upper = ranges[i]
        if np.isfinite([lower, upper]).all():
            notes.append('')
        elif is_prismatic:
            ranges[i] = model.neutral_position[i]
            notes.append(f'without limits: only evaluated at {ranges[i, 0]:g} m')
        else:
            if np.isfinite(lower):
                ranges[i] = lower, lower + math.tau
            elif np.isfinite(upper):
                ranges[i] = upper - math.tau, upper
            else:
                ranges[i] = -math.pi, math.pi
            notes.append('without limits: evaluated over one turn')
    return ranges, tuple(notes)


def sample_positions(ranges: NDArray[np.float64], count: int, seed: int) -> NDArray[np.float64]:
    """
    Draw random positions.

    Parameters
    ----------
    ranges : numpy.ndarray, shape (n, 2)
        See `sampling_ranges`.
    count, seed : int

    Returns
    -------
    numpy.ndarray, shape (count, n)
        Uniform and independent, rad or m; the same for the same seed.

    """
    rng = np.random.default_rng(seed)
    lower, upper = ranges.T
    return lower + rng.random((count, len(ranges))) * (upper - lower)
