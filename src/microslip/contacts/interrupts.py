"""Check for Ctrl-C in compiled code, which can run for minutes.

Python handles signals only between its own instructions.  While compiled code runs, signals are not
handled.  Compiled code therefore calls `interrupted` from time to time and ends early after Ctrl-C.
The calling Python code raises the signal again.
"""

from __future__ import annotations

from numba import types

from microslip.foundation.compiled import kernel

_acquire = types.ExternalFunction("PyGILState_Ensure", types.intc())
_release = types.ExternalFunction("PyGILState_Release", types.void(types.intc))
_occurred = types.ExternalFunction("PyOS_InterruptOccurred", types.intc())

BETWEEN_LOOKS = 2e7
"""Approximate number of multiplications between two calls of `interrupted`.  It corresponds to a
few hundredths of a second.  A call waits for the other threads of the interpreter, so calls should
be rare."""


@kernel
def interrupted() -> bool:
    """Whether Ctrl-C was pressed since the last call; always false except in the main thread."""
    state = _acquire()
    occurred = _occurred()
    _release(state)
    return occurred != 0
