"""
The Python entry point, compiled too: builtin functions that call the machine code of one robot.

For one state of a small arm, the arithmetic takes less time than passing five arrays through
Python and numba. So each quantity gets an entry in the same machine code, which checks the
arguments, takes the arrays of the answer and computes. It covers positional arguments that are
contiguous float64 arrays of shape (n,) with finite numbers. All others (lists, batches, keywords,
wrong shapes, NaN) go to the fallback, a Python method, which converts them or raises.

Allocating the arrays of an answer takes as long as computing a small arm. So each entry keeps a
few answers and reuses one when, by its reference counts, neither it nor one of its arrays is
referenced elsewhere. Returned arrays are never overwritten while referenced. (A finalizer set on
an answer by `weakref.finalize` may therefore run as late as the end of the model.)

The entry reads arguments by the memory layout of numpy and CPython (`PyArrayObject` and
`PyMethodDef`, both public and unchanged for many years). `is_supported` checks this layout.

"""

from collections.abc import Callable, Iterable, Sequence
import ctypes
import functools
import inspect
import sys
import sysconfig
from types import MethodType
from typing import Any
import weakref

import numpy as np
from numpy.typing import NDArray

from .llvm_ir import Code
from .sine import LARGEST_ANGLE
from .trace import Quantity

# Offsets of fields from the start of the object, bytes.
_REFERENCES, _TYPE = 0, 8
_DATA, _DIMENSION_COUNT, _DIMENSIONS, _DESCRIPTION, _FLAGS, _WEAK = 16, 24, 32, 56, 64, 72
_CONTIGUOUS_AND_ALIGNED = 0x101  # NPY_ARRAY_C_CONTIGUOUS | NPY_ARRAY_ALIGNED
_REUSABLE = 0x505  # the same | NPY_ARRAY_OWNDATA | NPY_ARRAY_WRITEABLE
_FLOAT64 = 12  # NPY_DOUBLE
_METHOD_FLAGS = 0x80 | 0x02  # METH_FASTCALL | METH_KEYWORDS
_PYARRAY_NEW = 93  # index in numpy's table of C functions

# Largest velocity, acceleration or effort that the machine code covers: beyond it, and for NaN,
# the general kernel answers.
LARGEST_NUMBER = 1e100

# Slots of the context, 8 bytes each: addresses of Python's and numpy's objects and functions.
_SLOTS = (
    'fallback',
    'array_type',
    'float64',
    'terms_type',
    'new_array',
    'new_object',
    'set_item',
    'release',
    'call',
    'numbers',
)
# Slot of the first kept answer; each answer is followed by its arrays.
_KEPT = len(_SLOTS)
# Answers kept: a loop that refers to the last two still finds a free one.
_ANSWERS = 4


def entry_function(quantity: Quantity) -> str:
    """
    Return the LLVM function that Python calls.

    Parameters
    ----------
    quantity : Quantity
        One output becomes an array, more become a tuple of the context's `terms_type`.

    Returns
    -------
    str

    """
    entry = _Entry(quantity)
    entry.check_arguments()
    for place in range(_ANSWERS):
        entry.take_kept(place)
    entry.make_new()
    entry.compute()
    entry.fall_back()
    return '\n'.join(
        [
            f'define ptr @{quantity.name}_call(ptr %self, ptr %arguments, i64 %count, ptr '
            '%keywords) {',
            'entry:',
            *entry.code.lines,
            '}',
        ]
    )


