"""Storage of compiled functions that never fails a computation.

Numba's own storage raises an error for a damaged or unwritable file, and two processes that compile
one function at the same time can exchange the codes of its signatures.  The classes below follow
Numba's rules for subclasses in numba.core.caching.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import time
from typing import Any

from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.serialize import dumps

REPORTED = "MICROSLIP_SAID_UNSTORED"
"""Environment variable that is set after the message about an unwritable folder.  The jobs of a
sweep inherit it."""


SPELL = 1.0
"""Seconds without compilation after which the next compilation is announced again.  Between the
kernels of one solution, milliseconds pass."""


class Announcement:
    """One line on a terminal when compilation begins.

    Attributes
    ----------
    running : int
        Number of functions that are being compiled, since one calls the other.
    ended : float
        Time of the end of the last compilation.
    """

    running, ended = 0, -SPELL

    def begin(self) -> None:
        """Announce a compilation, unless it belongs to one that was announced."""
        if not self.running and time.monotonic() - self.ended > SPELL and sys.stderr.isatty():
            print("microslip: compiling the solver, once for each kind of contact", file=sys.stderr)
        self.running += 1

    def end(self) -> None:
        """Record the end of a compilation."""
        self.running, self.ended = self.running - 1, time.monotonic()


ANNOUNCEMENT = Announcement()


class CheckedCode(CompileResultCacheImpl):
    """Compiled code as bytes with their checksum."""

    def check_cachable(self, cres: Any) -> bool:
        """True if the code holds no addresses of this process."""
        return not cres.library.has_dynamic_globals

    def reduce(self, cres: Any) -> tuple[bytes, bytes]:
        """Return the checksum and the bytes of a compiled function."""
        content = dumps(super().reduce(cres))
        return hashlib.sha256(content).digest(), content

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """Return the compiled function.  Raises ValueError if the checksum does not match."""
        checksum, content = payload
        if hashlib.sha256(content).digest() != checksum:
            raise ValueError("the checksum does not match")
        return super().rebuild(target_context, pickle.loads(content))


class KernelStore(FunctionCache):
    """Compiled code of one function, for all signatures.

    A damaged entry counts as missing and is overwritten.
    """

    _impl_class = CheckedCode

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the stored code for the argument types `sig`, or None; then Numba compiles."""
        try:
            cres = super().load_overload(sig, target_context)
        except Exception:  # a damaged pickle can raise any error
            cres = None
        if cres is not None and tuple(cres.signature.args) == tuple(sig):
            return cres
        ANNOUNCEMENT.begin()
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store compiled code for the argument types `sig`.  If this fails, a line is printed."""
        ANNOUNCEMENT.end()
        try:
            try:
                super().save_overload(sig, data)
            except OSError:
                raise
            except Exception:  # a damaged index
                self.flush()
                super().save_overload(sig, data)
        except OSError as error:
            if not os.environ.get(REPORTED):
                os.environ[REPORTED] = "1"
                print(
                    f"microslip: compiled code cannot be stored in {self.cache_path}: "
                    f"{error.strerror or error}; each process compiles it again until there is "
                    "room, or NUMBA_CACHE_DIR names another folder",
                    file=sys.stderr,
                )
