"""Compiler options of all kernels."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.extending import register_jitable

_Function = TypeVar('_Function', bound=Callable[..., Any])

# fastmath stays off: it lets the compiler assume that there is no NaN, and results depend on NaN.
# error_model 'numpy' follows IEEE 754 on division instead of raising in compiled code.
_OPTIONS: Any = {'nogil': True, 'error_model': 'numpy', 'fastmath': False}


def compiled(function: _Function) -> _Function:
    """
    Compile a kernel on its first call and keep the machine code on disk.

    Without a writable cache folder each process compiles the kernel again.

    """
    try:
        kernel: _Function = numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:  # numba: no locator available
        kernel = numba.njit(**_OPTIONS)(function)
    return kernel


def formula(function: _Function) -> _Function:
    """Make a function callable from compiled kernels; called from Python, it stays Python."""
    registered: _Function = register_jitable(**_OPTIONS)(function)
    return registered
