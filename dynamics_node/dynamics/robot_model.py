"""`RobotModel`: the dynamics of one robot, for one state or many."""

import math
from typing import NamedTuple

import numpy as np

from ..errors import ArgumentError, SingularMassMatrixError
from ..kernels import closed_form
from ..kernels.packing import pack
from ..model import build_tree
from ..urdf import read_urdf

STANDARD_GRAVITY = (0.0, 0.0, -9.81)


class DynamicsTerms(NamedTuple):
    """
    The three terms of D(q) q̈ + C(q, q̇) q̇ + G(q) = τ.

    Attributes
    ----------
    mass_matrix : numpy.ndarray, shape (..., n, n)
        D, kg m² / kg m / kg.
    coriolis_matrix : numpy.ndarray, shape (..., n, n)
        C of Christoffel symbols, effort unit per velocity unit.
    gravity_torque : numpy.ndarray, shape (..., n)
        G, N m or N.

    """

    mass_matrix: np.ndarray
    coriolis_matrix: np.ndarray
    gravity_torque: np.ndarray


class RobotModel:
    """
    A robot with a fixed base: D(q) q̈ + C(q, q̇) q̇ + G(q) = τ.

    Frozen: another gravity makes another model. Every method takes arrays with leading batch
    axes and may be called from several threads. NaN in a position gives NaN in the answer.

    Revolute joints count in rad, rad/s, N m; prismatic ones in m, m/s, N. The base frame is the
    root link's frame.

    """

    def __init__(self, tree, gravity=STANDARD_GRAVITY):
        """
        Make the model of a kinematic tree; most users want `from_urdf`.

        Parameters
        ----------
        tree : KinematicTree
        gravity : array_like, shape (3,)
            Gravity acceleration in the base frame, m/s², points down.

        Raises
        ------
        ArgumentError
            If gravity is not three finite numbers.

        """
        self._tree = tree
        self._gravity = _gravity_vector(gravity)
        self._n = len(tree.joint_names)
        self._packed = pack(tree, self._gravity)

    @classmethod
    def from_urdf(cls, source, gravity=STANDARD_GRAVITY):
        """
        Make the model of a URDF.

        Parameters
        ----------
        source : str, bytes or os.PathLike
            A path or the URDF text itself. Meshes are never opened.
        gravity : array_like, shape (3,)
            Gravity acceleration in the root link's frame, m/s², points down.

        Returns
        -------
        RobotModel

        Raises
        ------
        RobotDescriptionError
            If the URDF cannot be used; lists every problem at once.
        ArgumentError
            If gravity is not three finite numbers.

        """
        return cls(build_tree(read_urdf(source)), gravity)

    def __repr__(self):
        return (f'RobotModel({self._n} joints, {self.total_mass:.6g} kg moving, '
                f'gravity {self._gravity.tolist()} m/s^2)')

    @property
    def joint_names(self):
        """Names of the n independent joints in the order of the URDF: the order of q."""
        return self._tree.joint_names

    @property
    def tree(self):
        """The tree of moving bodies, a `KinematicTree`."""
        return self._tree

    @property
    def gravity(self):
        """Gravity acceleration in the base frame, m/s², shape (3,), read-only."""
        return self._gravity

    @property
    def warnings(self):
        """What was accepted in the description but looks wrong, one sentence each."""
        return self._tree.warnings

    @property
    def total_mass(self):
        """Mass of everything that joints move, kg."""
        return float(self._tree.inertia[:, 3, 3].sum())

    @property
    def position_limits(self):
        """Lower and upper position limits, shape (n, 2), rad or m; infinite if none."""
        return self._tree.limits[:, :2]

    @property
    def velocity_limits(self):
        """Velocity limits, shape (n,), rad/s or m/s; NaN if the URDF states none."""
        return self._tree.limits[:, 2]

    @property
    def effort_limits(self):
        """Effort limits, shape (n,), N m or N; NaN if the URDF states none."""
        return self._tree.limits[:, 3]

    @property
    def neutral_position(self):
        """Zero, or the nearest position within the limits; shape (n,), rad or m."""
        return np.clip(np.zeros(self._n), self._tree.limits[:, 0], self._tree.limits[:, 1])

    def with_gravity(self, gravity):
        """
        Return the same robot under another gravity.

        Parameters
        ----------
        gravity : array_like, shape (3,)
            Gravity acceleration in the base frame, m/s², points down.

        Returns
        -------
        RobotModel

        Raises
        ------
        ArgumentError
            If gravity is not three finite numbers.

        """
        return RobotModel(self._tree, gravity)

    def mass_matrix(self, q):
        """
        Return the joint-space mass matrix D(q).

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.

        Returns
        -------
        numpy.ndarray, shape (..., n, n)
            Symmetric, kg m² / kg m / kg.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (15).

        """
        lead, [q] = self._states(q=q)
        out = np.empty((len(q), self._n, self._n))
        closed_form.mass_matrix(*self._packed, q, out)
        return out.reshape(*lead, self._n, self._n)

    def coriolis_matrix(self, q, qd):
        """
        Return the Coriolis matrix C(q, q̇) of Christoffel symbols: Ḋ = C + Cᵀ.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.

        Returns
        -------
        numpy.ndarray, shape (..., n, n)
            Effort unit per velocity unit: N m s/rad, N s/m or mixed.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equation (16).

        """
        return self.dynamics(q, qd).coriolis_matrix

    def gravity_torque(self, q):
        """
        Return the gravity torque G(q): the efforts that hold the robot still.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (17).

        """
        return self._gravity_block(q)[..., :-1]

    def potential_energy(self, q):
        """
        Return the potential energy V(q) of what joints move.

        Parameters
        ----------
        q : array_like, shape (..., n)
            Joint positions, rad or m.

        Returns
        -------
        numpy.ndarray, shape (...)
            J, zero at the base frame's origin. Links fixed to the base do not count.

        Raises
        ------
        ArgumentError
            If the last axis of q is not n.

        References
        ----------
        docs/mathematics.md, equation (20).

        """
        return self._gravity_block(q)[..., -1]

    def kinetic_energy(self, q, qd):
        """
        Return the kinetic energy T = ½ q̇ᵀ D(q) q̇.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.

        Returns
        -------
        numpy.ndarray, shape (...)
            J.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equation (20).

        """
        lead, [q, qd] = self._states(q=q, qd=qd)
        return 0.5 * np.einsum('bi,bij,bj->b', qd, self.mass_matrix(q), qd).reshape(lead)

    def dynamics(self, q, qd):
        """
        Return D, C and G in one pass.

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities; their batch axes broadcast.

        Returns
        -------
        DynamicsTerms
            Unpacks as D, C, G.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equations (15) to (17).

        """
        lead, [q, qd] = self._states(q=q, qd=qd)
        n, nn = self._n, self._n * self._n
        out = np.empty((len(q), 2 * nn + n + 1))
        closed_form.dynamics(*self._packed, q, qd, out)
        return DynamicsTerms(out[:, :nn].reshape(*lead, n, n),
                             out[:, nn:2 * nn].reshape(*lead, n, n),
                             out[:, 2 * nn:-1].reshape(*lead, n))

    def inverse_dynamics(self, q, qd, qdd):
        """
        Return the efforts of a motion, τ = D q̈ + C q̇ + G.

        Parameters
        ----------
        q, qd, qdd : array_like, shape (..., n)
            Joint positions (rad or m), velocities, accelerations; batch axes broadcast.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            N m or N.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.

        References
        ----------
        docs/mathematics.md, equation (1).

        """
        lead, [q, qd, qdd] = self._states(q=q, qd=qd, qdd=qdd)
        D, C, G = self.dynamics(q, qd)
        return (_times(D, qdd) + _times(C, qd) + G).reshape(*lead, self._n)

    def forward_dynamics(self, q, qd, tau):
        """
        Return the accelerations that efforts cause, q̈ = D⁻¹ (τ - C q̇ - G).

        Parameters
        ----------
        q, qd : array_like, shape (..., n)
            Joint positions (rad or m) and velocities.
        tau : array_like, shape (..., n)
            Joint efforts, N m or N; batch axes broadcast.

        Returns
        -------
        numpy.ndarray, shape (..., n)
            rad/s² or m/s².

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not fit.
        SingularMassMatrixError
            If D is not positive definite: a joint moves nothing that has inertia.

        References
        ----------
        docs/mathematics.md, equation (1), solved by a Cholesky factorisation of D.

        """
        lead, [q, qd, tau] = self._states(q=q, qd=qd, tau=tau)
        D, C, G = self.dynamics(q, qd)
        try:
            L = np.linalg.cholesky(D)
        except np.linalg.LinAlgError as error:
            raise SingularMassMatrixError(
                'the mass matrix is not positive definite, expected inertia behind every joint: '
                'check the <inertial> of the moving links') from error
        half = np.linalg.solve(L, (tau - _times(C, qd) - G)[..., None])
        return np.linalg.solve(L.swapaxes(-1, -2), half).reshape(*lead, self._n)

    def _gravity_block(self, q):
        lead, [q] = self._states(q=q)
        out = np.empty((len(q), self._n + 1))
        closed_form.gravity_torque(*self._packed, q, out)
        return out.reshape(*lead, self._n + 1)

    def _states(self, **values):
        # The batch axes, and each argument with shape (B, n). Always fresh C-ordered arrays:
        # numba compiles read-only or strided ones as a type of their own, and nobody should
        # wait for the compiler in the middle of a control loop.
        arrays = [np.array(value, dtype=float, order='C') for value in values.values()]
        for name, array in zip(values, arrays, strict=True):
            if array.shape[-1:] != (self._n,):
                raise ArgumentError(f'{name}: expected shape (..., {self._n}) for joints '
                                    f'{list(self.joint_names)}, got {array.shape}')
        if any(array.shape != arrays[0].shape for array in arrays):
            arrays = self._broadcast(values, arrays)
        lead = arrays[0].shape[:-1]
        count = math.prod(lead)
        return lead, [array.reshape(count, self._n) for array in arrays]

    @staticmethod
    def _broadcast(names, arrays):
        try:
            return [np.array(array, order='C') for array in np.broadcast_arrays(*arrays)]
        except ValueError as error:
            shapes = ', '.join(f'{name} {array.shape}'
                               for name, array in zip(names, arrays, strict=True))
            raise ArgumentError(f'expected batch axes that fit, got {shapes}') from error


def _times(matrix, vector):
    return np.einsum('bij,bj->bi', matrix, vector)


def _gravity_vector(value):
    vector = np.array(value, dtype=float)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise ArgumentError(f'gravity: expected three finite numbers, m/s^2, got {value!r}')
    vector.flags.writeable = False
    return vector
