"""Closed forms that replace simulations of some motions under Hertz pressure.

Stored results depend on this file and on the functions that it uses. They do not depend on
datasets/catalogue.py, which contains the names of these and other formulas.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from microslip.theory import bounds, paper


class StaticLimit(NamedTuple):
    """Exact limit of friction as the velocity tends to 0.

    Attributes
    ----------
    function : callable
        Friction as a function of an array of amplitudes, dimensionless.
    any_poisson : bool
        True if the limit applies to every Poisson's ratio; otherwise it applies to 0 only.
    """

    function: Callable
    any_poisson: bool = False


STATIC_LIMITS = {
    "transverse": StaticLimit(paper.static_limit_transverse),
    "bore": StaticLimit(paper.static_limit_bore, any_poisson=True),
    "longitudinal": StaticLimit(paper.static_limit_longitudinal),
    # zigzag and sine have the same limit, because it depends on the turning points only
    "zigzag": StaticLimit(paper.static_limit_transverse),
}

LARGEST_DROPS = {
    "longitudinal": bounds.largest_drop_longitudinal,
    "transverse": bounds.largest_drop_transverse,
    "bore": bounds.largest_drop_bore,
}
"""Upper bounds on 1 - mu_macro as functions of velocity and amplitude (floats)."""