class _Entry:
    # The LLVM code of the entry of one quantity, part by part.

    def __init__(self, quantity: Quantity):
        self.code = Code()
        self.quantity = quantity
        self.arrays: list[str] = []
        self.data: list[str] = []
        self._labels = 0
        # Stack memory is allocated in the first block, so once per call.
        self.shapes = [
            self.code.line(f'alloca [{output.ndim} x i64]') for output in quantity.outputs
        ]
        self.out = [self.code.line('alloca ptr') for _ in quantity.outputs]
        self.answer = self.code.line('alloca ptr')
        self.context = self.load('ptr', '%self', _DATA)

    def load(self, kind: str, pointer: str, offset: int) -> str:
        address = self.code.line(f'getelementptr i8, ptr {pointer}, i64 {offset}')
        return self.code.line(f'load {kind}, ptr {address}')

    def slot(self, name: str) -> str:
        return self.load('ptr', self.context, 8 * _SLOTS.index(name))

    def label(self) -> str:
        self._labels += 1
        return f'step{self._labels}'

    def require(self, condition: str, otherwise: str = 'slow') -> None:
        # Continue if the condition holds, otherwise jump.
        label = self.label()
        self.code.do(f'br i1 {condition}, label %{label}, label %{otherwise}')
        self.code.lines.append(f'{label}:')

    def all_of(self, conditions: Iterable[str]) -> str:
        return functools.reduce(lambda a, b: self.code.line(f'and i1 {a}, {b}'), conditions)

    def equal(self, kind: str, a: str, b: str | int) -> str:
        return self.code.line(f'icmp eq {kind} {a}, {b}')

    def check_arguments(self) -> None:
        quantity = self.quantity
        self.require(
            self.all_of(
                [
                    self.equal('i64', '%count', len(quantity.inputs)),
                    self.equal('ptr', '%keywords', 'null'),
                ]
            )
        )
        array_type, float64 = self.slot('array_type'), self.slot('float64')
        for index in range(len(quantity.inputs)):
            argument = self.load('ptr', '%arguments', 8 * index)
            self.require(self.equal('ptr', self.load('ptr', argument, _TYPE), array_type))
            flags = self.code.line(
                f'and i32 {self.load("i32", argument, _FLAGS)}, {_CONTIGUOUS_AND_ALIGNED}'
            )
            self.require(
                self.all_of(
                    [
                        self.equal('ptr', self.load('ptr', argument, _DESCRIPTION), float64),
                        self.equal('i32', self.load('i32', argument, _DIMENSION_COUNT), 1),
                        self.equal('i32', flags, _CONTIGUOUS_AND_ALIGNED),
                    ]
                )
            )
            length = self.load('i64', self.load('ptr', argument, _DIMENSIONS), 0)
            self.require(self.equal('i64', length, quantity.joint_count))
            self.data.append(self.load('ptr', argument, _DATA))
        self.require(
            self.all_of(
                [
                    self._is_in_range(name, data)
                    for name, data in zip(quantity.inputs, self.data, strict=True)
                ]
            )
        )

    def _is_in_range(self, name: str, data: str) -> str:
        # NaN fails the comparison.
        code, bound = self.code, LARGEST_ANGLE if name == 'q' else LARGEST_NUMBER
        conditions = []
        for index in range(self.quantity.joint_count):
            number = self.load('double', data, 8 * index)
            size = code.line(f'call double @llvm.fabs.f64(double {number})')
            conditions.append(code.line(f'fcmp olt double {size}, {code.constant(bound)}'))
        return self.all_of(conditions)

    def take_kept(self, place: int) -> None:
        # Reuse a kept answer if the only reference to it, and to each of its arrays, is ours.
        code, outputs = self.code, self.quantity.outputs
        stride = 8 * (1 + len(outputs))
        offset = 8 * _KEPT + stride * place
        busy = self.label()
        answer = self.load('ptr', self.context, offset)
        self.require(self._is_free(answer), busy)
        for index, output in enumerate(outputs):
            array = answer
            if len(outputs) > 1:
                array = self.load('ptr', self.context, offset + 8 * (1 + index))
                self.require(self._is_free(array), busy)
            self.require(self._is_unchanged(array, output.shape), busy)
            code.do(f'store ptr {self.load("ptr", array, _DATA)}, ptr {self.out[index]}')
        code.do(f'store i64 2, ptr {answer}')
        code.do(f'store ptr {answer}, ptr {self.answer}')
        code.do('br label %compute')
        code.lines.append(f'{busy}:')

    def _is_free(self, item: str) -> str:
        return self.equal('i64', self.load('i64', item, _REFERENCES), 1)

    def _is_unchanged(self, array: str, shape: tuple[int, ...]) -> str:
        # The previous caller may have changed its shape, type or flags, or hold a weak reference.
        flags = self.code.line(f'and i32 {self.load("i32", array, _FLAGS)}, {_REUSABLE}')
        dimensions = self.load('ptr', array, _DIMENSIONS)
        return self.all_of(
            [
                self.equal('i32', flags, _REUSABLE),
                self.equal('ptr', self.load('ptr', array, _WEAK), 'null'),
                self.equal('ptr', self.load('ptr', array, _DESCRIPTION), self.slot('float64')),
                self.equal('i32', self.load('i32', array, _DIMENSION_COUNT), len(shape)),
                *(
                    self.equal('i64', self.load('i64', dimensions, 8 * axis), length)
                    for axis, length in enumerate(shape)
                ),
            ]
        )

    def make_new(self) -> None:
        code = self.code
        array_type, new_array = self.slot('array_type'), self.slot('new_array')
        for index, (shape, output) in enumerate(
            zip(self.shapes, self.quantity.outputs, strict=True)
        ):
            for axis, length in enumerate(output.shape):
                code.do(f'store i64 {length}, ptr {code.address(shape, axis)}')
            array = code.line(
                f'call ptr {new_array}(ptr {array_type}, i32 {output.ndim}, ptr {shape}, '
                f'i32 {_FLOAT64}, ptr null, ptr null, i32 0, i32 0, ptr null)'
            )
            self._return_if_null(array)
            code.do(f'store ptr {self.load("ptr", array, _DATA)}, ptr {self.out[index]}')
            self.arrays.append(array)
        answer = self.arrays[0]
        if len(self.arrays) > 1:
            answer = code.line(
                f'call ptr {self.slot("new_object")}'
                f'(ptr {self.slot("terms_type")}, i64 {len(self.arrays)})'
            )
            self._return_if_null(answer)
            set_item = self.slot('set_item')
            for index, array in enumerate(self.arrays):
                code.line(f'call i32 {set_item}(ptr {answer}, i64 {index}, ptr {array})')
        code.do(f'store ptr {answer}, ptr {self.answer}')
        code.do('br label %compute')

    def _return_if_null(self, item: str) -> None:
        # Out of memory: Python has set the error already.
        code = self.code
        failed, succeeded = self.label(), self.label()
        code.do(f'br i1 {self.equal("ptr", item, "null")}, label %{failed}, label %{succeeded}')
        code.lines.append(f'{failed}:')
        for array in self.arrays:
            code.do(f'call void {self.slot("release")}(ptr {array})')
        code.do('ret ptr null')
        code.lines.append(f'{succeeded}:')

    def compute(self) -> None:
        code = self.code
        code.lines.append('compute:')
        out = [code.line(f'load ptr, ptr {slot}') for slot in self.out]
        arguments = ', '.join(
            f'ptr {pointer}' for pointer in [*self.data, self.slot('numbers'), *out]
        )
        is_valid = code.line(f'call i1 @{self.quantity.name}({arguments})')
        answer = code.line(f'load ptr, ptr {self.answer}')
        code.do(f'br i1 {is_valid}, label %answer, label %invalid')
        code.lines.append('answer:')
        code.do(f'ret ptr {answer}')
        code.lines.append('invalid:')
        code.do(f'call void {self.slot("release")}(ptr {answer})')
        code.do('br label %slow')

    def fall_back(self) -> None:
        code = self.code
        code.lines.append('slow:')
        call, function = self.slot('call'), self.slot('fallback')
        result = code.line(
            f'call ptr {call}(ptr {function}, ptr %arguments, i64 %count, ptr %keywords)'
        )
        code.do(f'ret ptr {result}')


