"""The theta method with theta slightly above 1/2, which slowly damps numerical oscillations."""

from __future__ import annotations

from microslip.models.path import theta_method
from microslip.solver.method import Method
from microslip.solver.methods import _searches

THETA = 0.55
METHOD = Method(
    f"theta method, theta = {THETA}",
    integrator=theta_method(THETA),
    search=_searches.accelerated,
)
