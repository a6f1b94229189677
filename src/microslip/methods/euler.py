"""Backward Euler: robust, never beyond the bound, first order."""

from __future__ import annotations

from microslip.method import Method
from microslip.path import EULER

METHOD = Method("backward Euler, first order", integrator=EULER)