DECLARATIONS = 'declare double @llvm.fabs.f64(double)'


class _MethodDefinition(ctypes.Structure):
    # PyMethodDef
    _fields_ = (
        ('name', ctypes.c_char_p),
        ('function', ctypes.c_void_p),
        ('flags', ctypes.c_int),
        ('documentation', ctypes.c_char_p),
    )


class _Context(np.ndarray):
    # The data behind `self` of an entry. `owned` keeps the objects alive that the slots point to.

    owned: tuple[Any, ...]
    evaluation: object

    def __new__(cls, values: Iterable[int]) -> '_Context':
        context = np.array(values, dtype=np.int64).view(cls)
        context.flags.writeable = False
        return context

    def __reduce__(self) -> tuple[Any, ...]:
        # A builtin function is pickled as its `self` and its name. Addresses are meaningless in
        # another process, so the fallback's owner takes their place: it has a method of that name.
        return _itself, (self.evaluation,)


def _itself(item: object) -> object:
    return item


# Functions of Python's C API, apart from `ctypes.pythonapi`: argument types set there would be
# shared with all its users.
_API = ctypes.PyDLL(None)
_SYMBOLS = (
    'PyType_GenericAlloc',
    'PyTuple_SetItem',
    'Py_DecRef',
    'PyObject_Vectorcall',
    'PyCFunction_NewEx',
    'PyCapsule_GetPointer',
)


