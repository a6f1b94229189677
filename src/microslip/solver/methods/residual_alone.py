"""Anderson acceleration from full slip, stopped by the residual of the plain map alone.

If the drift is slow, every state changes little in a period.  So a small residual does not show
that the state is periodic.
"""

from __future__ import annotations

from microslip.solver.method import Method
from microslip.solver.methods import _searches

METHOD = Method(
    "Anderson from full slip, believes its residual",
    search=_searches.residual_alone,
    prepared=False,
)
