"""How functions are compiled: the options of Numba that results depend on.

Where the compiled code is kept, on which none depends, is in kernel_cache.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numba

from microslip.foundation.kernel_cache import folder, kept_in

numba.config.SLP_VECTORIZE = 1
"""Neighbouring scalar operations become vector instructions, which Numba leaves out unless told:
products of matrices take half the time."""

OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Compiled once and kept on disk; no reordering of sums; division by zero as NumPy does it."""


def kernel(function: Callable | None = None, **options: object) -> Callable:
    """Decorator of functions that Numba compiles when they are first called.

    options: of numba.njit, besides OPTIONS, as in `@kernel(inline="always")`.
    """
    if function is None:
        return lambda function: kernel(function, **options)
    with kept_in(folder()):
        return numba.njit(**(OPTIONS | options))(function)
