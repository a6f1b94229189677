"""Compilation of functions with Numba, and storage of the compiled code.

`kernel` is `numba.njit(cache=True)`.  Numba's cache fails in four cases.  This module prevents them
by Numba's settings and by a listener to Numba's events:

- Numba notices an edit of the file of a function, but not an edit of another file that the function
  uses.  Therefore, the name of the folder of compiled code contains a digest of all files with
  kernels, and of all files that these files import.

- Numba raises an error for a folder that is read-only or full.  Therefore, the folder is checked
  once.  If this folder is not usable, another folder is used, or compiled code is not stored.  If
  code cannot be stored later, for example on a disk that has filled up, the function is used
  without storing it.

- Numba raises an error for a damaged file.  Therefore, the folder contains a list of checksums,
  which is written after each compilation.  At the start of a process, files that do not match this
  list are removed.

- If two processes compile the same function at the same time, they can mix up the compiled codes
  for different argument types.  Therefore, only one process compiles at a time.  The other
  processes wait, and then use the code that the first process has stored.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import shutil
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import IO

import numba
import scipy
from numba.core import caching, event
from platformdirs import user_cache_path

from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.files import check_room, write_atomically
from microslip.foundation.source_digest import LOADED

if numba.config.DISABLE_JIT:
    allowed = "the solver runs only as compiled code; allowed is 0, or no such variable"
    raise InputError("NUMBA_DISABLE_JIT", numba.config.DISABLE_JIT, allowed)

numba.config.SLP_VECTORIZE = 1
"""Numba option, off by default, that combines neighbouring scalar operations into vector
instructions.  With this option, matrix products take half the time."""
OPTIONS = {"nogil": True, "error_model": "numpy"}
"""Numba options.  Sums are not reordered, and division by zero works as in NumPy."""
ROOM = 16_000_000
"""Free disk space, in bytes, that a folder needs.  The compiled code takes 5 MB."""
SPELL = 1.0
"""A new message about a compilation is printed only if the last compilation ended more than this
number of seconds ago.  In one solution, each compilation begins milliseconds after the end of the
previous one."""
PAUSE = 0.05
"""Seconds between two attempts to lock the folder."""
ATTEMPTS = iter(range(2400))
"""Remaining attempts of this process to lock the folder.  After two minutes of waiting, no attempt
remains.  This limit is necessary because the process that has the lock can be suspended."""
REPORTED = "MICROSLIP_SAID_UNSTORED"
"""Environment variable that is set when the message about an unusable folder has been printed.
Jobs inherit this variable."""


def _usable_folder() -> Path | None:
    """Return the folder for the compiled code of the running sources, or None if no folder is
    usable."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    places = [LOADED.folder / "__pycache__", user_cache_path("microslip")]
    problems: list[str] = []
    digest = LOADED.digest(LOADED.kernels)[:16]
    for place in [Path(chosen), *places] if chosen else places:
        folder = place / f"compiled-{digest}"
        try:
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            check_room(folder)
            if shutil.disk_usage(folder).free < ROOM:
                raise OSError(errno.ENOSPC, f"less than {ROOM / 1e6:g} MB are free")
        except OSError as error:
            problems.append(f"{place} ({error.strerror})")
            continue
        if problems and chosen:
            _report(" or ".join(problems), f"it is stored in {place}")
        return folder
    _report(" or ".join(problems))
    return None


def _report(problem: str, remedy: str = "each process compiles it again") -> None:
    """Print a message about folders that cannot be used, but only once for this process and its
    jobs."""
    if not os.environ.get(REPORTED):
        os.environ[REPORTED] = "1"
        line = f"compiled code cannot be stored in {problem}; {remedy}"
        print(f"microslip: {line}; NUMBA_CACHE_DIR names another folder", file=sys.stderr)


