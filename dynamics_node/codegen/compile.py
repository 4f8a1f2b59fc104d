"""Machine code of one robot: compiled, kept, loaded, and compared with the general kernel."""

from collections.abc import Callable, Sequence
import ctypes
import os
import struct
from types import MethodType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import disk_cache, llvm_ir, llvm_target, python_entry, trace
from .sine import LARGEST_ANGLE
from .trace import ProgramTooLongError
from ..kernels import recursive
from ..kernels.jit import compiled
from ..kernels.packing import PackedModel

# Quantities with a function for batches, which computes several states at a time.
_BATCHED = ('dynamics', 'mass_matrix', 'gravity_torque', 'inverse_dynamics')

# Largest difference between machine code and general kernel, relative to the largest element.
# Both are right to 1e-14; this bound separates damaged code from rounding.
_AGREEMENT = 1e-9

_SIZE = struct.Struct('<Q')

# Cache key → code. It is never unloaded; the next model of the same robot shares it.
_loaded: dict[str, 'RobotCode'] = {}


def is_wanted() -> bool:
    """Return False if DYNAMICS_NODE_SPECIALIZE=0 turns machine code for robots off."""
    return os.environ.get('DYNAMICS_NODE_SPECIALIZE', '1') != '0'


class RobotCode:
    """
    The machine code of one robot, loaded.

    Attributes
    ----------
    lanes : int
        Number of states that a batch function computes at once, and the smallest batch.

    """

    def __init__(self, packed: PackedModel, object_files: bytes):
        """
        Load machine code and compare it with the general kernel.

        Parameters
        ----------
        packed : PackedModel
        object_files : bytes
            Returned by `compile_robot`.

        Raises
        ------
        RuntimeError
            If it cannot be loaded or its results differ from those of the general kernel.

        """
        self.lanes = llvm_target.lanes()
        self._addresses = llvm_target.load(
            _split(object_files),
            [
                *trace.SIGNATURES,
                *(f'{name}_call' for name in trace.SIGNATURES),
                *(f'{name}_batch' for name in _BATCHED),
            ],
        )
        self._batch = {
            name: self._function(f'{name}_batch', name, None, ctypes.c_int64) for name in _BATCHED
        }
        numbers = packed.numbers
        self._compare(
            packed.structure, _with_test_loads(numbers) if packed.payload_variant else numbers
        )

    def _function(self, symbol: str, name: str, result: Any, *more: Any) -> Callable[..., Any]:
        inputs, outputs = trace.SIGNATURES[name]
        pointers = [ctypes.c_void_p] * (len(inputs) + 1 + outputs)
        return ctypes.CFUNCTYPE(result, *pointers, *more)(self._addresses[symbol])

    def python_entry(
        self,
        name: str,
        shapes: Sequence[tuple[int, ...]],
        fallback: MethodType,
        documentation: str | None,
        terms_type: type,
        numbers: NDArray[np.float64],
    ) -> Callable[..., Any]:
        """Return a builtin function of one state; see `python_entry.make_callable`."""
        return python_entry.make_callable(
            self._addresses[f'{name}_call'],
            name,
            shapes,
            fallback,
            documentation,
            terms_type,
            numbers,
        )

    def compute_batch(
        self,
        name: str,
        numbers: NDArray[np.float64],
        inputs: Sequence[NDArray[np.float64]],
        outputs: Sequence[NDArray[np.float64]],
    ) -> bool:
        """
        Compute a quantity of many states, if its machine code covers them.

        Other threads run meanwhile.

        Parameters
        ----------
        name : str
            'dynamics', 'mass_matrix', 'gravity_torque' or 'inverse_dynamics'.
        numbers : numpy.ndarray
            See `PackedModel`: of this robot; in the payload variant, with any payload.
        inputs, outputs : sequence of numpy.ndarray, shape (B, ...)
            Contiguous, float64. The outputs are overwritten.

        Returns
        -------
        bool
            False, and nothing is computed, for fewer than `lanes` states or inputs outside the
            fast range: the general kernel has to compute these.

        """
        if len(inputs[0]) < self.lanes or not within_fast_range(name, inputs):
            return False
        arrays = [*inputs, numbers, *outputs]
        self._batch[name](*(array.ctypes.data for array in arrays), len(inputs[0]))
        return True

    def _compare(self, structure: NDArray[np.int64], numbers: NDArray[np.float64]) -> None:
        # Every function at one state; the batches get it several times.
        n = recursive.joint_count(structure)
        state = dict(
            zip(
                ('q', 'qd', 'qdd', 'tau'),
                np.random.default_rng(1).uniform(-1.0, 1.0, (4, 1, n)),
                strict=True,
            )
        )
        expected = _general(structure, numbers, state)
        for name, (inputs, _) in trace.SIGNATURES.items():
            arguments = [state[key] for key in inputs]
            outputs = [np.empty_like(array) for array in expected[name]]
            function = self._function(name, name, ctypes.c_bool)
            pointers = [array.ctypes.data for array in (*arguments, numbers, *outputs)]
            if function(*pointers):
                _require_agreement(name, outputs, expected[name])
            if name in _BATCHED:
                # This call compiles the range check too, here and not in a control loop.
                repeated = [np.repeat(array, self.lanes, axis=0) for array in expected[name]]
                self.compute_batch(
                    name,
                    numbers,
                    [np.repeat(array, self.lanes, axis=0) for array in arguments],
                    repeated,
                )
                _require_agreement(name, repeated, expected[name])


