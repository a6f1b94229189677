"""Anderson acceleration from full slip, which believes a small residual of the plain map.

Where the drift is slow a state changes so little in a period that a small residual proves nothing.
"""

from __future__ import annotations

from microslip.solver.method import Method
from microslip.solver.methods import _searches

METHOD = Method(
    "Anderson from full slip, believes its residual",
    search=_searches.residual_alone,
    prepared=False,
)
