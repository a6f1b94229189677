"""The implicit midpoint rule: second order where nothing changes, and no damping at all.

Coulomb's law holds at the middle of a step; the end is extrapolated from there, so that tractions
leave the friction bound and the error of one step comes back in the next with the other sign.
"""

from __future__ import annotations

from microslip.models.path import theta_method
from microslip.solver.method import Method
from microslip.solver.methods import _searches

METHOD = Method(
    "implicit midpoint rule, undamped", integrator=theta_method(0.5), search=_searches.accelerated
)
