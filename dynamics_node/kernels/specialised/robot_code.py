"""Machine code for one robot: compiled, kept on disk, compared before it is used."""

import ctypes
import os
import struct

import numpy as np

from . import call, code, functions, machine, quantities, store
from .sine import LARGEST_ANGLE
from .symbols import ProgramTooLongError
from .. import closed_form
from ..jit import compiled

# Batches of these quantities are computed several states at a time.
_BATCHED = ('dynamics', 'mass_matrix', 'gravity_torque', 'inverse_dynamics')

# How closely the results of the machine code must meet the general kernel's when it is loaded.
# Both are right to 1e-14 of the largest element; this tells damaged code from rounding.
_AGREEMENT = 1e-9

_SIZE = struct.Struct('<Q')

# What was loaded once stays: a robot's next model shares it.
_loaded: dict = {}


def is_wanted():
    """Return False if DYNAMICS_NODE_SPECIALISE=0 asks to do without machine code for robots."""
    return os.environ.get('DYNAMICS_NODE_SPECIALISE', '1') != '0'


class RobotCode:
    """
    The machine code of one robot.

    Attributes
    ----------
    lanes : int
        States that a batch function computes at once, the fewest that it takes.
    loaded : LoadedCode

    """

    def __init__(self, structure, numbers, object_files, any_inertia=False):
        """
        Load machine code and compare it with the general kernel.

        Parameters
        ----------
        structure, numbers : numpy.ndarray
            See `packing.pack`.
        object_files : bytes
            As `compile_robot` returns them.
        any_inertia : bool
            See `quantities`.

        Raises
        ------
        RuntimeError
            If it cannot be loaded or computes something else.

        """
        self.lanes = machine.lanes()
        self.loaded = machine.LoadedCode(
            _split(object_files),
            [
                *quantities.SIGNATURES,
                *(f'{name}_call' for name in quantities.SIGNATURES),
                *(f'{name}_batch' for name in _BATCHED),
            ],
        )
        self._batch = {
            name: self._function(f'{name}_batch', name, None, ctypes.c_int64) for name in _BATCHED
        }
        self._compare(structure, _loaded_everywhere(numbers) if any_inertia else numbers)

    def _function(self, symbol, name, result, *more):
        inputs, outputs = quantities.SIGNATURES[name]
        pointers = [ctypes.c_void_p] * (len(inputs) + 1 + outputs)
        return ctypes.CFUNCTYPE(result, *pointers, *more)(self.loaded.address(symbol))

    def batch(self, name, numbers, inputs, outputs):
        """
        Compute a quantity of many states; other threads run meanwhile.

        Parameters
        ----------
        name : str
            'dynamics', 'mass_matrix', 'gravity_torque' or 'inverse_dynamics'.
        numbers : numpy.ndarray
            See `packing.pack`: of this robot; with `any_inertia`, under any load.
        inputs, outputs : sequence of numpy.ndarray, shape (B, ...)
            Contiguous, float64; B is at least `lanes`. The outputs are overwritten.

        """
        arrays = [*inputs, numbers, *outputs]
        self._batch[name](*(array.ctypes.data for array in arrays), len(inputs[0]))

    def _compare(self, structure, numbers):
        # Every function at one state, which the batches get several times.
        n = closed_form.joint_count(structure)
        state = dict(
            zip(
                ('q', 'qd', 'qdd', 'tau'),
                np.random.default_rng(1).uniform(-1.0, 1.0, (4, 1, n)),
                strict=True,
            )
        )
        expected = _general(structure, numbers, state)
        for name, (inputs, _) in quantities.SIGNATURES.items():
            arguments = [state[key] for key in inputs]
            outputs = [np.empty_like(array) for array in expected[name]]
            function = self._function(name, name, ctypes.c_bool)
            pointers = [array.ctypes.data for array in (*arguments, numbers, *outputs)]
            if function(*pointers):
                _demand_agreement(name, outputs, expected[name])
            if name in _BATCHED:
                many = [np.repeat(array, self.lanes, axis=0) for array in expected[name]]
                self.batch(
                    name,
                    numbers,
                    [np.repeat(array, self.lanes, axis=0) for array in arguments],
                    many,
                )
                _demand_agreement(name, many, expected[name])


def _loaded_everywhere(numbers):
    # Every body gets a load of its own, of a size that fits the robot: so the comparison looks
    # at every input, at a mass matrix that is far from singular, and does not depend on whose
    # payload comes first.
    size = np.abs(numbers[:-1, closed_form.TRANSLATION : closed_form.AXIS]).max() or 1.0
    loaded = numbers.copy()
    body = loaded[:-1]
    body[:, closed_form.INERTIA] = 1.0
    body[:, closed_form.INERTIA + 1 : closed_form.INERTIA + 4] = size * np.array([0.1, -0.2, 0.3])
    body[:, closed_form.INERTIA + 4 : closed_form.MULTIPLIER] = size**2 * np.array(
        [1.0, 0.1, -0.2, 1.1, 0.3, 1.2]
    )
    body[:, closed_form.ROTOR] = size**2
    factor = np.linspace(1.0, 2.0, len(body))
    body[:, closed_form.INERTIA : closed_form.MULTIPLIER] *= factor[:, None]
    body[:, closed_form.ROTOR] *= factor
    loaded.flags.writeable = False  # a type that is compiled already
    return loaded


