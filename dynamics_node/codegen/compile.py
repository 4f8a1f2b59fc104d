"""The processor here: what its code is called, how LLVM code becomes its code, and loading it."""

import ctypes
import functools
import os
import struct

import llvmlite
import llvmlite.binding as llvm
import numpy as np

from . import disk_cache, llvm_ir, python_entry, trace
from .sine import LARGEST_ANGLE
from .trace import ProgramTooLongError
from ..kernels import recursive
from ..kernels.jit import compiled

_SPEED = 2


@functools.cache
def _host():
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features()


def description():
    """Return what machine code depends on: versions of LLVM, processor and its features."""
    name, features = _host()
    version = '.'.join(map(str, llvm.llvm_version_info))
    return f'llvmlite {llvmlite.__version__} LLVM {version} {name} {features.flatten()}'


def lanes():
    """
    Return how many states are computed side by side.

    Four with AVX: eight, where there is AVX-512, are slower, because what has to be kept between
    the operations no longer fits into the cache beside the code.

    """
    _, features = _host()
    return 4 if features.get('avx') else 2


def _target():
    name, features = _host()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=name, features=features.flatten(), opt=_SPEED, codemodel='jitdefault', jit=True
    )


def compile_code(text):
    """
    Compile LLVM code.

    Parameters
    ----------
    text : str

    Returns
    -------
    bytes
        An object file.

    Raises
    ------
    RuntimeError
        If LLVM does not take the code.

    """
    module, target = llvm.parse_assembly(text), _target()
    # LLVM's passes over the code are left out: it comes without loops and repetitions, and they
    # find nothing. Looking for sums to pack into vectors takes most of their time, and what it
    # packs runs more slowly.
    return target.emit_object(module)


class LoadedCode:
    """
    Machine code in memory, where it stays.

    It is never freed: when garbage is collected, the finalizers of those who still call it may
    run after its own.

    """

    def __init__(self, object_files, names):
        """
        Load object files.

        Parameters
        ----------
        object_files : sequence of bytes
            As `compile_code` returns them.
        names : iterable of str
            Of the functions that are wanted.

        Raises
        ------
        RuntimeError
            If LLVM cannot load them, or a function is not there.

        """
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(''), _target())
        for object_file in object_files:
            engine.add_object_file(llvm.ObjectFileRef.from_data(object_file))
        engine.finalize_object()
        self._addresses = {name: engine.get_function_address(name) for name in names}
        engine.detach()
        missing = [name for name, address in self._addresses.items() if not address]
        if missing:
            raise RuntimeError(f'expected machine code of {", ".join(missing)}, got none')

    def address(self, name):
        """Return the address of a function."""
        return self._addresses[name]


# Batches of these quantities are computed several states at a time.
_BATCHED = ('dynamics', 'mass_matrix', 'gravity_torque', 'inverse_dynamics')

# How closely the results of the machine code must meet the general kernel's when it is loaded.
# Both are right to 1e-14 of the largest element; this tells damaged code from rounding.
_AGREEMENT = 1e-9

_SIZE = struct.Struct('<Q')

# What was loaded once stays: a robot's next model shares it.
_loaded: dict = {}


def is_wanted():
    """Return False if DYNAMICS_NODE_SPECIALIZE=0 asks to do without machine code for robots."""
    return os.environ.get('DYNAMICS_NODE_SPECIALIZE', '1') != '0'


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
        self.lanes = lanes()
        self.loaded = LoadedCode(
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
        self._compare(structure, _loaded_everywhere(numbers) if any_inertia else numbers)

    def _function(self, symbol, name, result, *more):
        inputs, outputs = trace.SIGNATURES[name]
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
        n = recursive.joint_count(structure)
        state = dict(
            zip(
                ('q', 'qd', 'qdd', 'tau'),
                np.random.default_rng(1).uniform(-1.0, 1.0, (4, 1, n)),
                strict=True,
            )
        )
        expected = _general(structure, numbers, state)
        are_ordinary('dynamics', [state['q'], state['qd']])  # compiled now, not in a control loop
        for name, (inputs, _) in trace.SIGNATURES.items():
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
    loaded.flags.writeable = False  # a type that is compiled already
    return loaded


def _general(structure, numbers, state):
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
    arguments, _ = trace.SIGNATURES[name]
    return all(
        _is_below(values, LARGEST_ANGLE if argument == 'q' else python_entry.LARGEST_NUMBER)
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
    width = lanes()
    objects = []
    for record in trace.ALL:
        try:
            quantity = record(structure, numbers, any_inertia)
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
        objects.append(compile_code('\n'.join(parts)))
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
    name = disk_cache.key(structure, numbers, any_inertia)
    if name not in _loaded:
        object_files = disk_cache.load(name)
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
        name = disk_cache.key(structure, numbers, any_inertia)
        disk_cache.save(name, object_files)
        ready = _loaded[name] = RobotCode(structure, numbers, object_files, any_inertia)
    return ready
