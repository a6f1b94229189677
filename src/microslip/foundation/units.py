"""Quantities: one number, one unit, and possibly a standard uncertainty, converted to SI units.

A text has the form NUMBER UNIT or NUMBER UNIT +- NUMBER UNIT.  A number has the digits 0 to 9, a
decimal point and an exponent.  A unit is a product of the units in UNITS with integer exponents, as
in "kg/m^3".  Division is read from left to right.  Every other text is refused.  Factors are exact
fractions, so that equal quantities are equal floats: "1 um" and "1e-3 mm".
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

TURN = Fraction("6.2831853071795864769252867665590057683943387987502")
"""One turn in radians."""


class Unit(NamedTuple):
    """Factor to the product of base units, and exponents of m, kg, s, rad and K."""

    factor: Fraction
    powers: tuple[int, ...]


BASES = ("m", "kg", "s", "rad", "K")
ONE = Unit(Fraction(1), (0, 0, 0, 0, 0))
PREFIXES = dict(zip("pnumcdhkMGT", (-12, -9, -6, -3, -2, -1, 2, 3, 6, 9, 12), strict=True))
PREFIXES |= {"": 0, "da": 1, "µ": -6, "μ": -6}
"""Exponent of 10, keyed by metric prefix."""
SPELLED = {"pico": "p", "nano": "n", "micro": "u", "milli": "m", "centi": "c", "deci": "d"}
SPELLED |= {"hecto": "h", "kilo": "k", "mega": "M", "giga": "G", "tera": "T", "": ""}
"""Symbols of the metric prefixes, by name."""
DEFINITIONS = """
prefixed: m g=1e-3*kg s rad N=kg*m/s^2 Pa=N/m^2 bar=1e5*Pa l,L=1e-3*m^3 turn,rev=TURN*rad
prefixed: deg=1/360*turn Hz,cps=turn/s W=N*m/s J=N*m K
alone: °=deg min=60*s h,hr,hour=3600*s d,day=86400*s rpm=turn/min rps=turn/s arcmin=1/60*deg
alone: arcsec=1/60*arcmin gon=1/400*turn in,inch,inches=0.0254*m thou=1e-3*in ft,foot,feet=12*in
alone: yd,yard=3*ft mi,mile=5280*ft angstrom,Å,Å=1e-10*m micron=1e-6*m t,tonne=1e3*kg cc=1e-6*m^3
alone: lb,lbs=0.45359237*kg oz=1/16*lb gf=9.80665*g*m/s^2 kgf=1e3*gf dyn=1e-5*N lbf=453.59237*gf
alone: ozf=1/16*lbf kip,kips=1e3*lbf slug=lbf*s^2/ft psi=lbf/in^2 ksi=1e3*psi atm=101325*Pa
spelled: meter,metre=m second=s gram=g radian=rad newton=N pascal=Pa degree=deg
alone: kn,kt,knot=1852*m/h mph=mi/h kph=1e3*m/h mps=m/s fps=ft/s
"""
"""Units by kind.  A unit is a number times known units; the first units are the base units.  One
hertz is one turn per second, which differs from 1 rad/s by 2 pi."""
CYCLIC = re.compile(r"\w{0,2}(Hz|cps)")
"""Names of cyclic frequencies, which are accepted alone but not in products."""
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.A)
FACTOR = re.compile(
    r"\s*([*/·⋅]?)\s*([^\W\d⁻¹²³]+|°)(?:\s*(?:\^|\*\*)\s*(-?[1-9])(?!\d)|⁻?[¹²³](?!\w))?"
)
UNCERTAINTY = re.compile(r"\s*(?:\+-|\+/-|±)\s*")
RAISED = str.maketrans("⁻¹²³", "-123")
MOST_FACTORS = 12
"""Largest number of factors in a unit."""
EXAMPLES = {
    **{"Pa": "210 GPa", "m": "5 mm", "s": "1 ms", "N": "10 N", "m/s": "1 mm/s", "Hz": "20 kHz"},
    **{"rad": "0.5 deg", "rad/s": "60 rpm", "kg/m^3": "7850 kg/m^3", "N/m": "10 N/um", "": "0.3"},
    **{"kg": "20 g", "N*s/m": "5 N*s/m", "m^2/N": "1e-5 mm^3/N/m"},
}
"""An example of a quantity for each SI unit."""
RATES = "Hz", "rad/s"


@dataclass(frozen=True)
class Quantity:
    """A quantity in its SI unit.

    Attributes
    ----------
    si : float
        Value in the SI unit.
    text : str
        The text of the user, with the SI value if the unit is of another kind, such as turns.
    deviation : float
        Standard uncertainty in the SI unit; 0 for an exact value.
    """

    si: Any
    text: str
    deviation: float = 0.0


def _units() -> dict[str, Unit]:
    base = {
        name: Unit(Fraction(1), tuple(np.eye(5, dtype=int)[k].tolist()))
        for k, name in enumerate(BASES)
    }
    units = dict(base)
    for line in DEFINITIONS.strip().splitlines():
        kind, entries = line.split(": ")
        for entry in entries.split():
            names, _, definition = entry.partition("=")
            factor, powers = base[names] if not definition else ONE
            for sign, word in re.findall(r"(?:^|([*/]))([^*/]+(?:/\d+)?)", definition):
                name, _, power = word.partition("^")
                one = units.get(name) or Unit(
                    TURN if name == "TURN" else Fraction(name), ONE.powers
                )
                n = int(power or 1) * (-1 if sign == "/" else 1)
                factor *= one.factor**n
                powers = tuple(p + n * q for p, q in zip(powers, one.powers, strict=True))
            kinds = {"prefixed": PREFIXES, "spelled": {n: PREFIXES[x] for n, x in SPELLED.items()}}
            for prefix, ten in kinds.get(kind, {"": 0}).items():
                scaled = Unit(factor * Fraction(10) ** ten, powers)
                units |= {
                    prefix + name: scaled for name in names.split(",") if prefix + name not in units
                }
    return units


UNITS = _units()
"""Every accepted name of a unit, with its prefix."""


def unit_of(text: str) -> Unit:
    """Read a product of units, such as "kg/m^3".  Raises ValueError."""
    unit, place, count = ONE, 0, 0
    while place < len(text):
        match = FACTOR.match(text, place)
        if match is None or bool(match[1]) != bool(place):
            before = f"read {text[:place].strip()!r} and " if place else ""
            raise ValueError(f"{before}stopped at {text[place:].strip()!r}")
        name, count = match[2], count + 1
        if count > MOST_FACTORS:
            raise ValueError(f"more than {MOST_FACTORS} units in a row")
        if name not in UNITS:
            similar = sorted(one for one in UNITS if one.lower() == name.lower())
            hint = f" (did you mean {' or '.join(similar)}?)" if similar else ", as in MPa and Hz"
            mil = " (the mil of workshops is thou)" if name in ("mil", "mils") else ""
            raise ValueError(
                f"{name!r} is none of the units accepted here{mil}; capitals count{hint}"
            )
        raised = match[0][match.end(2) - match.start() :].strip().translate(RAISED).lstrip("^*")
        power = int(raised or 1) * (-1 if match[1] == "/" else 1)
        powers = (p + power * q for p, q in zip(unit.powers, UNITS[name].powers, strict=True))
        unit, place = Unit(unit.factor * UNITS[name].factor ** power, tuple(powers)), match.end()
        if CYCLIC.fullmatch(name) and match[0].strip() != text.strip():
            raise ValueError(f"{text.strip()} leaves open whether 2 pi belongs to the hertz")
    return unit


def read(value: Any, si: str) -> Quantity:
    """Read a quantity.

    Parameters
    ----------
    value : object
        A text such as "10 N" or "10 N +- 5 %", a quantity of pint, or a number in the SI unit.
    si : str
        SI unit; empty for a pure number, which can also be in per cent.  Hz and rad/s accept
        cyclic frequencies and angular speeds.

    Raises
    ------
    ValueError
        If the value is not a quantity in this unit.  The message says what is allowed.
    """
    try:
        if isinstance(value, str):
            return _from_text(value, si)
        if hasattr(value, "to_root_units"):  # a quantity of pint
            unit = f"{value.units:~C}".replace("percent", "%")
            unit = f"m/m/{unit[2:]}" if unit.startswith("1/") else unit
            digits = repr(plain_number(value.magnitude)).removesuffix(".0")
            return _from_text(f"{digits} {unit}", si, units=True)
        if (
            hasattr(value, "dims")
            and value.size == 1
            and value.attrs.get("units", "1") not in ("", "1")
        ):
            digits = repr(plain_number(value)).removesuffix(".0")  # a DataArray with a unit
            return _from_text(f"{digits} {value.attrs['units']}", si, units=True)
        number = plain_number(value)
        return Quantity(number, f"{number:.12g} {si}".strip())
    except ValueError as error:
        kind = (
            f"one number in units of {si}, such as"
            if si
            else "a number, or per cent of one, such as"
        )
        if si in RATES:
            kind = "one number in units of Hz, rad/s or rpm, such as"
        raise ValueError(f"{error}; allowed is {kind} {EXAMPLES.get(si, f'1 {si}')!r}") from None


def plain_number(value: Any) -> float:
    """Convert a real number of any type to a float.  Raises ValueError for every other object."""
    one = getattr(value, "size", 0) == 1 and not isinstance(value, np.ma.MaskedArray)
    if hasattr(value, "dims") and one or getattr(value, "ndim", 1) == 0 and one:
        value = value.item()  # a DataArray of one value, or an array without dimensions
    if getattr(value, "ndim", 0):
        raise ValueError(f"it is an array of shape {value.shape}")
    if isinstance(value, bool) or not isinstance(value, Real | Decimal):
        raise ValueError(f"it is of type {type(value).__name__}")
    try:
        number = float(value)
    except (OverflowError, ValueError):
        number = math.inf
    if not math.isfinite(number):
        raise ValueError("it is not finite")
    if number == 0.0 and value != 0:
        raise ValueError("it is below the range of floating-point numbers")
    return number


def _from_text(text: str, si: str, units: bool = False) -> Quantity:
    """The Quantity for a text.  units: True to accept units of a pure number, such as N/kN."""
    shown = " ".join(text.split())
    centre, *rest = UNCERTAINTY.split(text.strip())
    if len(rest) > 1:
        raise ValueError("it has more than one uncertainty")
    try:
        number, same = _number(centre, si, units)
    except ValueError as error:
        raise ValueError(f"in it {centre!r}: {error}" if rest else str(error)) from None
    addition = "" if same or rest else f" = {number:.6g} {si}"
    if not rest:
        return Quantity(number, shown + addition)
    try:
        if rest[0].endswith("%") and not centre.endswith("%"):
            deviation = abs(number) * _number(rest[0], "")[0]
        else:
            deviation = _number(rest[0], si)[0]
    except ValueError as error:
        raise ValueError(f"in it {rest[0]!r}: {error}") from None
    if not 0.0 < deviation <= abs(number):
        raise ValueError("the uncertainty must be above 0 and at most the value")
    return Quantity(number, shown, deviation)


def _number(text: str, si: str, units: bool = False) -> tuple[float, bool]:
    """SI value of a number with a unit, and whether its unit is of the kind of the SI unit."""
    text = text.replace("−", "-").strip()
    match = NUMBER.match(text)
    if not text:
        raise ValueError("the text is empty")
    if re.match(r"[+-]?(inf|nan)", text, re.I):
        raise ValueError("it is not finite")
    if match is None:
        raise ValueError(f"stopped at {text!r}, where a number was expected{_digits_hint(text)}")
    digits, rest = match[0], text[match.end() :].strip()
    size, zero = float(digits), not re.search("[1-9]", re.split("[eE]", digits)[0])
    if math.isinf(size) or len(re.split("[eE]", digits)[-1]) > 18 and "e" in digits.lower():
        raise ValueError(
            f"read {digits}, whose exponent is beyond the range of floating-point numbers"
        )
    if size == 0.0 and not zero:
        raise ValueError(f"read {digits}, which is below the range of floating-point numbers")
    if rest in ("%", "percent") and not si:
        return float(Fraction(Decimal(digits)) / 100), True
    if not rest and (not si or zero):
        return size, True
    if not rest:
        raise ValueError(f"{digits} is a number without a unit")
    if not (rest[0].isalpha() or rest[0] == "°") or not (si or units):
        raise ValueError(f"read {digits} and stopped at {rest!r}{_stop_hint(digits, rest)}")
    try:
        unit = unit_of(rest)
    except ValueError as error:
        raise ValueError(f"read {digits}, then {error}") from None
    target = unit_of(si)
    if unit.powers != target.powers:
        raise ValueError(f"the unit is {rest}{_wrong_unit_hint(si, unit)}")
    value = float(Fraction(Decimal(digits)) * unit.factor / target.factor)
    if not math.isfinite(value) or (value == 0.0 and not zero):
        raise ValueError(f"{text} is beyond the range of floating-point numbers")
    if si == "Hz":
        return value, CYCLIC.fullmatch(rest) is not None
    return value, si not in ("rad", "rad/s") or re.fullmatch(
        r"\w?rad(/s|\s*s\^?-1|·?s⁻¹)?", rest
    ) is not None


def _wrong_unit_hint(si: str, unit: Unit) -> str:
    if unit.powers == ONE.powers:
        return ", that of a pure number"
    if si in RATES and unit.powers == UNITS["s"]._replace(powers=(0, 0, -1, 0, 0)).powers:
        return ", which may mean Hz or rad/s; they differ by 2 pi, so write one of them"
    if si == "N" and unit.powers == UNITS["kg"].powers:
        return ", of a mass; for its weight write gf or kgf, as in '500 gf'"
    if si == "m/s" and unit.powers == UNITS["rpm"].powers:
        return ", of a rotation; its speed is the rate in rad/s times a radius"
    return ""


def _stop_hint(digits: str, rest: str) -> str:
    """The likely meaning of the text at which reading stopped."""
    fraction = re.fullmatch(r"/\s*([1-9]\d*)\s*(.*)", rest, re.S)
    if fraction:
        value = float(Fraction(Decimal(digits)) / int(fraction[1]))
        return f" (did you mean {f'{value!r} {fraction[2]}'.strip()!r}?)"
    if "," in rest:
        return ", since decimals follow a point and thousands have no separator"
    return _digits_hint(rest)


def _digits_hint(text: str) -> str:
    other = re.match(r"(?![0-9])\d", text.lstrip("+-."))
    return ", since numbers have the digits 0 to 9" if other else ""
