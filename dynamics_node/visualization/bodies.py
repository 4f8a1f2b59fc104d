"""Masses: a sphere and a box for every body, and what is wrong with it in red."""

import numpy as np

from . import colors
from .shapes import BOX, quaternions, Shape, SPHERE, TEXT
from ..errors import InertiaError
from ..inertia import equivalent_box, mass_and_com

CENTRES, BOXES, PROBLEMS = 'center_of_mass', 'inertia', 'problems'
# A sphere is at least that much of the one of the heaviest body: what is there must be seen.
_SMALLEST = 0.08


class Bodies:
    """
    What rigid bodies look like: each moves with one body of the robot.

    The volume of a sphere is proportional to the mass. A box has the mass and the inertia of
    its body, if it were of the same density all over.

    """

    def __init__(
        self,
        names,
        matrices,
        rows,
        sizes,
        *,
        groups=(CENTRES, BOXES),
        color=(colors.BODY, colors.INERTIA),
    ):
        """
        Look at the bodies once.

        Parameters
        ----------
        names : sequence of str
            Of the K bodies, for people.
        matrices : sequence of numpy.ndarray, shape (4, 4)
            J of each, in the frame of the moving body of its row.
        rows : sequence of int
            Moving bodies that they move with.
        sizes : Sizes
        groups : (str, str)
            Of the spheres and of the boxes.
        color : (tuple, tuple)
            Of the spheres and of the boxes.

        """
        self._sizes = sizes
        self._groups, self._colors = groups, color
        self._names, self._rows = list(names), np.array(rows, dtype=np.int64)
        masses, coms = zip(*map(mass_and_com, matrices), strict=True) if len(names) else ((), ())
        self._masses = np.array(masses, dtype=float)
        self._com = np.ones((len(names), 4))
        self._com[:, :3] = np.array(coms).reshape(-1, 3)
        self._problems, self._box_size = {}, {}
        self._box_rotation = np.tile(np.eye(3), (len(names), 1, 1))
        for k, matrix in enumerate(matrices):
            self._look_at(k, matrix)
        radii = sizes.sphere * np.maximum(np.cbrt(self._masses / sizes.heaviest), _SMALLEST)
        self._sphere_size = [(2.0 * radius,) * 3 for radius in radii.tolist()]

    def _look_at(self, k, matrix):
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
        self._box_size[k] = tuple(np.maximum(box.size, self._sizes.thinnest).tolist())
        self._box_rotation[k] = box.pose[:3, :3]

    def shapes(self, poses):
        """
        Say how they look, one shape after the other.

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
        places = [
            tuple(place) for place in np.einsum('kij,kj->ki', poses[:, :3], self._com).tolist()
        ]
        turns = quaternions(poses[:, :3, :3] @ self._box_rotation).tolist()
        for k, (place, turn) in enumerate(zip(places, turns, strict=True)):
            if self._masses[k] > 0.0:
                yield Shape(
                    self._groups[0], k, SPHERE, self._sphere_size[k], self._colors[0], place
                )
            if k in self._box_size:
                yield Shape(
                    self._groups[1],
                    k + self._offset,
                    BOX,
                    self._box_size[k],
                    self._colors[1],
                    place,
                    tuple(turn),
                )
            if k in self._problems:
                yield from self._problem(k, place)

    @property
    def _offset(self):
        # Spheres and boxes of one group must not have the same numbers.
        return len(self._names) if self._groups[0] == self._groups[1] else 0

    def _problem(self, k, place):
        above = (place[0], place[1], place[2] + 2.5 * self._sizes.text)
        return [
            Shape(PROBLEMS, 2 * k, BOX, (1.6 * self._sizes.sphere,) * 3, colors.PROBLEM, place),
            Shape(
                PROBLEMS,
                2 * k + 1,
                TEXT,
                self._sizes.text_size,
                colors.PROBLEM,
                above,
                text=f'{self._names[k]}: {self._problems[k]}',
            ),
        ]
