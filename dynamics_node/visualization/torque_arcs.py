"""Torques: an arc around every joint's axis, an arrow along that of a prismatic one."""

import math

import numpy as np

from . import colors
from .shapes import DISC, frame_around, LINE, quaternions, Shape, TEXT

GRAVITY_TORQUE, EFFORT, JOINTS, TEXTS = 'gravity_torque', 'effort', 'joints', 'torque_text'
# An arc of three quarters of a turn is the limit; it never closes.
FULL, LONGEST = 1.5 * math.pi, 1.95 * math.pi
# Nothing is drawn with no length at all.
_SHORTEST = 0.01
# Of the reach: joints nearer to each other than that have texts in lines so much higher each.
_NEAR, _LINE = 0.08, 1.3
# Nobody reads more, and what is only rounding is zero.
_DECIMALS = 3
# Of the radius of a joint's arcs: where gravity's and the other one are, their widths, and the
# length of an arrow at the limit.
_PLACES = {GRAVITY_TORQUE: 0.8, EFFORT: 1.05}
_WIDTHS = {GRAVITY_TORQUE: 0.13, EFFORT: 0.07}
_ARROW, _HEAD, _STEP = 3.0, 0.28, math.radians(15.0)


class Torques:
    """What the efforts of some joints look like."""

    def __init__(self, tree, names, sizes):
        """
        Look at the joints once.

        Parameters
        ----------
        tree : KinematicTree
        names : sequence of str
            Of the m joints that efforts will be given for.
        sizes : Sizes

        """
        self._names, self._sizes = list(names), sizes
        rows = [tree.moving_joint_names.index(name) for name in names]
        self._rows = np.array(rows, dtype=np.int64)
        self._parents = tree.parent[self._rows]
        self._is_prismatic = tree.is_prismatic[self._rows].tolist()
        self._radius = [float(sizes.arcs[row]) for row in rows]
        self._frames = np.array(
            [tree.joint_placement[row, :3, :3] @ frame_around(tree.axis[row]) for row in rows]
        ).reshape(-1, 3, 3)
        self._lift = _lifts(tree, rows, sizes)

    def shapes(self, poses, gravity_torque, effort, limits):
        """
        Say how efforts look at one state, one shape after the other.

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
        # The axes of a joint do not turn with it: where an arc begins stays where it is.
        parents = np.where(
            (self._parents >= 0)[:, None, None], poses[self._parents, :3, :3], np.eye(3)
        )
        turned = parents @ self._frames
        turns = [tuple(turn) for turn in quaternions(turned).tolist()]
        places = [tuple(place) for place in poses[self._rows, :3, 3].tolist()]
        limits = [
            limit if limit > 0.0 and math.isfinite(limit) else math.nan
            for limit in limits.tolist()
        ]
        for i, radius in enumerate(self._radius):
            if not self._is_prismatic[i]:
                yield Shape(
                    JOINTS,
                    i,
                    DISC,
                    (2.2 * radius, 2.2 * radius, 0.02 * radius),
                    colors.JOINT,
                    places[i],
                    turns[i],
                )
        gravity_torque = gravity_torque.tolist()
        for group, values in ((GRAVITY_TORQUE, gravity_torque), (EFFORT, effort.tolist())):
            loads = self._loads(values, limits)
            for i, load in enumerate(loads):
                if math.isfinite(load):
                    yield self._line(group, i, load, math.isnan(limits[i]), places[i], turns[i])
        across = turned[:, :, 0].tolist()
        for i, value in enumerate(gravity_torque):
            out = -1.4 * self._radius[i]  # where the arcs do not begin
            x, y, z = (p + out * a for p, a in zip(places[i], across[i], strict=True))
            place = (x, y, z + self._lift[i])
            yield Shape(
                TEXTS,
                i,
                TEXT,
                self._sizes.text_size,
                colors.TEXT,
                place,
                text=self._text(i, value, limits[i]),
            )

    def _loads(self, values, limits):
        # Of the limit; where there is none, of the largest effort of its kind.
        largest = [
            max(
                (
                    abs(value)
                    for value, kind in zip(values, self._is_prismatic, strict=True)
                    if kind == wanted and math.isfinite(value)
                ),
                default=0.0,
            )
            or 1.0
            for wanted in (False, True)
        ]
        return [
            value / (largest[kind] if math.isnan(limit) else limit)
            for value, limit, kind in zip(values, limits, self._is_prismatic, strict=True)
        ]

    def _line(self, group, i, load, is_unlimited, place, turn):
        color = colors.UNLIMITED if is_unlimited else colors.of_load(abs(load))
        width = _WIDTHS[group] * self._radius[i]
        points = (_arrow if self._is_prismatic[i] else _arc)(
            _PLACES[group] * self._radius[i], load, self._radius[i]
        )
        return Shape(group, i, LINE, (width,) * 3, color, place, turn, tuple(points))

    def _text(self, i, value, limit):
        unit = 'N' if self._is_prismatic[i] else 'N m'
        part = '' if math.isnan(limit) else f' ({100.0 * abs(value) / limit:.0f} %)'
        return f'{self._names[i]}: {round(value, _DECIMALS) + 0.0:.3g} {unit}{part}'


def _lifts(tree, rows, sizes):
    # Joints of a wrist are nearly at one place: each one's text is above that of the one before.
    lines = np.zeros(len(tree.parent) + 1)  # the last one is the base
    for k, parent in enumerate(tree.parent):
        if np.linalg.norm(tree.joint_placement[k, :3, 3]) < _NEAR * sizes.reach and parent >= 0:
            lines[k] = lines[parent] + 1
    return [float(lines[row] * _LINE * sizes.text) for row in rows]


def _arc(at, load, radius):
    # About z, in the sense of the right hand for a positive load, with two barbs at its end.
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


def _arrow(at, load, radius):
    # Along z, beside the axis.
    length = min(max(abs(load), _SHORTEST / FULL), LONGEST / FULL) * _ARROW * radius
    sign = -1.0 if load < 0.0 else 1.0
    head = min(_HEAD * radius, length)
    tip = (at, 0.0, sign * length)
    barbs = [(at + side, 0.0, sign * (length - head)) for side in (0.5 * head, -0.5 * head)]
    return [(at, 0.0, 0.0), tip, barbs[0], tip, barbs[1]]
