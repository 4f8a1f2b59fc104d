"""Machine code for one robot: made in the background, kept on disk, checked before it is used."""

import ctypes
import os
import struct
import threading

import numpy as np

from . import call, code, functions, machine, quantities, store
from .sine import LARGEST_ANGLE
from .symbols import ProgramTooLongError
from .. import closed_form

# Batches of these quantities are computed several states at a time.
_BATCHED = ('dynamics', 'mass_matrix', 'gravity_torque', 'inverse_dynamics')

# How closely the result of the machine code must meet the general kernel's when it is loaded. Both
# are right to 1e-14; this tells damaged code from rounding.
_AGREEMENT = 1e-9

_SIZE = struct.Struct('<Q')
_abandoned = threading.Event()


def abandon():
    """Make no more machine code in this process: what is being made ends after its next step."""
    _abandoned.set()


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

    def __init__(self, structure, numbers, object_files):
        """
        Load machine code and compare it with the general kernel.

        Parameters
        ----------
        structure, numbers : numpy.ndarray
            See `packing.pack`.
        object_files : bytes
            As `compile_robot` returns them.

        Raises
        ------
        RuntimeError
            If it cannot be loaded or computes something else.

        """
        self.lanes = machine.lanes()
        self.loaded = machine.LoadedCode(_split(object_files))
        self._batch = {name: self._batch_function(name) for name in _BATCHED}
        self._compare(structure, numbers)

    def _batch_function(self, name):
        inputs, outputs = quantities.SIGNATURES[name]
        pointers = [ctypes.c_void_p] * (len(inputs) + 1 + outputs)
        return ctypes.CFUNCTYPE(None, *pointers, ctypes.c_int64)(
            self.loaded.address(f'{name}_batch'))

    def batch(self, name, gravity, inputs, outputs):
        """
        Compute a quantity of many states; other threads run meanwhile.

        Parameters
        ----------
        name : str
            'dynamics', 'mass_matrix', 'gravity_torque' or 'inverse_dynamics'.
        gravity : numpy.ndarray, shape (3,)
            m/s², base frame.
        inputs, outputs : sequence of numpy.ndarray, shape (B, ...)
            Contiguous, float64; B is at least `lanes`. The outputs are overwritten.

        """
        arrays = [*inputs, gravity, *outputs]
        self._batch[name](*(array.ctypes.data for array in arrays), len(inputs[0]))

    def _compare(self, structure, numbers):
        n = int(structure[:, 2].max()) + 1
        q, qd = np.random.default_rng(1).uniform(-1.0, 1.0, (2, self.lanes, n))
        shape = (self.lanes, n, n)
        expected = np.empty(shape), np.empty(shape), np.empty((self.lanes, n))
        actual = np.empty(shape), np.empty(shape), np.empty((self.lanes, n))
        closed_form.dynamics(structure, numbers, q, qd, *expected)
        self.batch('dynamics', numbers[-1, :3].copy(), (q, qd), actual)
        for mine, theirs in zip(actual, expected, strict=True):
            if not np.abs(mine - theirs).max() <= _AGREEMENT * (np.abs(theirs).max() + 1e-3):
                raise RuntimeError('the machine code computes something else than the general '
                                   f'kernel; remove it from {store.folder()}')


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
    for argument, values in zip(arguments, inputs, strict=True):
        bound = LARGEST_ANGLE if argument == 'q' else call.LARGEST_NUMBER
        # Written so that NaN fails.
        if not (values.max(initial=0.0) < bound and values.min(initial=0.0) > -bound):
            return False
    return True


def compile_robot(structure, numbers):
    """
    Compile the machine code of a robot.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.

    Returns
    -------
    bytes or None
        Object files, one per quantity; None if the robot is too large for straight-line code, or
        after `abandon`.

    Raises
    ------
    RuntimeError
        If LLVM does not take the code.

    """
    lanes = machine.lanes()
    objects = []
    for record in quantities.ALL:
        if _abandoned.is_set():
            return None
        try:
            quantity = record(structure, numbers)
        except ProgramTooLongError:
            return None
        parts = [*code.declarations(lanes), call.DECLARATIONS,
                 functions.state_function(quantity), call.entry_function(quantity)]
        if quantity.name in _BATCHED:
            parts.append(functions.batch_function(quantity, lanes))
        objects.append(machine.compile_code('\n'.join(parts)))
    return b''.join(_SIZE.pack(len(item)) + item for item in objects)


def _split(content):
    objects, at = [], 0
    while at < len(content):
        size, = _SIZE.unpack_from(content, at)
        at += _SIZE.size
        objects.append(content[at:at + size])
        at += size
    return objects


def from_disk(structure, numbers):
    """
    Return a robot's machine code if it was compiled before.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.

    Returns
    -------
    RobotCode or None

    """
    object_files = store.load(store.key(structure, numbers))
    if object_files is None:
        return None
    try:
        return RobotCode(structure, numbers, object_files)
    except RuntimeError:
        return None


def make(structure, numbers):
    """
    Return a robot's machine code, from disk or compiled and kept there.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.

    Returns
    -------
    RobotCode or None
        None if the robot is too large for straight-line code, or after `abandon`.

    Raises
    ------
    RuntimeError
        If LLVM does not take the code.

    """
    ready = from_disk(structure, numbers)
    if ready is not None:
        return ready
    object_files = compile_robot(structure, numbers)
    if object_files is None:
        return None
    store.save(store.key(structure, numbers), object_files)
    return RobotCode(structure, numbers, object_files)


def make_in_background(structure, numbers, when_ready):
    """
    Make a robot's machine code in a thread of its own.

    Parameters
    ----------
    structure, numbers : numpy.ndarray
        See `packing.pack`.
    when_ready : callable
        Called in that thread with the RobotCode, or None if there is none to be had.

    Returns
    -------
    threading.Thread
        Python waits for it at exit, some seconds at most, unless `abandon` was called.

    """
    def work():
        try:
            when_ready(make(structure, numbers))
        except RuntimeError:
            when_ready(None)

    thread = threading.Thread(target=work, name='dynamics_node specialise')
    thread.start()
    return thread
