"""Backward Euler: robust, tractions never exceed the bound, first order."""

from __future__ import annotations

from microslip.models.path import EULER
from microslip.solver.method import Method

METHOD = Method("backward Euler, first order", integrator=EULER)
