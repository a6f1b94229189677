"""Backward Euler method, extrapolated from two runs, one with half as many steps as the other."""

from __future__ import annotations

from microslip.models.path import EULER
from microslip.solver.method import Method

METHOD = Method("backward Euler, extrapolated from two runs", integrator=EULER, extrapolated=True)
