"""Quantities with one number, one unit, and possibly a standard uncertainty, converted to SI units.

A string has the form NUMBER UNIT or NUMBER UNIT +- NUMBER UNIT.  A number consists of the digits 0
to 9, and can have a decimal point and an exponent.  A unit is a product of the units in UNITS with
integer exponents, as in "kg/m^3".  Division is read from left to right.  Every other string is
refused.  Conversion factors are exact fractions, so that equal quantities, such as "1 um" and
"1e-3 mm", give equal floats.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from itertools import product
from numbers import Real
from typing import Any, NamedTuple

TURN = Fraction("6.2831853071795864769252867665590057683943387987502")
"""One turn in radians."""
BASES = ("m", "kg", "s", "rad", "K")
PREFIXES = dict(zip("pnumcdhkMGT", (-12, -9, -6, -3, -2, -1, 2, 3, 6, 9, 12), strict=True))
SPELLED = "pico nano micro milli centi deci hecto kilo mega giga tera"
SPELLED_PREFIXES = dict(zip(SPELLED.split(), PREFIXES.values(), strict=True)) | {"": 0}
PREFIXES |= {"": 0, "da": 1, "µ": -6, "μ": -6}
"""Exponent of 10, keyed by metric prefix."""
DEFINITIONS = {
    "m=m s=s rad=rad K=K g=1e-3*kg N=kg*m/s^2 Pa=N/m^2 bar=1e5*Pa l,L=1e-3*m^3 turn,rev=turn "
    "deg=1/360*turn Hz,cps=turn/s W=N*m/s J=N*m": PREFIXES,
    "°=deg min=60*s h,hr,hour=3600*s d,day=86400*s rpm=turn/min rps=turn/s arcmin=1/60*deg "
    "arcsec=1/60*arcmin gon=1/400*turn in,inch,inches=0.0254*m thou=1e-3*in ft,foot,feet=12*in "
    "yd,yard=3*ft mi,mile=5280*ft angstrom,Å,Å=1e-10*m micron=1e-6*m t,tonne=1e3*kg cc=1e-6*m^3 "
    "lb,lbs=0.45359237*kg oz=1/16*lb gf=9.80665*g*m/s^2 kgf=1e3*gf dyn=1e-5*N lbf=453.59237*gf "
    "ozf=1/16*lbf kip,kips=1e3*lbf slug=lbf*s^2/ft psi=lbf/in^2 ksi=1e3*psi atm=101325*Pa "
    "kn,kt,knot=1852*m/h mph=mi/h kph=1e3*m/h mps=m/s fps=ft/s": {"": 0},
    "meter,metre=m second=s gram=g radian=rad newton=N pascal=Pa degree=deg": SPELLED_PREFIXES,
}
"""Each key contains definitions of units.  Each value contains the prefixes that are allowed for
these units.  A definition is a number times known units.  One hertz is one turn per second, which
is 2 pi times 1 rad/s."""
CYCLIC = re.compile(r"\w{0,2}(Hz|cps)")
"""Pattern of a unit of cyclic frequency, such as Hz.  Such a unit is accepted alone, but not in a
product of units."""
ANGULAR = re.compile(r"\w?rad(/s|\s*s\^?-1|·?s⁻¹)?")
"""Units of the same kind as rad or rad/s."""
NUMBER = re.compile(r"[+-]?(?:(\d+)\.?(\d*)|\.(\d+))(?:[eE]([+-]?\d+))?", re.A)
FACTOR = re.compile(
    r"\s*([*/·⋅]?)\s*([^\W\d⁻¹²³]+|°)(?:\s*(?:\^|\*\*)\s*(-?[1-9])(?!\d)|(⁻?[¹²³])(?!\w))?"
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
"""For each SI unit, an example of a quantity."""
RATE = ", which may mean Hz or rad/s; they differ by 2 pi, so write one of them"
HINTS = {
    "Hz": {"s^-1": RATE},
    "rad/s": {"s^-1": RATE},
    "N": {"kg": ", of a mass; for its weight write gf or kgf, as in '500 gf'"},
    "m/s": {"rpm": ", of a rotation; its speed is the rate in rad/s times a radius"},
}
"""Hints about wrong units.  The outer key is the required SI unit.  The inner key is a unit of the
same kind as the wrong unit."""


class Unit(NamedTuple):
    """A unit, described by a factor and by the exponents of the base units m, kg, s, rad and K. The
    unit is the factor times the product of the base units."""

    factor: Fraction
    powers: tuple[int, ...]


@dataclass(frozen=True)
class Quantity:
    """A quantity in its SI unit.

    Attributes
    ----------
    si : float
        Value in the SI unit.
    text : str
        The string of the user, followed by the SI value if the unit is of another kind, such as
        turns.
    deviation : float
        Standard uncertainty in the SI unit; 0 for an exact value.
    """

    si: Any
    text: str
    deviation: float = 0.0


def unit_of(text: str) -> Unit:
    """Read a product of units, such as "kg/m^3".  Raises ValueError."""
    factor, powers, place, count = Fraction(1), (0,) * len(BASES), 0, 0
    while place < len(text):
        match, count = FACTOR.match(text, place), count + 1
        if match is None or bool(match[1]) != bool(place):
            before = f"read {text[:place].strip()!r} and " if place else ""
            raise ValueError(f"{before}stopped at {text[place:].strip()!r}")
        name = match[2]
        if count > MOST_FACTORS:
            raise ValueError(f"more than {MOST_FACTORS} units in a row")
        if name not in UNITS:
            similar = sorted(one for one in UNITS if one.lower() == name.lower())
            hint = f" (did you mean {' or '.join(similar)}?)" if similar else ", as in MPa and Hz"
            mil = " (the mil of workshops is thou)" if name in ("mil", "mils") else ""
            problem = f"{name!r} is none of the units accepted here{mil}"
            raise ValueError(f"{problem}; capitals count{hint}")
        if CYCLIC.fullmatch(name) and match[0].strip() != text.strip():
            raise ValueError(f"{text.strip()} leaves open whether 2 pi belongs to the hertz")
        power = int((match[3] or match[4] or "1").translate(RAISED))
        power = -power if match[1] == "/" else power
        factor *= UNITS[name].factor ** power
        powers = tuple(p + power * q for p, q in zip(powers, UNITS[name].powers, strict=True))
        place = match.end()
    return Unit(factor, powers)


UNITS = {one: Unit(Fraction(1), tuple(int(one == base) for base in BASES)) for one in BASES}
UNITS["turn"] = Unit(TURN, UNITS["rad"].powers)
"""All accepted units, keyed by name.  Names include metric prefixes."""


for _entries, _prefixes in DEFINITIONS.items():
    for _names, _times, _units in re.findall(r"(\S+?)=(?:([\d.e/-]+)\*)?(\S+)", _entries):
        _factor, _powers = unit_of(_units)
        for _name, (_prefix, _ten) in product(_names.split(","), _prefixes.items()):
            _size = _factor * Fraction(_times or 1) * Fraction(10) ** _ten
            UNITS.setdefault(_prefix + _name, Unit(_size, _powers))


def read(value: Any, si: str) -> Quantity:
    """Read a quantity.

    Parameters
    ----------
    value : object
        A string such as "10 N" or "10 N +- 5 %", a quantity of pint, an array of one value, or a
        number in the SI unit.
    si : str
        SI unit; empty for a pure number, which can also be in per cent.  Hz and rad/s accept
        cyclic frequencies and angular speeds.

    Raises
    ------
    ValueError
        If the value is not a quantity in this unit.  The message contains the allowed values.
    """
    try:
        if isinstance(value, str):
            return _from_text(value, si)
        unit, plain = "", not hasattr(value, "units")
        if hasattr(value, "to_root_units"):  # a quantity of pint
            unit = f"{value.units:~C}".replace("percent", "%")
            unit, value = f"m/m/{unit[2:]}" if unit.startswith("1/") else unit, value.magnitude
        elif hasattr(value, "dims"):  # a DataArray
            unit = value.attrs.get("units", "1").removeprefix("1")
            plain = not unit
        if plain:
            number = plain_number(value)
            return Quantity(number, f"{number:.12g} {si}".strip())
        digits = repr(plain_number(value)).removesuffix(".0")
        return _from_text(f"{digits} {unit}", si, units=True)
    except ValueError as error:
        kind = f"one number in units of {si}" if si else "a number, or per cent of one"
        kind = "one number in units of Hz, rad/s or rpm" if si in ("Hz", "rad/s") else kind
        example = EXAMPLES.get(si, f"1 {si}")
        raise ValueError(f"{error}; allowed is {kind}, such as {example!r}") from None


def plain_number(value: Any) -> float:
    """Convert a real number of any type to a float.  Raises ValueError for every other object."""
    if hasattr(value, "dtype") and value.size == 1 and not hasattr(value, "mask"):
        value = value.item()
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
    """Return the `Quantity` for a string.  If `units` is true, units of a pure number, such as
    N/kN, are accepted."""
    centre, *rest = UNCERTAINTY.split(text.strip())
    if len(rest) > 1:
        raise ValueError("it has more than one uncertainty")
    numbers: list[float] = []
    for part in (centre, *rest):
        is_share = bool(numbers) and part.endswith("%") and not centre.endswith("%")
        try:
            number, same = _number(part, "" if is_share else si, units)
        except ValueError as error:
            unit = NUMBER.sub("", rest[0], 1).strip() if rest and NUMBER.fullmatch(centre) else ""
            hint = f" (did you mean '{centre} {unit} +- {rest[0]}'?)" if unit else ""
            raise ValueError(f"in it {part!r}: {error}{hint}" if rest else str(error)) from None
        numbers.append(abs(numbers[0]) * number if is_share else number)
    number, deviation = (*numbers, 0.0)[:2]
    if rest and not 0.0 < deviation <= abs(number):
        raise ValueError("the uncertainty must be above 0 and at most the value")
    addition = "" if same or rest else f" = {number:.6g} {si}"
    return Quantity(number, " ".join(text.split()) + addition, deviation)


def _number(text: str, si: str, units: bool) -> tuple[float, bool]:
    """Return two values: a number in SI units, and a boolean.  The boolean is False if an angle or
    a frequency has a unit of another kind, such as deg instead of rad."""
    text = text.replace("−", "-").strip()
    match = NUMBER.match(text)
    if not text or re.match(r"[+-]?(inf|nan)", text, re.I):
        raise ValueError("it is not finite" if text else "the text is empty")
    if match is None:
        raise ValueError(f"stopped at {text!r}, where a number was expected{_hint('', text)}")
    digits, rest = match[0], text[match.end() :].strip()
    is_zero = not re.search("[1-9]", "".join(filter(None, match.groups()[:3])))
    if math.isinf(float(digits)) or len(match[4] or "") > 18:
        problem = "whose exponent is beyond the range of floating-point numbers"
        raise ValueError(f"read {digits}, {problem}")
    if float(digits) == 0.0 and not is_zero:
        raise ValueError(f"read {digits}, which is below the range of floating-point numbers")
    if rest in ("%", "percent") and not si:
        return float(Fraction(Decimal(digits)) / 100), True
    if not rest and (not si or is_zero):
        return float(digits), True
    if not rest:
        raise ValueError(f"{digits} is a number without a unit")
    if not (rest[0].isalpha() or rest[0] == "°") or not (si or units):
        raise ValueError(f"read {digits} and stopped at {rest!r}{_hint(digits, rest)}")
    try:
        unit, target = unit_of(rest), unit_of(si)
    except ValueError as error:
        raise ValueError(f"read {digits}, then {error}") from None
    if unit.powers != target.powers:
        kinds = {unit_of(one).powers: hint for one, hint in HINTS.get(si, {}).items()}
        hint = kinds.get(unit.powers, "") if any(unit.powers) else ", that of a pure number"
        raise ValueError(f"the unit is {rest}{hint}")
    value = float(Fraction(Decimal(digits)) * unit.factor / target.factor)
    if not math.isfinite(value) or (value == 0.0 and not is_zero):
        raise ValueError(f"{text} is beyond the range of floating-point numbers")
    kind = {"Hz": CYCLIC, "rad": ANGULAR, "rad/s": ANGULAR}.get(si)
    return value, kind is None or kind.fullmatch(rest) is not None


def _hint(digits: str, rest: str) -> str:
    """Return a hint about `rest`, the unreadable text after the digits of a number."""
    if digits and (fraction := re.fullmatch(r"/\s*([1-9]\d*)\s*(.*)", rest, re.S)):
        value = float(Fraction(Decimal(digits)) / int(fraction[1]))
        return f" (did you mean {f'{value!r} {fraction[2]}'.strip()!r}?)"
    if digits and "," in rest:
        return ", since decimals follow a point and thousands have no separator"
    other = re.match(r"(?![0-9])\d", rest.lstrip("+-."))
    return ", since numbers have the digits 0 to 9" if other else ""
