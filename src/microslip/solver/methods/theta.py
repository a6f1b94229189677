"""The theta method slightly above the midpoint rule, whose oscillations it damps slowly."""

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