def _with_test_loads(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    # Every body gets a different load of a size that fits the robot. So the comparison covers
    # every input, the mass matrix is far from singular, and the result does not depend on the
    # payload of the model that comes first.
    size = np.abs(numbers[:-1, recursive.TRANSLATION : recursive.AXIS]).max() or 1.0
    loaded = numbers.copy()
    body = loaded[:-1]
    body[:, recursive.INERTIA] = 1.0
    body[:, recursive.INERTIA + 1 : recursive.INERTIA + 4] = size * np.array([0.1, -0.2, 0.3])
    body[:, recursive.INERTIA + 4 : recursive.MULTIPLIER] = size**2 * np.array(
        [1.0, 0.1, -0.2, 1.1, 0.3, 1.2]
    )
    body[:, recursive.ROTOR] = size**2
    factor = np.linspace(1.0, 2.0, len(body))
    body[:, recursive.INERTIA : recursive.MULTIPLIER] *= factor[:, None]
    body[:, recursive.ROTOR] *= factor
    loaded.flags.writeable = False  # the array type for which the kernels are compiled already
    return loaded


def _general(
    structure: NDArray[np.int64],
    numbers: NDArray[np.float64],
    state: dict[str, NDArray[np.float64]],
) -> dict[str, tuple[NDArray[np.float64], ...]]:
    q, qd, qdd, tau = (state[key] for key in ('q', 'qd', 'qdd', 'tau'))
    n = q.shape[1]
    D, C = np.empty((2, 1, n, n))
    G, efforts, accelerations, V = np.empty((1, n)), q.copy(), q.copy(), np.empty(1)
    recursive.dynamics(structure, numbers, q, qd, D, C, G)
    recursive.inverse_dynamics(structure, numbers, q, qd, qdd, efforts)
    recursive.forward_dynamics(
        structure, numbers, q, qd, tau, accelerations, np.empty(1, dtype=bool)
    )
    recursive.gravity_torque(structure, numbers, q, G, V)
    return {
        'dynamics': (D, C, G),
        'mass_matrix': (D,),
        'coriolis_matrix': (C,),
        'gravity_torque': (G,),
        'inverse_dynamics': (efforts,),
        'forward_dynamics': (accelerations,),
    }


def _require_agreement(
    name: str, actual: Sequence[NDArray[np.float64]], expected: Sequence[NDArray[np.float64]]
) -> None:
    for result, reference in zip(actual, expected, strict=True):
        # In this form NaN fails too.
        if not np.abs(result - reference).max() <= _AGREEMENT * (np.abs(reference).max() + 1e-3):
            raise RuntimeError(
                f'{name}: the machine code computes something else than the general kernel'
            )


def within_fast_range(name: str, inputs: Sequence[NDArray[np.float64]]) -> bool:
    """
    Return whether the machine code covers the inputs: finite numbers, no angle too large.

    Parameters
    ----------
    name : str
        Of the quantity.
    inputs : sequence of numpy.ndarray, shape (B, n)
        Its arguments.

    Returns
    -------
    bool

    """
    arguments, _ = trace.SIGNATURES[name]
    return all(
        _is_below(values, LARGEST_ANGLE if argument == 'q' else python_entry.LARGEST_NUMBER)
        for argument, values in zip(arguments, inputs, strict=True)
    )


@compiled
def _is_below(values: NDArray[np.float64], bound: float) -> bool:
    # One pass without temporary arrays. NaN fails the comparison.
    below = True
    for b in range(values.shape[0]):
        for i in range(values.shape[1]):
            below &= abs(values[b, i]) < bound
    return below


def compile_robot(packed: PackedModel) -> bytes | None:
    """
    Compile the machine code of a robot.

    Parameters
    ----------
    packed : PackedModel

    Returns
    -------
    bytes or None
        Object files, one per quantity; None if the robot is too large for straight-line code.

    Raises
    ------
    RuntimeError
        If LLVM rejects the code.

    """
    width = llvm_target.lanes()
    objects = []
    for record in trace.ALL:
        try:
            quantity = record(packed)
        except ProgramTooLongError:
            return None
        parts = [
            *llvm_ir.declarations(width),
            python_entry.DECLARATIONS,
            llvm_ir.state_function(quantity),
            python_entry.entry_function(quantity),
        ]
        if quantity.name in _BATCHED:
            parts.append(llvm_ir.batch_function(quantity, width))
        objects.append(llvm_target.compile_code('\n'.join(parts)))
    return b''.join(_SIZE.pack(len(item)) + item for item in objects)


def _split(content: bytes) -> list[bytes]:
    objects, at = [], 0
    while at < len(content):
        (size,) = _SIZE.unpack_from(content, at)
        at += _SIZE.size
        objects.append(content[at : at + size])
        at += size
    return objects


def from_disk(packed: PackedModel) -> RobotCode | None:
    """
    Return a robot's machine code if it was compiled before.

    Parameters
    ----------
    packed : PackedModel

    Returns
    -------
    RobotCode or None

    Raises
    ------
    RuntimeError
        If the file cannot be loaded or its results differ from those of the general kernel.

    """
    name = disk_cache.key(packed)
    if name not in _loaded:
        object_files = disk_cache.load(name)
        if object_files is None:
            return None
        _loaded[name] = RobotCode(packed, object_files)
    return _loaded[name]


def make(packed: PackedModel) -> RobotCode | None:
    """
    Return a robot's machine code from disk, or compile it in this process and keep it on disk.

    Parameters
    ----------
    packed : PackedModel

    Returns
    -------
    RobotCode or None
        None if the robot is too large for straight-line code.

    Raises
    ------
    RuntimeError
        If LLVM rejects the code, or its results differ from those of the general kernel.

    """
    try:
        code = from_disk(packed)
    except RuntimeError:
        code = None
    if code is None:
        object_files = compile_robot(packed)
        if object_files is None:
            return None
        name = disk_cache.key(packed)
        disk_cache.save(name, object_files)
        code = _loaded[name] = RobotCode(packed, object_files)
    return code
