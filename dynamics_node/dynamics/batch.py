"""Checked arrays: shapes, batches, threads, and the choice between kernel and machine code."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
import math
import operator
import os
from typing import Any, NamedTuple, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..codegen import RobotCode, Specialization
from ..errors import ArgumentError, SingularMassMatrixError
from ..kernels import recursive
from ..kernels.packing import PackedModel
from ..model.tree import LinkFrame

Array = NDArray[np.float64]
Arrays = Sequence[Array]

# States that one thread computes per call: enough that the Python code between two pieces, which
# holds the global lock, is negligible; few enough to share the work evenly. One state outside the
# fast range sends its piece to the general kernel.
_PIECE = 8192

_FLOAT = np.dtype(np.float64)


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

    mass_matrix: Array
    coriolis_matrix: Array
    gravity_torque: Array


# Quantity → shapes of its arrays for one state, by the number of joints.
SHAPES: dict[str, Callable[[int], tuple[tuple[int, ...], ...]]] = {
    'dynamics': lambda n: ((n, n), (n, n), (n,)),
    'mass_matrix': lambda n: ((n, n),),
    'coriolis_matrix': lambda n: ((n, n),),
    'gravity_torque': lambda n: ((n,),),
    'inverse_dynamics': lambda n: ((n,),),
    'forward_dynamics': lambda n: ((n,),),
}


class Evaluation:
    """
    The dynamics of one robot under one gravity, for checked arrays.

    Attributes
    ----------
    packed : PackedModel
    specialization : Specialization
        Machine code for this robot; with a payload or rotors, its payload variant.

    """

    def __init__(
        self, packed: PackedModel, joint_names: tuple[str, ...], specialization: Specialization
    ):
        self.packed = packed
        self._arrays = packed.structure, packed.numbers
        self.specialization = specialization
        self._joint_names = joint_names
        self._n = len(joint_names)
        self._state_shape = (self._n,)
        self._shapes = {name: shapes(self._n) for name, shapes in SHAPES.items()}
        self._one_shapes = {
            name: tuple((1, *shape) for shape in shapes) for name, shapes in self._shapes.items()
        }

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.packed, self._joint_names, self.specialization)

    def states(self, **values: ArrayLike) -> tuple[tuple[int, ...], list[Array]]:
        """
        Check and broadcast arrays of joint values.

        Parameters
        ----------
        **values : array_like, shape (..., n)

        Returns
        -------
        batch_shape : tuple of int
            The batch axes.
        arrays : list of numpy.ndarray, shape (B, n)
            Contiguous, float64, B the product of the batch axes.

        Raises
        ------
        ArgumentError
            If a last axis is not n or batch axes do not broadcast.

        """
        arrays: list[Array] = [_as_float64_c(value) for value in values.values()]
        shape = arrays[0].shape
        if len(shape) == 1 and all(array.shape == self._state_shape for array in arrays):
            return (), [array[None] for array in arrays]
        if any(array.shape != shape for array in arrays) or shape[-1:] != (self._n,):
            arrays = self._broadcast(values, arrays)
            shape = arrays[0].shape
        count = math.prod(shape[:-1])
        return shape[:-1], [array.reshape(count, self._n) for array in arrays]

    def _broadcast(self, names: Mapping[str, ArrayLike], arrays: list[Array]) -> list[Array]:
        for name, array in zip(names, arrays, strict=True):
            if array.shape[-1:] != (self._n,):
                raise ArgumentError(
                    f'{name}: expected shape (..., {self._n}) for joints '
                    f'{list(self._joint_names)}, got {array.shape}'
                )
        return _broadcast_arrays(names, arrays)

    def dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        *,
        out: DynamicsTerms | None = None,
        threads: int | None = None,
    ) -> DynamicsTerms:
        """Return D, C and G, each with the batch axes of q and qd first."""
        if out is None and threads is None and self._is_state(q) and self._is_state(qd):
            return DynamicsTerms(*self._run_one('dynamics', q, qd))
        batch_shape, arrays = self.states(q=q, qd=qd)
        return DynamicsTerms(*self._run('dynamics', batch_shape, arrays, out, threads))

    def coriolis_matrix(self, q: ArrayLike, qd: ArrayLike, *, threads: int | None = None) -> Array:
        """Return C with the batch axes of q and qd first."""
        return self.dynamics(q, qd, threads=threads).coriolis_matrix

    def mass_matrix(
        self, q: ArrayLike, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Return D with the batch axes of q first."""
        if out is None and threads is None and self._is_state(q):
            return self._run_one('mass_matrix', q)[0]
        batch_shape, arrays = self.states(q=q)
        return self._run('mass_matrix', batch_shape, arrays, _one(out), threads)[0]

    def gravity_torque(
        self, q: ArrayLike, *, out: Array | None = None, threads: int | None = None
    ) -> Array:
        """Return G with the batch axes of q first."""
        if out is None and threads is None and self._is_state(q):
            return self._gravity_of_one(q)
        batch_shape, arrays = self.states(q=q)
        return self._run('gravity_torque', batch_shape, arrays, _one(out), threads)[0]

    def inverse_dynamics(
        self,
        q: ArrayLike,
        qd: ArrayLike,
        qdd: ArrayLike,
        *,
        out: Array | None = None,
        threads: int | None = None,
    ) -> Array:
        """Return the efforts of a motion with the batch axes of its arguments first."""
        batch_shape, arrays = self.states(q=q, qd=qd, qdd=qdd)
        return self._run('inverse_dynamics', batch_shape, arrays, _one(out), threads)[0]

    def forward_dynamics(
        self, q: ArrayLike, qd: ArrayLike, tau: ArrayLike, *, threads: int | None = None
    ) -> Array:
        """Return the accelerations caused by efforts, by a Cholesky factorization of D."""
        batch_shape, arrays = self.states(q=q, qd=qd, tau=tau)
        count = len(arrays[0])
        qdd, is_definite = np.empty_like(arrays[0]), np.empty(count, dtype=bool)
        if self.specialization.code is None:
            self.specialization.count(count)
        _in_pieces(
            lambda arrays, outputs: recursive.forward_dynamics(*self._arrays, *arrays, *outputs),
            arrays,
            [qdd, is_definite],
            count,
            threads,
        )
        if not is_definite.all():
            raise SingularMassMatrixError(
                'the mass matrix is not positive definite, expected inertia behind every joint: '
                'check the <inertial> of the moving links'
            )
        return qdd.reshape(*batch_shape, self._n)

    def regressor(
        self, q: ArrayLike, qd: ArrayLike, qdd: ArrayLike, *, threads: int | None = None
    ) -> Array:
        """Return the regressor of a motion with the batch axes of its arguments first."""
        batch_shape, arrays = self.states(q=q, qd=qd, qdd=qdd)
        shape = (self._n, 10 * self.packed.body_count)
        Y = np.empty((len(arrays[0]), *shape))
        _in_pieces(
            lambda arrays, outputs: recursive.regressor(*self._arrays, *arrays, *outputs),
            arrays,
            [Y],
            len(Y),
            threads,
        )
        return Y.reshape(*batch_shape, *shape)

    def kinetic_energy(self, q: ArrayLike, qd: ArrayLike) -> Array:
        """Return T with the batch axes of q and qd."""
        batch_shape, [q, qd] = self.states(q=q, qd=qd)
        return 0.5 * np.einsum('bi,bij,bj->b', qd, self.mass_matrix(q), qd).reshape(batch_shape)

    def potential_energy(self, q: ArrayLike) -> Array:
        """Return V with the batch axes of q."""
        batch_shape, [q] = self.states(q=q)
        G, V = np.empty((len(q), self._n)), np.empty(len(q))
        recursive.gravity_torque(*self._arrays, q, G, V)
        return V.reshape(batch_shape)

    def jacobian(self, q: ArrayLike, frame: LinkFrame, point: ArrayLike) -> Array:
        """Return the Jacobian of a point of a link (a `LinkFrame`), the batch axes of q first."""
        batch_shape, [q] = self.states(q=q)
        J = np.zeros((len(q), 6, self._n))
        if np.shape(point) != (3,):
            raise ArgumentError(f'point: expected three numbers, m, got {point!r}')
        if frame.body >= 0:
            inside = frame.placement[:3, :3] @ _as_float64_c(point) + frame.placement[:3, 3]
            recursive.jacobian(*self._arrays, q, frame.body, inside, J)
        return J.reshape(*batch_shape, 6, self._n)

    def body_poses(self, q: ArrayLike) -> Array:
        """Return the transforms of all N bodies to the base, the batch axes of q first."""
        batch_shape, [q] = self.states(q=q)
        poses = self._body_poses(q, np.arange(self.packed.body_count))
        return poses.reshape(*batch_shape, *poses.shape[1:])

    def _body_poses(self, q: Array, bodies: NDArray[np.int64]) -> Array:
        poses = np.zeros((len(q), len(bodies), 4, 4))
        upper = np.empty((len(q), len(bodies), 3, 4))
        recursive.body_poses(*self._arrays, q, bodies, upper)
        poses[:, :, :3], poses[:, :, 3, 3] = upper, 1.0
        return poses

    def link_pose(self, q: ArrayLike, frame: LinkFrame) -> Array:
        """Return the transform from a link (a `LinkFrame`) to the base, the batch axes first."""
        batch_shape, [q] = self.states(q=q)
        pose = np.empty((len(q), 4, 4))
        if frame.body >= 0:
            pose = self._body_poses(q, np.array([frame.body]))[:, 0] @ frame.placement
        else:
            pose[:] = frame.placement
        return pose.reshape(*batch_shape, 4, 4)

    def _run(
        self,
        name: str,
        batch_shape: tuple[int, ...],
        arrays: list[Array],
        out: Arrays | None,
        threads: int | None,
    ) -> Arrays:
        count, shapes = len(arrays[0]), self._shapes[name]
        if out is None:
            outputs = [np.empty((count, *shape)) for shape in shapes]
        else:
            _check_out(out, [(*batch_shape, *shape) for shape in shapes], arrays)
            outputs = [
                array.reshape(count, *shape) for array, shape in zip(out, shapes, strict=True)
            ]
        code = self.specialization.code
        if code is None:
            self.specialization.count(count)
        _in_pieces(
            lambda arrays, outputs: self._compute(code, name, arrays, outputs),
            arrays,
            outputs,
            count,
            threads,
        )
        if out is not None:
            return out
        if not batch_shape:
            return [output[0] for output in outputs]
        return [
            output.reshape(*batch_shape, *shape)
            for output, shape in zip(outputs, shapes, strict=True)
        ]

    def _is_state(self, array: Any) -> TypeGuard[Array]:
        return (
            type(array) is np.ndarray
            and array.shape == self._state_shape
            and array.dtype is _FLOAT
            and array.flags.carray
        )

    # One state, the case of a control loop, goes straight to the kernel: the checks of a batch
    # would take longer than the formulas. Machine code for one state replaces the whole method.

    def _gravity_of_one(self, q: Array) -> Array:
        if self.specialization.code is None:
            self.specialization.count(1)
        G = np.empty(self._n)
        recursive.gravity_torque_of_one(*self._arrays, q, G)
        return G

    def _run_one(self, name: str, *state: Array) -> list[Array]:
        if self.specialization.code is None:
            self.specialization.count(1)
        outputs = [np.empty(shape) for shape in self._one_shapes[name]]
        _KERNELS[name](*self._arrays, *[array[None] for array in state], *outputs)
        return [output[0] for output in outputs]

    def _compute(self, code: RobotCode | None, name: str, arrays: Arrays, outputs: Arrays) -> None:
        if code is None or not code.compute_batch(name, self.packed.numbers, arrays, outputs):
            _KERNELS[name](*self._arrays, *arrays, *outputs)


