"""Numbers with units: texts such as "210 GPa" to SI values, by a strict grammar.

A text is one number and one unit.  The number is what Python's float takes, in the digits 0 to 9,
without underscores and with the Unicode minus as a minus; the unit is what `units` reads.  Nothing
else passes: of a text that is not understood from its first to its last character, no part counts.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from numbers import Real
from typing import Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.units import (
    TURN_RATE,
    Unit,
    UnitError,
    exact,
    full_turn,
    read_unit,
    si_unit,
    split_number,
    stopped,
)

EXAMPLES = {
    "Pa": "210 GPa",
    "m": "5 mm",
    "N": "10 N",
    "m/s": "1 mm/s",
    "Hz": "20 kHz",
    "rad": "0.5 deg",
    "rad/s": "60 rpm",
    "kg/m^3": "7850 kg/m^3",
    "N/m": "10 N/um",
    "kg": "20 g",
    "N*s/m": "5 N*s/m",
    "": "0.3",
}
"""Example of a value in each unit."""
RATES = ("Hz", "rad/s")
"""Units of what may be given by periods or by angles."""

OTHER_KINDS = {
    ("N", (("gram", 1),)): "a mass; for its weight write gf or kgf, as in '500 gf'",
    ("m/s", tuple(TURN_RATE.items())): "a rotation; its speed is the rate in rad/s times a radius",
}
"""Hints by the SI unit that is needed and the root units of the one that was written instead."""


@dataclass(frozen=True)
class Given:
    """A quantity that has been read.

    Attributes
    ----------
    si : float
        Its value, in the unit of the SI that was asked for.
    text : str
        As it was given, with the value in the SI behind it where that is another kind of measure:
        turns for angles, revolutions a minute for hertz.
    """

    si: float
    text: str


def read(
    name: str,
    value: object,
    unit: str,
    *,
    low: float = 0.0,
    low_open: bool = True,
    high: float = math.inf,
) -> Given:
    """A quantity, read and checked.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    value : object
        Text of one number and one unit ("5 mm"; 0 may have none), pint quantity, or a plain number,
        which is taken to be in the SI unit already.
    unit : str
        The SI unit, a key of EXAMPLES.  Hz and rad/s take both cyclic frequencies (Hz, cps) and
        angular ones (rad/s, deg/s, rpm, turn/s): one turn is 2 pi, exactly.
    low, high : float
        Allowed are finite values with low < value <= high.
    low_open : bool
        Whether `low` itself is not allowed.

    Raises
    ------
    InputError
        What is wrong, and what is allowed.
    """
    try:
        given = _from_text(value, unit) if isinstance(value, str) else _from_object(value, unit)
    except UnitError as error:
        allowed = _described(unit)
        if unit == "":
            allowed += f" {_bounds(low, low_open, high)}"
        raise InputError(name, value, f"{error.reason}; allowed is {allowed}") from None
    beyond = given.si <= low if low_open else given.si < low
    if not math.isfinite(given.si) or beyond or given.si > high:
        allowed = f"allowed is a finite value {_bounds(low, low_open, high)} {unit}"
        raise InputError(name, value, allowed.strip())
    return given


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


def _from_text(text: str, unit: str) -> Given:
    digits, rest = split_number(text)
    try:
        zero = Decimal(digits) == 0
    except InvalidOperation:  # an exponent of twenty digits, which float takes all the same
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
    return Given(value, f"{' '.join(text.split())}{shown}")


def _with_unit(digits: str, rest: str, unit: str) -> tuple[float, str]:
    """Value of a number with the text of its unit, and what there is to say of it."""
    if not rest and Decimal(digits) == 0:  # 0 is the same in all units
        return 0.0, f" {unit}"
    if not rest:
        raise UnitError(f"{digits} is a number without a unit")
    if not (rest[0].isalpha() or rest[0] == "°"):
        raise UnitError(stopped(digits, rest))
    try:
        found = read_unit(rest)
    except UnitError as error:
        raise UnitError(f"read {digits}, then {error.reason}") from None
    above, below = _ratio(found, unit)
    value = exact(Decimal(digits), above, below)
    return value, _si_beside(found, unit, value)


def _ratio(found: Unit, unit: str) -> tuple[Decimal, Decimal]:
    """The unit that was found over the SI one, as two decimals: numerator and denominator."""
    wanted, turn = si_unit(unit), Decimal(1)
    if unit in RATES:
        found_turns = _turns(found)
        if found_turns and unit == "Hz":
            return found.factor, full_turn()
        if not found_turns and unit == "rad/s":
            turn = full_turn()
        return found.factor * turn, Decimal(1)
    _refuse_periods(found)
    if found.root != wanted.root:
        kind = OTHER_KINDS.get((unit, tuple(found.root.items())))
        raise UnitError(f"the unit is {_named(found)}{f', of {kind}' if kind else ''}")
    return found.factor, wanted.factor


def _turns(found: Unit) -> bool:
    """Whether a rate is one of angles rather than of periods; raises UnitError if it is neither."""
    if found.root == TURN_RATE:
        _refuse_periods(found)
        return True
    if found.counts_periods:
        return False
    _refuse_periods(found)
    if found.root == {"second": -1}:
        raise UnitError(f"{_named(found)} may mean Hz or rad/s, which differ by 2 pi: say which")
    raise UnitError(f"the unit is {_named(found)}")


def _refuse_periods(found: Unit) -> None:
    if found.mixes_periods:
        raise UnitError(f"{_named(found)} leaves open whether 2 pi belongs to the hertz")


def _named(found: Unit) -> str:
    if not found.names:
        return "that of a pure number"
    return "*".join(name if n == 1 else f"{name}^{n:g}" for name, n in found.names.items())


def _si_beside(found: Unit, unit: str, value: float) -> str:
    """The text " = 62.83 rad/s" where a rate or an angle was given by another kind of measure."""
    (first, *others) = found.names
    same = {
        "Hz": found.counts_periods,
        "rad/s": first.endswith("radian") and others == ["second"],
        "rad": first.endswith("radian") and not others,
    }
    return "" if same.get(unit, True) else f" = {value:.6g} {unit}"


# Objects


def _from_object(value: object, unit: str) -> Given:
    pint = sys.modules.get("pint")  # whoever hands in a quantity of it has imported it
    if pint is not None and isinstance(value, pint.Quantity):
        return _from_pint(value, unit)
    number = _plain_number(value)
    return Given(number, f"{number:.12g} {unit}".strip())


def _plain_number(value: object) -> float:
    """A real number as a float; raises UnitError for everything else, by its type."""
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


def _from_pint(value: Any, unit: str) -> Given:
    """A pint quantity of any registry: its own factors, the rules of this module."""
    number = Decimal(repr(_plain_number(value.magnitude)))
    zero, one = (type(value)(size, value.units).to_root_units() for size in (0, 1))
    if zero.magnitude != 0:
        raise UnitError(f"{value.units} is a scale with an offset or a logarithm, not a factor")
    factor = Decimal(repr(float(one.magnitude)))  # decimals as short as those of the definition
    found = Unit(dict(value.unit_items()), dict(one.unit_items()), factor)
    if unit == "":
        if found.root:
            raise UnitError(f"the unit is {_named(found)}")
        return Given(exact(number, factor), f"{value.magnitude} {value.units:~}".strip())
    above, below = _ratio(found, unit)
    si = exact(number, above, below)
    return Given(si, f"{value.magnitude} {value.units:~}{_si_beside(found, unit, si)}")
