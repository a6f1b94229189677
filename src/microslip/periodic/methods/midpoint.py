"""The implicit midpoint rule: second order for smooth solutions, without damping.

Coulomb's law is satisfied in the middle of a step.  The tractions at the end are extrapolated and
can exceed the friction bound.  The error of a step recurs in the next step with the opposite sign.
"""

from __future__ import annotations

from microslip.contact.path import theta_method
from microslip.periodic.method import Method

METHOD = Method("implicit midpoint rule, undamped", integrator=theta_method(0.5))