def _gravity_torque(structure: NDArray[np.int64], numbers: Array, q: Array, G: Array) -> None:
    recursive.gravity_torque(structure, numbers, q, G, np.empty(len(q)))


_KERNELS: dict[str, Callable[..., None]] = {
    'dynamics': recursive.dynamics,
    'mass_matrix': recursive.mass_matrix,
    'gravity_torque': _gravity_torque,
    'inverse_dynamics': recursive.inverse_dynamics,
}


def _in_pieces(
    compute: Callable[[Arrays, Sequence[NDArray[Any]]], None],
    arrays: Arrays,
    outputs: Sequence[NDArray[Any]],
    count: int,
    threads: int | None,
) -> None:
    # Call compute(rows of the arrays, rows of the outputs) for pieces of about equal size.
    pieces = math.ceil(count / _PIECE)
    if threads is not None:
        threads = _checked_threads(threads)
    if pieces <= 1:
        compute(arrays, outputs)
        return
    if threads is None:
        threads = len(os.sched_getaffinity(0)) if hasattr(os, 'sched_getaffinity') else 1

    def piece(i: int) -> None:
        rows = slice(count * i // pieces, count * (i + 1) // pieces)
        compute([array[rows] for array in arrays], [output[rows] for output in outputs])

    remaining = iter(range(pieces))

    def compute_remaining() -> None:
        for i in remaining:
            piece(i)

    helpers = min(threads, pieces) - 1
    if helpers == 0:
        compute_remaining()
        return
    with ThreadPoolExecutor(helpers) as pool:
        others = [pool.submit(compute_remaining) for _ in range(helpers)]
        compute_remaining()
        for other in others:
            other.result()


def _checked_threads(threads: int) -> int:
    try:
        threads = operator.index(threads)
    except TypeError:
        threads = 0
    if threads < 1:
        raise ArgumentError(
            'threads: expected an integer of at least 1, or None for the number of processors '
            'of this process'
        )
    return threads


def _one(out: Array | None) -> Arrays | None:
    return None if out is None else (out,)


def _check_out(arrays: Arrays, shapes: list[tuple[int, ...]], inputs: Arrays) -> None:
    if len(arrays) != len(shapes):
        raise ArgumentError(f'out: expected {len(shapes)} arrays, got {len(arrays)}')
    for array in arrays:
        if not (type(array) is np.ndarray and array.dtype == _FLOAT and array.flags.carray):
            raise ArgumentError(
                'out: expected writeable, contiguous float64 arrays, got '
                f'{type(array).__name__}; pass arrays returned by an earlier call'
            )
    if [array.shape for array in arrays] != shapes:
        raise ArgumentError(
            f'out: expected shapes {shapes}, got {[array.shape for array in arrays]}'
        )
    for i, array in enumerate(arrays):
        if any(np.may_share_memory(array, other) for other in (*inputs, *arrays[:i])):
            raise ArgumentError(
                'out: expected arrays of their own, got memory shared with an argument '
                'or another array of out'
            )


def _as_float64_c(value: ArrayLike) -> Array:
    # Arrays that are read-only or strided are copied: numba would compile the kernels for them
    # anew, in the middle of a control loop.
    if type(value) is np.ndarray and value.dtype is _FLOAT and value.flags.carray:
        return value
    return np.array(value, dtype=float, order='C')


def _broadcast_arrays(names: Mapping[str, ArrayLike], arrays: list[Array]) -> list[Array]:
    try:
        return [np.array(array, order='C') for array in np.broadcast_arrays(*arrays)]
    except ValueError as error:
        shapes = ', '.join(
            f'{name} {array.shape}' for name, array in zip(names, arrays, strict=True)
        )
        raise ArgumentError(f'expected batch axes that fit each other, got {shapes}') from error
