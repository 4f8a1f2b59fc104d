"""Torques: an arc around the axis of a revolute joint, an arrow along that of a prismatic one."""

from collections.abc import Iterator, Sequence
import math

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from . import colors
from .scale import Scale
from .shapes import DISC, frame_around, LINE, Shape, TEXT
from ..model import KinematicTree

GRAVITY_TORQUE, EFFORT, JOINTS, TEXTS = 'gravity_torque', 'effort', 'joints', 'torque_text'
# Arc at the limit and longest arc, rad: an arc never closes.
FULL, LONGEST = 1.5 * math.pi, 1.95 * math.pi
# Shortest arc, rad: RViz refuses a line of length zero.
_SHORTEST = 0.01
# Relative to the reach: texts of joints closer than this are stacked.
_STACKED = 0.08
# Relative to the height of a text: distance between the lines of a stack.
_LINE_SPACING = 1.3
# Decimals of a text, before three significant digits: rounding errors read as zero.
_DECIMALS = 3
# Relative to the radius of a joint's arcs: radius and line width of each kind of arc.
_RADII = {GRAVITY_TORQUE: 0.8, EFFORT: 1.05}
_WIDTHS = {GRAVITY_TORQUE: 0.13, EFFORT: 0.07}
# Relative to the radius of a joint's arcs: length of an arrow at the limit, length of a barb.
_ARROW, _HEAD = 3.0, 0.28
# Largest angle between two points of an arc, rad.
_STEP = math.radians(15.0)


class TorqueArcs:
    """Draws gravity torques and efforts of joints."""

    def __init__(self, tree: KinematicTree, names: Sequence[str], scale: Scale) -> None:
        """
        Prepare all that does not depend on the state.

        Parameters
        ----------
        tree : KinematicTree
        names : sequence of str
            Names of the m joints, in the order of the efforts.
        scale : Scale

        """
        self._names, self._scale = list(names), scale
        rows = [tree.moving_joint_names.index(name) for name in names]
        self._rows = np.array(rows, dtype=np.int64)
        self._parents = tree.parent[self._rows]
        self._is_prismatic = tree.is_prismatic[self._rows].tolist()
        self._radius = [float(scale.arcs[row]) for row in rows]
        self._frames = np.array(
            [tree.joint_placement[row, :3, :3] @ frame_around(tree.axis[row]) for row in rows]
        ).reshape(-1, 3, 3)
        self._lift = _lifts(tree, rows, scale)

    def shapes(
        self,
        poses: NDArray[np.float64],
        gravity_torque: NDArray[np.float64],
        effort: NDArray[np.float64],
        limits: NDArray[np.float64],
    ) -> Iterator[Shape]:
        """
        Yield the shapes of one state.

        Parameters
        ----------
        poses : numpy.ndarray, shape (N, 4, 4)
            Moving body → base, m.
        gravity_torque : numpy.ndarray, shape (m,)
            N m or N, finite.
        effort : numpy.ndarray, shape (m,)
            N m or N; NaN where there is none.
        limits : numpy.ndarray, shape (m,)
            N m or N; NaN where there is none.

        Yields
        ------
        Shape

        """
        if not self._names:
            return
        frames = self._joint_frames(poses)
        orientations = [tuple(q) for q in Rotation.from_matrix(frames).as_quat().tolist()]
        positions = [tuple(p) for p in poses[self._rows, :3, 3].tolist()]
        bounds = [
            limit if limit > 0.0 and math.isfinite(limit) else math.nan
            for limit in limits.tolist()
        ]
        torques = gravity_torque.tolist()
        for i, radius in enumerate(self._radius):
            if not self._is_prismatic[i]:
                size = (2.2 * radius, 2.2 * radius, 0.02 * radius)
                yield Shape(JOINTS, i, DISC, size, colors.JOINT, positions[i], orientations[i])
        for group, values in ((GRAVITY_TORQUE, torques), (EFFORT, effort.tolist())):
            for i, load in enumerate(self._loads(values, bounds)):
                if math.isfinite(load):
                    is_unlimited = math.isnan(bounds[i])
                    yield self._line(group, i, load, is_unlimited, positions[i], orientations[i])
        x_axes = frames[:, :, 0]
        for i, torque in enumerate(torques):
            yield self._text(i, torque, bounds[i], positions[i], x_axes[i])

    def _joint_frames(self, poses: NDArray[np.float64]) -> NDArray[np.float64]:
        # Fixed to the parent, so that the start of an arc does not turn with the joint.
        has_parent = (self._parents >= 0)[:, None, None]
        return np.where(has_parent, poses[self._parents, :3, :3], np.eye(3)) @ self._frames

    def _loads(self, values: list[float], limits: list[float]) -> list[float]:
        # Relative to the limit; without one, to the largest effort of the same joint type.
        largest = {True: 0.0, False: 0.0}
        for value, is_prismatic in zip(values, self._is_prismatic, strict=True):
            if math.isfinite(value):
                largest[is_prismatic] = max(largest[is_prismatic], abs(value))
        return [
            value / ((largest[is_prismatic] or 1.0) if math.isnan(limit) else limit)
            for value, limit, is_prismatic in zip(values, limits, self._is_prismatic, strict=True)
        ]

    def _line(
        self,
        group: str,
        i: int,
        load: float,
        is_unlimited: bool,
        position: tuple[float, ...],
        orientation: tuple[float, ...],
    ) -> Shape:
        color = colors.UNLIMITED if is_unlimited else colors.of_load(abs(load))
        width = _WIDTHS[group] * self._radius[i]
        make_points = _arrow if self._is_prismatic[i] else _arc
        points = make_points(_RADII[group] * self._radius[i], load, self._radius[i])
        return Shape(group, i, LINE, (width,) * 3, color, position, orientation, tuple(points))

    def _text(
        self,
        i: int,
        torque: float,
        limit: float,
        position: tuple[float, ...],
        x_axis: NDArray[np.float64],
    ) -> Shape:
        # Opposite to the start of the arcs.
        x, y, z = (np.array(position) - 1.4 * self._radius[i] * x_axis).tolist()
        unit = 'N' if self._is_prismatic[i] else 'N m'
        share = '' if math.isnan(limit) else f' ({100.0 * abs(torque) / limit:.0f} %)'
        text = f'{self._names[i]}: {round(torque, _DECIMALS) + 0.0:.3g} {unit}{share}'
        above = (x, y, z + self._lift[i])
        return Shape(TEXTS, i, TEXT, self._scale.text_size, colors.TEXT, above, text=text)


