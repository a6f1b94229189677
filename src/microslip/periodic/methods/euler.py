"""Backward Euler method: robust and first order; tractions never exceed the friction bound."""

from __future__ import annotations

from microslip.contact.path import EULER
from microslip.periodic.method import Method

METHOD = Method("backward Euler, first order", integrator=EULER)
