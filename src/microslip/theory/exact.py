"""Closed forms of motions under Hertz's pressure, by name: their points need no marching.

Stored results depend on this file and on the functions in it.  What formulas are called and which
others there are is in catalogue.py, on which no stored result depends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from microslip.theory import bounds, paper


class StaticLimit(NamedTuple):
    """The exact limit of the friction for velocity to 0.

    Attributes
    ----------
    function : callable
        Takes an array of amplitudes, dimensionless.
    any_poisson : bool
        Whether it holds for every Poisson's ratio, else for 0.
    """

    function: Callable
    any_poisson: bool = False


STATIC_LIMITS = {
    "transverse": StaticLimit(paper.static_limit_transverse),
    "bore": StaticLimit(paper.static_limit_bore, any_poisson=True),
    "longitudinal": StaticLimit(paper.static_limit_longitudinal),
    "zigzag": StaticLimit(paper.static_limit_transverse),  # it knows the turning points alone
}

LARGEST_DROPS = {
    "longitudinal": bounds.largest_drop_longitudinal,
    "transverse": bounds.largest_drop_transverse,
    "bore": bounds.largest_drop_bore,
}
"""Upper bounds of 1 - mu_macro, functions of velocity and amplitude (floats)."""
