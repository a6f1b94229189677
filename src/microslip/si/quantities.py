"""Convert texts with units, such as "210 GPa", to values in SI units, by a strict grammar.

A text is one number and one unit.  The number has the format of Python's float, but only the digits
0 to 9 and no underscores.  A Unicode minus is also accepted.  The module `units` reads the unit.
Every other text raises InputError.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from numbers import Real
from typing import Any

import numpy as np

from microslip.foundation.arguments import without_array
from microslip.foundation.errors import InputError
from microslip.si.units import (
    CYCLIC,
    Unit,
    UnitError,
    exact,
    pint_unit,
    read_unit,
    si_unit,
    split_number,
    stopped,
)

EXAMPLES = {
    "Pa": "210 GPa",
    "m": "5 mm",
    "s": "1 ms",
    "N": "10 N",
    "m/s": "1 mm/s",
    "Hz": "20 kHz",
    "rad": "0.5 deg",
    "rad/s": "60 rpm",
    "kg/m^3": "7850 kg/m^3",
    "N/m": "10 N/um",
    "kg": "20 g",
    "N*s/m": "5 N*s/m",
    "m^2/N": "1e-5 mm^3/N/m",
    "": "0.3",
}
"""An example of a quantity for each SI unit."""
RATES = ("Hz", "rad/s")
"""SI units of rates.  A rate can be cyclic (Hz) or angular (rad/s)."""

AMBIGUOUS = ", which may mean Hz or rad/s; they differ by 2 pi, so write one of them"
PER_SECOND = (("second", -1),)
HINTS = {
    ("N", (("gram", 1),)): ", of a mass; for its weight write gf or kgf, as in '500 gf'",
    ("m/s", (("radian", 1), ("second", -1))): (
        ", of a rotation; its speed is the rate in rad/s times a radius"
    ),
    ("Hz", PER_SECOND): AMBIGUOUS,
    ("rad/s", PER_SECOND): AMBIGUOUS,
}
"""Hints for a wrong unit, keyed by the required SI unit and the root units of the wrong unit."""


@dataclass(frozen=True)
class Quantity:
    """A quantity in its SI unit.

    Attributes
    ----------
    si : float
        Value in the SI unit.
    text : str
        The user's text.  The SI value is appended if the unit is of another kind, such as turns for
        an angle, or revolutions per minute for a frequency.
    deviation : float or None
        Standard uncertainty in the SI unit; None if the value is exact.
    """

    si: float
    text: str
    deviation: float | None = None


def read(
    name: str,
    value: object,
    unit: str,
    *,
    low: float = 0.0,
    low_open: bool = True,
    high: float = math.inf,
) -> Quantity:
    """Read a quantity and check its range.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    value : object
        A text of one number and one unit ("5 mm"; 0 needs no unit), a pint quantity, or a number in
        the SI unit.
    unit : str
        The SI unit, a key of EXAMPLES.  Hz and rad/s accept cyclic frequencies (Hz, cps) and
        angular ones (rad/s, deg/s, rpm, turn/s); one turn is 2 pi.
    low, high : float
        Finite values with low < value <= high are allowed.
    low_open : bool
        False to allow `low` itself.

    Raises
    ------
    InputError
        If the value is not a quantity in this unit, or is out of range.
    """
    try:
        quantity = _from_text(value, unit) if isinstance(value, str) else _from_object(value, unit)
    except UnitError as error:
        allowed = _described(unit)
        if unit == "":
            bounds = "" if low == -math.inf else _bounds(low, low_open, high)
            allowed = f"{allowed} {bounds}".rstrip(", ")
        raise InputError(name, value, f"{error}; allowed is {allowed}") from None
    below = quantity.si <= low if low_open else quantity.si < low
    if not math.isfinite(quantity.si) or below or quantity.si > high:
        allowed = f"allowed is a finite value {_bounds(low, low_open, high)} {unit}"
        raise InputError(name, value, allowed.strip())
    return quantity


def _bounds(low: float, low_open: bool, high: float) -> str:
    below = f"{'above' if low_open else 'at least'} {low:g}"
    return below if high == math.inf else f"{below} and at most {high:g}"


def _described(unit: str) -> str:
    example = EXAMPLES[unit]
    if unit == "":
        return "a number, or per cent of one,"
    if unit in RATES:
        return f"one number in units of Hz, rad/s or rpm, such as {example!r}"
    return f"one number in units of {unit}, such as {example!r}"


# Texts


def _from_text(text: str, unit: str) -> Quantity:
    digits, rest = split_number(text)
    try:
        zero = Decimal(digits) == 0
    except InvalidOperation:  # float accepts an exponent of twenty digits
        raise UnitError(
            f"read {digits}, whose exponent is beyond the range of floating-point numbers"
        ) from None
    if math.isinf(float(digits)):
        raise UnitError(f"read {digits}, which is beyond the range of floating-point numbers")
    if unit == "":
        if rest not in ("", "%", "percent"):
            raise UnitError(stopped(digits, rest))
        value = exact(Decimal(digits), Decimal(1), Decimal(100 if rest else 1))
        shown = ""
    else:
        value, shown = _with_unit(digits, rest, unit)
    if value == 0.0 and not zero:
        raise UnitError(f"read {digits}, which is below the range of floating-point numbers")
    return Quantity(value, f"{' '.join(text.split())}{shown}")


def _with_unit(digits: str, rest: str, unit: str) -> tuple[float, str]:
    """SI value of a number with a unit, and the addition to the user's text."""
    if not rest and Decimal(digits) == 0:  # 0 is the same in all units
        return 0.0, f" {unit}"
    if not rest:
        raise UnitError(f"{digits} is a number without a unit")
    if not (rest[0].isalpha() or rest[0] == "°"):
        raise UnitError(stopped(digits, rest))
    try:
        source = read_unit(rest)
    except UnitError as error:
        raise UnitError(f"read {digits}, then {error}") from None
    value = _converted(Decimal(digits), source, unit)
    return value, _si_text(source, unit, value)


