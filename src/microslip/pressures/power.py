"""Power-law indenters, f(r) ~ r^n: a cone (1), a sphere (2), ever flatter ends (8, 20)."""

from __future__ import annotations

import numpy as np

from microslip.foundation import spec
from microslip.pressures.axisymmetric_indenter import indenter
from microslip.pressures.pressure import Pressure

DEFAULTS = {"exponent": 2.0}
LIMITS = (1.0, 100.0)


def pressure(name: str, exponent: float) -> Pressure:
    """The Pressure of an indenter r^exponent; raises InputError for one below 1 or above 100.

    Up to the exponent n = 2 the bound is largest at the centre, where it is
    (G*/pi) Integral_0^1 n x^(n - 2) dx = (n + 1) / (2 pi (n - 1)).
    """
    spec.refuse_outside(name, "pressure", "exponent", exponent, LIMITS)
    largest = None
    if exponent <= 2.0:
        over = 2.0 * np.pi * (exponent - 1.0)
        largest = (exponent + 1.0) / over if over > 0.0 else np.inf
    return indenter(
        name,
        f"an indenter with the profile r^{exponent:g}",
        depth=lambda c: np.asarray(c, float) ** exponent,
        slope=lambda c: exponent * c ** (exponent - 1.0),
        radius=lambda depth: np.maximum(depth, 0.0) ** (1.0 / exponent),
        of_load=lambda share: np.maximum(share, 0.0) ** (exponent / (exponent + 1.0)),
        largest=largest,
    )