class Locator(getattr(caching, "UserProvidedCacheLocator", object)):  # type: ignore[misc]
    """Numba's locator for a given folder of compiled code.  This locator ignores the path of the
    package, so that copies of the package share the compiled code.  Old versions of Numba do not
    use this locator."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        """Return the name of the folder in which the compiled code of a file is stored."""
        return Path(py_file).parent.name


class _Listener(event.Listener):
    """Listener for two kinds of Numba events: events of the compiler lock and compilations.  Numba
    holds the lock while it loads, compiles and stores code."""

    depth, is_compiling, ended, seconds, started = 0, False, -SPELL, 0.0, 0.0
    lock: IO | None = None

    def on_start(self, event: event.Event) -> None:
        if event.kind == "numba:compile":
            is_first = not self.is_compiling and time.monotonic() > self.ended + SPELL
            if is_first and sys.stderr.isatty():
                print("microslip: compiling the solver, once for each kind", file=sys.stderr)
            self.is_compiling = True
        elif self.depth == 0:
            self.started, self.lock = time.monotonic(), _lock()
        self.depth += 1

    def on_end(self, event: event.Event) -> None:
        self.depth -= 1
        if self.depth:
            return
        self.seconds += time.monotonic() - self.started
        if self.is_compiling:
            self.is_compiling, self.ended = False, time.monotonic()
            if FOLDER is not None:
                _list_checksums(FOLDER)
        if self.lock is not None:
            self.lock.close()


def _lock() -> IO | None:
    """Wait for processes that compile.  Return an open file that is locked until it is closed, or
    None if files cannot be locked."""
    with contextlib.suppress(ImportError, OSError):
        import fcntl

        file = open(f"{FOLDER}/lock", "w")  # noqa: SIM115
        for _ in ATTEMPTS:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return file
            except BlockingIOError:
                time.sleep(PAUSE)
    return None


def _checksums(folder: Path) -> dict[str, str]:
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*.nb[ic]")}
    return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items()}


def _list_checksums(folder: Path) -> None:
    with contextlib.suppress(OSError, CacheError):  # the next process compiles again
        write_atomically(folder / "checksums.json", json.dumps(_checksums(folder)).encode())


def _remove_damaged(folder: Path) -> None:
    listed = {}
    with contextlib.suppress(OSError, TypeError, ValueError):
        listed = dict(json.loads((folder / "checksums.json").read_bytes()))
    for name in dict(_checksums(folder).items() - listed.items()):
        (folder / name).unlink(missing_ok=True)


FOLDER = _usable_folder()
"""Folder of the compiled code, or None if no folder is usable."""
if FOLDER is not None:
    with _lock() or contextlib.nullcontext():
        _remove_damaged(FOLDER)
_LISTENER = _Listener()
event.register("numba:compiler_lock", _LISTENER)
event.register("numba:compile", _LISTENER)


def compile_seconds() -> float:
    """Return the time, in seconds, that this process has spent on compiling kernels and on loading
    compiled code."""
    return _LISTENER.seconds


def kernel(function: Callable | None = None, **options: object) -> Callable:
    """Decorate a function so that Numba compiles it at its first call and stores the code on disk.

    options: arguments of numba.njit in addition to OPTIONS, as in `@kernel(inline="always")`.
    """
    if function is None:
        return lambda function: kernel(function, **options)
    config = numba.config
    before = config.CACHE_DIR, getattr(config, "CACHE_LOCATOR_CLASSES", "")
    config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = str(FOLDER), f"{__name__}.Locator"
    try:
        dispatcher = numba.njit(cache=FOLDER is not None, **(OPTIONS | options))(function)
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before
    dispatcher.compile = partial(_compile, dispatcher.compile)
    return dispatcher


def _compile(compile_and_store: Callable, signature: object) -> object:
    """Compile a function, and store its code.  If the code cannot be stored, the function is
    compiled but not cached."""
    try:
        return compile_and_store(signature)
    except OSError as error:  # the function has been compiled
        _report(f"{FOLDER} ({error.strerror})")
        return compile_and_store(signature)


def _import_blas() -> None:
    """Import Numba's module that searches for BLAS, without importing all of scipy.linalg.

    Numba searches for BLAS when it loads any kernel.  The import of scipy.linalg takes a fifth of
    the CPU time of `microslip point`.
    """
    if "scipy.linalg" not in sys.modules:
        bare = sys.modules["scipy.linalg"] = ModuleType("scipy.linalg")
        bare.__path__ = [f"{path}/linalg" for path in scipy.__path__]
        with contextlib.suppress(ImportError):
            import numba.np.arraymath  # noqa: F401
        for name in [name for name in sys.modules if name.startswith("scipy.linalg")]:
            del sys.modules[name]


_import_blas()
