"""Plain march until the mean friction forces of two half periods agree.

The state of slow motions keeps drifting long after two means agree.
"""

from __future__ import annotations

from microslip.solver.method import Method
from microslip.solver.methods import _searches

METHOD = Method("plain march until two means agree", search=_searches.equal_means, prepared=False)
