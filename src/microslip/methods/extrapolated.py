"""Backward Euler extrapolated from two runs, one with half as many steps as the other."""

from __future__ import annotations

from microslip.method import Method
from microslip.path import EULER

METHOD = Method("backward Euler, extrapolated from two runs", integrator=EULER, extrapolated=True)
