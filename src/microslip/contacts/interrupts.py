"""Ctrl-C in the middle of a march: compiled code that runs for minutes looks out for it.

Python hands on a signal between two of its own instructions, and there is none in a compiled march.
So the march asks the interpreter itself from time to time and ends early after a Ctrl-C; the caller
raises the signal again where Python can handle it.
"""

from __future__ import annotations

from numba import types

from microslip.foundation.compiled import kernel

_hold = types.ExternalFunction("PyGILState_Ensure", types.intc())
_let_go = types.ExternalFunction("PyGILState_Release", types.void(types.intc))
_happened = types.ExternalFunction("PyOS_InterruptOccurred", types.intc())

BETWEEN_LOOKS = 2e7
"""Multiplications, about, between two looks: some hundredths of a second.  A look has to wait for
the other threads of the interpreter, so there should not be many."""


@kernel
def interrupted() -> bool:
    """Whether Ctrl-C was pressed since somebody asked: only the main thread is told, and once."""
    held = _hold()
    found = _happened()
    _let_go(held)
    return found != 0