def _converted(number: Decimal, source: Unit, unit: str) -> float:
    """SI value of a number in another unit.  Raises UnitError if the dimensions differ."""
    target = si_unit(unit)
    if source.root != target.root:
        hint = HINTS.get((unit, tuple(source.root.items())), "")
        raise UnitError(f"the unit is {source}{hint}")
    return exact(number, source.factor, target.factor)


def _si_text(source: Unit, unit: str, value: float) -> str:
    """A text such as " = 62.83 rad/s" for a rate or an angle in a unit of another kind; else
    empty."""
    (first, *others) = source.names
    same = {
        "Hz": first.endswith(CYCLIC) and not others,
        "rad/s": first.endswith("radian") and others == ["second"],
        "rad": first.endswith("radian") and not others,
    }
    return "" if same.get(unit, True) else f" = {value:.6g} {unit}"


# Objects


def _from_object(value: object, unit: str) -> Quantity:
    pint = sys.modules.get("pint")  # a caller with a pint quantity has imported pint
    if pint is not None and isinstance(value, pint.Quantity):
        return _from_pint(value, unit)
    xarray = sys.modules.get("xarray")
    if xarray is not None and isinstance(value, xarray.DataArray) and value.size == 1:
        units = value.attrs.get("units", "")
        value = without_array(value.squeeze(drop=True).data)
        if units not in ("", "1"):
            return _from_text(f"{_plain_number(value)!r} {units}", unit)
    number = _plain_number(value)
    return Quantity(number, f"{number:.12g} {unit}".strip())


def _plain_number(value: object) -> float:
    """A real number as a float.  Raises UnitError for every other object."""
    if type(value) is np.ndarray and value.ndim == 0:  # its subclasses may carry units
        value = value[()]
    if isinstance(value, np.generic) and value.dtype.kind not in "iuf":
        raise UnitError(f"it is of type {type(value).__name__}")
    if type(value) is np.ndarray:
        raise UnitError(f"it is an array of shape {value.shape}")
    if isinstance(value, bool) or not isinstance(value, Real | Decimal):
        raise UnitError(f"it is of type {type(value).__name__}")
    try:
        number = float(value)
    except (OverflowError, ValueError):
        number = math.inf
    if math.isnan(number) or math.isinf(number):
        raise UnitError("it is not finite")
    if number == 0.0 and value != 0:
        raise UnitError("it is below the range of floating-point numbers")
    return number


def _from_pint(value: Any, unit: str) -> Quantity:
    """The Quantity for a pint quantity from any registry."""
    number, source = Decimal(repr(_plain_number(value.magnitude))), pint_unit(value)
    si = _converted(number, source, unit)
    shown = _si_text(source, unit, si) if unit else ""
    return Quantity(si, f"{value.magnitude} {value.units:~}".strip() + shown)
