"""Pressures: how the load is spread over the contact, and so what every point can take.

A pressure is one ``Pressure`` record (see record.py for it and for the working units).  A family
gives one for numbers that follow its name; to add one write a file beside these and a row in
``FAMILIES``.
"""

from __future__ import annotations

from functools import lru_cache

from microslip import parameters
from microslip.pressures import elliptic, power, punch, ring
from microslip.pressures.elliptic import HERTZ
from microslip.pressures.record import Pressure

__all__ = ["FAMILIES", "HERTZ", "PRESSURES", "Pressure", "pressure_named"]

PRESSURES = {HERTZ.name: HERTZ}
FAMILIES = {family.NAME: family for family in (power, punch, ring, elliptic)}
"""Name -> module with DEFAULTS, numbers and their values if not given, and pressure(name, ...)."""
SOURCES = {}
"""Name -> function that makes a Pressure of what follows the name and a colon; modules that know
files put themselves here, since this package knows none."""


def pressure_named(name):
    """The Pressure of this name, of a family for the numbers that follow its name, such as
    "power:exponent=1", or from a source, as in "file:measured.csv".  Raises ValueError saying what
    is allowed."""
    if isinstance(name, str) and name in PRESSURES:
        return PRESSURES[name]
    known = [*PRESSURES, *FAMILIES, *SOURCES]
    if not isinstance(name, str):
        raise ValueError(f"pressure = {name!r}: allowed is one of {', '.join(known)}")
    family, _, rest = name.partition(":")
    if family in SOURCES:
        return SOURCES[family](rest)
    family, numbers = parameters.split(name, "pressure", known)
    module = FAMILIES.get(family)
    problem = parameters.unknown(name, "pressure", numbers, list(module.DEFAULTS if module else ()))
    if problem:
        raise ValueError(problem)
    return _of_family(family, tuple(sorted(numbers.items())))


@lru_cache(maxsize=64)
def _of_family(family, numbers):
    """One record for a name: what is prepared for a pressure is found again by it."""
    module = FAMILIES[family]
    given = {key: value for key, value in numbers if value != module.DEFAULTS[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    return module.pressure(
        f"{family}:{words}" if words else family, **(module.DEFAULTS | dict(numbers))
    )
