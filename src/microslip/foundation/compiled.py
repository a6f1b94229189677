"""How functions are compiled: the options of Numba that results depend on.

Where the compiled code is kept, on which none depends, is in kernel_cache.py.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable
from importlib.machinery import PathFinder
from importlib.util import module_from_spec

import numba
import scipy

from microslip.foundation.kernel_cache import folder, kept_in

numba.config.SLP_VECTORIZE = 1
"""Neighbouring scalar operations become vector instructions, which Numba leaves out unless told:
products of matrices take half the time."""

BLAS = "scipy.linalg.cython_blas"


def _look_for_blas() -> None:
    """Import the module of Numba that looks for BLAS, without all of scipy.linalg.

    Numba looks for BLAS when it loads any kernel, and importing scipy.linalg for that takes a fifth
    of the CPU time of `microslip point`.  So BLAS is imported without its package, which still is
    imported in the usual way by whoever needs it.
    """
    if "scipy.linalg" in sys.modules:
        return
    spec = PathFinder.find_spec(BLAS, [f"{path}/linalg" for path in scipy.__path__])
    if spec is None or spec.loader is None:
        return
    sys.modules[BLAS] = module_from_spec(spec)
    with contextlib.suppress(ImportError):
        spec.loader.exec_module(sys.modules[BLAS])
        import numba.np.arraymath  # noqa: F401
    sys.modules.pop(BLAS, None)


_look_for_blas()

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
