"""Masses: a sphere and a box for each body; defects in red."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from . import colors
from .scale import Scale
from .shapes import BOX, Shape, SPHERE, TEXT
from ..errors import InertiaError
from ..inertia import equivalent_box, mass_and_com

CENTERS, BOXES, PROBLEMS = 'center_of_mass', 'inertia', 'problems'
# Smallest radius of a sphere, relative to that of the heaviest body: light bodies stay visible.
_MIN_RADIUS = 0.08


class BodyShapes:
    """
    Draws rigid bodies, each moving with one body of the robot.

    The volume of a sphere is proportional to the mass. A box of uniform density has the mass and
    the inertia of its body.

    """

    def __init__(
        self,
        names: Sequence[str],
        matrices: Sequence[NDArray[np.float64]],
        rows: Sequence[int],
        scale: Scale,
        *,
        groups: tuple[str, str] = (CENTERS, BOXES),
        color: tuple[colors.Color, colors.Color] = (colors.BODY, colors.INERTIA),
    ) -> None:
        """
        Compute sizes, boxes and defects; they do not depend on the pose.

        Parameters
        ----------
        names : sequence of str
            Names of the K bodies in texts.
        matrices : sequence of numpy.ndarray, shape (4, 4)
            Pseudo-inertia J of each, in the frame of the moving body of its row.
        rows : sequence of int
            Moving bodies that they move with.
        scale : Scale
        groups : (str, str)
            Groups of the spheres and of the boxes.
        color : (tuple, tuple)
            Colors of the spheres and of the boxes.

        """
        self._scale = scale
        self._groups, self._colors = groups, color
        self._names, self._rows = list(names), np.array(rows, dtype=np.int64)
        masses, coms = zip(*map(mass_and_com, matrices), strict=True) if len(names) else ((), ())
        self._masses = np.array(masses, dtype=float)
        self._com = np.ones((len(names), 4))
        self._com[:, :3] = np.array(coms).reshape(-1, 3)
        self._problems: dict[int, str] = {}
        self._box_size: dict[int, tuple[float, ...]] = {}
        self._box_rotation = np.tile(np.eye(3), (len(names), 1, 1))
        for k, matrix in enumerate(matrices):
            self._add_box(k, matrix)
        radii = scale.sphere * np.maximum(np.cbrt(self._masses / scale.heaviest), _MIN_RADIUS)
        self._sphere_size = [(2.0 * radius,) * 3 for radius in radii.tolist()]

    def _add_box(self, k: int, matrix: NDArray[np.float64]) -> None:
        if not self._masses[k] > 0.0:
            # Bodies without mass and inertia are common: frames between two joints.
            if matrix.any():
                self._problems[k] = 'inertia without mass'
            return
        try:
            box = equivalent_box(matrix)
        except InertiaError:
            self._problems[k] = 'no real body has this inertia'
            return
        self._box_size[k] = tuple(np.maximum(box.size, self._scale.thinnest).tolist())
        self._box_rotation[k] = box.pose[:3, :3]

    def shapes(self, poses: NDArray[np.float64]) -> Iterator[Shape]:
        """
        Yield the shapes of all bodies.

        Parameters
        ----------
        poses : numpy.ndarray, shape (N, 4, 4)
            Moving body → base, m.

        Yields
        ------
        Shape

        """
        if not self._names:
            return
        poses = poses[self._rows]
        positions = map(tuple, np.einsum('kij,kj->ki', poses[:, :3], self._com).tolist())
        rotation = Rotation.from_matrix(poses[:, :3, :3] @ self._box_rotation)
        orientations = map(tuple, rotation.as_quat().tolist())
        for k, (position, orientation) in enumerate(zip(positions, orientations, strict=True)):
            if self._masses[k] > 0.0:
                sphere_size = self._sphere_size[k]
                yield Shape(self._groups[0], k, SPHERE, sphere_size, self._colors[0], position)
            if k in self._box_size:
                group, number, size = self._groups[1], k + self._offset, self._box_size[k]
                yield Shape(group, number, BOX, size, self._colors[1], position, orientation)
            if k in self._problems:
                yield from self._problem_shapes(k, position)

    @property
    def _offset(self) -> int:
        # Spheres and boxes of one group need different numbers.
        return len(self._names) if self._groups[0] == self._groups[1] else 0

    def _problem_shapes(self, k: int, position: tuple[float, ...]) -> Iterator[Shape]:
        x, y, z = position
        size, above = (1.6 * self._scale.sphere,) * 3, (x, y, z + 2.5 * self._scale.text)
        text = f'{self._names[k]}: {self._problems[k]}'
        yield Shape(PROBLEMS, 2 * k, BOX, size, colors.PROBLEM, position)
        yield Shape(
            PROBLEMS, 2 * k + 1, TEXT, self._scale.text_size, colors.PROBLEM, above, text=text
        )