def make_callable(
    address: int,
    name: str,
    shapes: Sequence[tuple[int, ...]],
    fallback: MethodType,
    documentation: str | None,
    terms_type: type,
    numbers: NDArray[np.float64],
) -> Callable[..., Any]:
    """
    Return a builtin function that computes a quantity of one state.

    Parameters
    ----------
    address : int
        Of the entry of this quantity, which stays in memory.
    name : str
    shapes : sequence of tuple of int
        Of the outputs.
    fallback : method
        Called for arguments that the entry does not cover. It must not refer to the new function:
        the garbage collector would not find that cycle.
    documentation : str or None
        Docstring.
    terms_type : type
        A named tuple for the answers of more than one output.
    numbers : numpy.ndarray
        See `PackedModel`.

    Returns
    -------
    builtin_function_or_method

    """
    addresses = {
        **_addresses(),
        'fallback': id(fallback),
        'terms_type': id(terms_type),
        'numbers': numbers.ctypes.data,
    }
    answers = [_answer(shapes, terms_type) for _ in range(_ANSWERS)]
    kept = [
        id(item)
        for answer in answers
        for item in ([answer, *answer] if len(shapes) > 1 else [answer, answer])
    ]
    context = _Context([*(addresses[slot] for slot in _SLOTS), *kept])
    method = _MethodDefinition(
        name.encode(),
        address,
        _METHOD_FLAGS,
        _signature_and_docstring(name, fallback.__func__, documentation),
    )
    context.owned = (method, fallback, terms_type, answers, numbers)
    context.evaluation = fallback.__self__
    return _new_function()(ctypes.byref(method), context, 'dynamics_node')


# Cached, as the next two: every change of gravity or payload makes a model.
@functools.cache
def _new_function() -> Any:
    new = _API.PyCFunction_NewEx
    new.argtypes = [ctypes.POINTER(_MethodDefinition), ctypes.py_object, ctypes.py_object]
    new.restype = ctypes.py_object
    return new


@functools.cache
def _signature_and_docstring(name: str, function: Any, documentation: str | None) -> bytes:
    signature = inspect.signature(function)
    # Without annotations, which a builtin function cannot have.
    own = inspect.Signature(
        [
            parameter.replace(annotation=inspect.Parameter.empty)
            for parameter in list(signature.parameters.values())[1:]
        ]
    )
    return f'{name}{own}\n--\n\n{inspect.cleandoc(documentation or "")}'.encode()


@functools.cache
def _addresses() -> dict[str, int]:
    return {
        'array_type': id(np.ndarray),
        'float64': id(np.dtype(np.float64)),
        'new_array': _numpy_function(_PYARRAY_NEW),
        'new_object': _address(_API.PyType_GenericAlloc),
        'set_item': _address(_API.PyTuple_SetItem),
        'release': _address(_API.Py_DecRef),
        'call': _address(_API.PyObject_Vectorcall),
    }


def _answer(shapes: Sequence[tuple[int, ...]], terms_type: type) -> Any:
    arrays = [np.empty(shape) for shape in shapes]
    return terms_type(*arrays) if len(arrays) > 1 else arrays[0]


def _address(function: Any) -> int:
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def _numpy_function(index: int) -> int:
    core = getattr(np, '_core', None) or np.core
    pointer = _API.PyCapsule_GetPointer
    pointer.argtypes, pointer.restype = [ctypes.py_object, ctypes.c_char_p], ctypes.c_void_p
    table = pointer(core._multiarray_umath._ARRAY_API, None)
    return ctypes.c_void_p.from_address(table + 8 * index).value or 0


@functools.cache
def is_supported() -> bool:
    """
    Check that this Python has the memory layout and the C functions that the entries rely on.

    Returns
    -------
    bool
        False on Pythons other than CPython, before 3.11, without the global lock, or of 32 bits.

    """
    if (
        sys.implementation.name != 'cpython'
        or ctypes.sizeof(ctypes.c_void_p) != 8
        or sysconfig.get_config_var('Py_GIL_DISABLED')
        or not all(hasattr(_API, symbol) for symbol in _SYMBOLS)
    ):
        return False
    probe = np.arange(3.0)
    at = id(probe)
    address = functools.partial(_read, ctypes.c_void_p, at)
    has_layout = (
        address(_TYPE) == id(np.ndarray)
        and address(_DATA) == probe.ctypes.data
        and _read(ctypes.c_int64, at, _REFERENCES) == sys.getrefcount(probe) - 1
        and _read(ctypes.c_int, at, _DIMENSION_COUNT) == 1
        and _read(ctypes.c_int64, address(_DIMENSIONS), 0) == 3
        and address(_DESCRIPTION) == id(np.dtype(np.float64))
        and _read(ctypes.c_int, at, _FLAGS) & _REUSABLE == _REUSABLE
        and address(_WEAK) is None
    )
    reference = weakref.ref(probe)
    return has_layout and address(_WEAK) == id(reference)


def _read(kind: Any, at: int, offset: int) -> Any:
    return kind.from_address(at + offset).value
