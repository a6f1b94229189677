"""The theta method a little beyond the midpoint: what rings there is damped here, slowly."""

from __future__ import annotations

from microslip.method import Method
from microslip.methods import _searches
from microslip.path import theta_method

THETA = 0.55
METHOD = Method(
    f"theta method, theta = {THETA}",
    integrator=theta_method(THETA),
    search=_searches.accelerated,
)