def _lifts(tree, rows, scale):
    # Joints of a wrist are nearly at one place: each one's text is above that of the one before.
    lines = np.zeros(len(tree.parent) + 1)  # the last one is the base
    for k, parent in enumerate(tree.parent):
        if np.linalg.norm(tree.joint_placement[k, :3, 3]) < _STACKED * scale.reach and parent >= 0:
            lines[k] = lines[parent] + 1
    return [float(lines[row] * _LINE_SPACING * scale.text) for row in rows]


def _arc(at: float, load: float, radius: float) -> list[tuple[float, float, float]]:
    # About z, right-handed for a positive load, with two barbs at its end.
    angle = min(max(abs(load) * FULL, _SHORTEST), LONGEST)
    steps = max(math.ceil(angle / _STEP), 1)
    sign = -1.0 if load < 0.0 else 1.0
    points = [
        (at * math.cos(t), sign * at * math.sin(t), 0.0)
        for t in (angle * k / steps for k in range(steps + 1))
    ]
    back = angle - min(_HEAD * radius / at, angle)
    barbs = [
        ((at + side) * math.cos(back), sign * (at + side) * math.sin(back), 0.0)
        for side in (0.5 * _HEAD * radius, -0.5 * _HEAD * radius)
    ]
    return [*points, barbs[0], points[-1], barbs[1]]


def _arrow(at: float, load: float, radius: float) -> list[tuple[float, float, float]]:
    # Parallel to z, beside the axis.
    length = min(max(abs(load), _SHORTEST / FULL), LONGEST / FULL) * _ARROW * radius
    sign = -1.0 if load < 0.0 else 1.0
    head = min(_HEAD * radius, length)
    tip = (at, 0.0, sign * length)
    barbs = [(at + side, 0.0, sign * (length - head)) for side in (0.5 * head, -0.5 * head)]
    return [(at, 0.0, 0.0), tip, barbs[0], tip, barbs[1]]
