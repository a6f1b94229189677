"""Numbers with units: texts such as "210 GPa" to SI values, checked by the library pint."""

from __future__ import annotations

import math
from functools import cache

EXAMPLES = {
    "Pa": "210 GPa",
    "m": "5 mm",
    "N": "10 N",
    "m/s": "1 mm/s",
    "Hz": "20 kHz",
    "rad": "0.5 deg",
    "rad/s": "60 rpm",
    "kg/m^3": "7850 kg/m^3",
    "": "0.3",
}
"""What a value in each unit may look like."""


@cache
def registry():
    """The pint.UnitRegistry in use; loading it takes most of a second."""
    import pint

    return pint.UnitRegistry()


def si_value(name, value, unit, *, low=0.0, low_open=True, high=math.inf):
    """Value of a quantity in its SI unit, as a float.

    name: for messages; value: text with a unit ("5 mm"), a pint quantity, or a plain number, which
    is taken to be in SI units already.  unit: a key of EXAMPLES.  Allowed are finite numbers with
    low < value (low <= value unless low_open) and value <= high.  Raises ValueError, naming the
    argument and what is allowed.
    """
    number = _in_unit(name, value, unit)
    beyond = number <= low if low_open else number < low
    if not math.isfinite(number) or beyond or number > high:
        allowed = f"{'above' if low_open else 'at least'} {low:g}"
        if high < math.inf:
            allowed += f" and at most {high:g}"
        raise ValueError(f"{name} = {_shown(value)}: allowed is a finite value {allowed} {unit}")
    return number


def _in_unit(name, value, unit):
    example = EXAMPLES[unit]
    if isinstance(value, bool):
        raise ValueError(f"{name} = {value!r}: allowed is a value such as {example!r}")
    try:
        given = registry().Quantity(value) if isinstance(value, str) else value
        if not hasattr(given, "to"):
            return float(given)
        if unit and given.unitless:
            raise ValueError("a number without a unit")
        return float(given.to(unit).magnitude)
    except Exception as error:  # pint has many kinds, and its parser those of Python
        kind = "a number" if unit == "" else f"a value in units of {unit}"
        raise ValueError(
            f"{name} = {_shown(value)}: allowed is {kind}, such as {example!r}"
        ) from error


def _shown(value):
    return repr(value) if isinstance(value, str) else str(value)
