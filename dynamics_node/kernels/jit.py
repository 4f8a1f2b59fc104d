"""The one place that decides how kernels are compiled."""

from typing import Any

import numba
from numba.extending import register_jitable

# fastmath stays off: it may assume that there is no NaN, and the checks for NaN live on it.
# error_model 'numpy' follows IEEE 754 on division instead of raising in compiled code.
_OPTIONS: Any = {'nogil': True, 'error_model': 'numpy', 'fastmath': False}


def compiled(function):
    """
    Compile a kernel on its first call and keep the machine code on disk.

    Where no folder for the cache can be written, the code is compiled anew in each process.

    """
    try:
        return numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:  # numba: no locator available
        return numba.njit(**_OPTIONS)(function)


def formula(function):
    """Let kernels call a function when they are compiled; called from Python, it stays Python."""
    return register_jitable(**_OPTIONS)(function)