def _general(structure, numbers, state):
    q, qd, qdd, tau = (state[key] for key in ('q', 'qd', 'qdd', 'tau'))
    n = q.shape[1]
    D, C = np.empty((2, 1, n, n))
    G, efforts, accelerations, V = np.empty((1, n)), q.copy(), q.copy(), np.empty(1)
    closed_form.dynamics(structure, numbers, q, qd, D, C, G)
    closed_form.inverse_dynamics(structure, numbers, q, qd, qdd, efforts)
    closed_form.forward_dynamics(
        structure, numbers, q, qd, tau, accelerations, np.empty(1, dtype=bool)
    )
    closed_form.gravity_torque(structure, numbers, q, G, V)
    return {
        'dynamics': (D, C, G),
        'mass_matrix': (D,),
        'coriolis_matrix': (C,),
        'gravity_torque': (G,),
        'inverse_dynamics': (efforts,),
        'forward_dynamics': (accelerations,),
    }


def _demand_agreement(name, actual, expected):
    for mine, theirs in zip(actual, expected, strict=True):
        # Written so that NaN fails.
        if not np.abs(mine - theirs).max() <= _AGREEMENT * (np.abs(theirs).max() + 1e-3):
            raise RuntimeError(
                f'{name}: the machine code computes something else than the general kernel'
            )


def are_ordinary(name, inputs):
    """
    Return whether the machine code may be used: all numbers finite, no angle too large.

    Parameters
    ----------
    name : str
        Of the quantity.
    inputs : sequence of numpy.ndarray
        Its arguments.

    Returns
    -------
    bool

    """
    arguments, _ = quantities.SIGNATURES[name]
    return all(
        _is_below(values, LARGEST_ANGLE if argument == 'q' else call.LARGEST_NUMBER)
        for argument, values in zip(arguments, inputs, strict=True)
    )


@compiled
def _is_below(values, bound):
    # One look at each number; NaN is not below anything.
    below = True
    for b in range(values.shape[0]):
        for i in range(values.shape[1]):
            below &= abs(values[b, i]) < bound
    return below


def compile_robot(structure, numbers, any_inertia=False):
    """
    Compile the machine code of a robot.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    any_inertia : bool
        See `quantities`.

    Returns
    -------
    bytes or None
        Object files, one per quantity; None if the robot is too large for straight-line code.

    Raises
    ------
    RuntimeError
        If LLVM does not take the code.

    """
    lanes = machine.lanes()
    objects = []
    for record in quantities.ALL:
        try:
            quantity = record(structure, numbers, any_inertia)
        except ProgramTooLongError:
            return None
        parts = [
            *code.declarations(lanes),
            call.DECLARATIONS,
            functions.state_function(quantity),
            call.entry_function(quantity),
        ]
        if quantity.name in _BATCHED:
            parts.append(functions.batch_function(quantity, lanes))
        objects.append(machine.compile_code('\n'.join(parts)))
    return b''.join(_SIZE.pack(len(item)) + item for item in objects)


def _split(content):
    objects, at = [], 0
    while at < len(content):
        (size,) = _SIZE.unpack_from(content, at)
        at += _SIZE.size
        objects.append(content[at : at + size])
        at += size
    return objects


def from_disk(structure, numbers, any_inertia=False):
    """
    Return a robot's machine code if it was compiled before.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    any_inertia : bool
        See `quantities`.

    Returns
    -------
    RobotCode or None

    Raises
    ------
    RuntimeError
        If what is there cannot be loaded or computes something else.

    """
    name = store.key(structure, numbers, any_inertia)
    if name not in _loaded:
        object_files = store.load(name)
        if object_files is None:
            return None
        _loaded[name] = RobotCode(structure, numbers, object_files, any_inertia)
    return _loaded[name]


def make(structure, numbers, any_inertia=False):
    """
    Return a robot's machine code, from disk or compiled here and now, and kept.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    any_inertia : bool
        See `quantities`.

    Returns
    -------
    RobotCode or None
        None if the robot is too large for straight-line code.

    Raises
    ------
    RuntimeError
        If LLVM does not take the code, or it computes something else.

    """
    try:
        ready = from_disk(structure, numbers, any_inertia)
    except RuntimeError:
        ready = None
    if ready is None:
        object_files = compile_robot(structure, numbers, any_inertia)
        if object_files is None:
            return None
        name = store.key(structure, numbers, any_inertia)
        store.save(name, object_files)
        ready = _loaded[name] = RobotCode(structure, numbers, object_files, any_inertia)
    return ready
