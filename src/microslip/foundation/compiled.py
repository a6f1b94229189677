"""Compilation of functions with Numba.  This module sets all Numba options of the package.

kernel_cache.py chooses the folder of the compiled code.  Results do not depend on this folder.
"""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from importlib.machinery import PathFinder
from importlib.util import module_from_spec

import numba
import scipy
from numba.core import event

from microslip.foundation.errors import InputError
from microslip.foundation.kernel_cache import BySources, folder
from microslip.foundation.kernel_store import KernelStore

if numba.config.DISABLE_JIT:
    raise InputError(
        "NUMBA_DISABLE_JIT",
        numba.config.DISABLE_JIT,
        "the solver runs only as compiled code; allowed is 0, or no such variable",
    )

numba.config.SLP_VECTORIZE = 1
"""Combine neighbouring scalar operations into vector instructions, which Numba does not do by
default.  Matrix products then take half the time."""

BLAS = "scipy.linalg.cython_blas"


def _look_for_blas() -> None:
    """Import Numba's module that searches for BLAS, without importing all of scipy.linalg.

    Numba searches for BLAS when it loads any kernel, and imports scipy.linalg for this.  This
    import takes a fifth of the CPU time of `microslip point`.  So BLAS is imported without its
    package.
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

_CLOCK = event.TimingListener()
event.register("numba:compiler_lock", _CLOCK)


def compile_seconds() -> float:
    """Seconds that this process has spent on compiling kernels and on loading compiled code."""
    return float(_CLOCK.duration) if _CLOCK.done else 0.0


OPTIONS = {"nogil": True, "error_model": "numpy"}
"""Numba options.  Sums are not reordered, and division by zero works as in NumPy."""


@contextlib.contextmanager
def _cache_folder() -> Iterator[None]:
    """Context manager in which Numba stores new compiled code in the folder of kernel_cache.py."""
    config = numba.config
    before = config.CACHE_DIR, getattr(config, "CACHE_LOCATOR_CLASSES", "")
    # A Numba version without locators uses only the folder.  Copies of the package then do not
    # share compiled code.
    locator = f"{BySources.__module__}.{BySources.__qualname__}"
    config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = str(folder()), locator
    try:
        yield
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before


def kernel(function: Callable | None = None, **options: object) -> Callable:
    """Decorator for functions that Numba compiles at their first call, and stores on disk.

    options: arguments of numba.njit in addition to OPTIONS, as in `@kernel(inline="always")`.
    """
    if function is None:
        return lambda function: kernel(function, **options)
    with _cache_folder():
        dispatcher = numba.njit(**(OPTIONS | options))(function)
        dispatcher._cache = KernelStore(function)  # as `cache=True` does with Numba's own class
    return dispatcher
