"""Plain march, period after period, until the state is periodic."""

from __future__ import annotations

from microslip.solver.method import Method
from microslip.solver.methods import _searches

METHOD = Method("plain march to the periodic state", search=_searches.march, prepared=False)
