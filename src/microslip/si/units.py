"""Read units by a strict grammar.  A short list of units is accepted, and pint computes their
values."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from decimal import Context, Decimal, localcontext
from functools import cache
from pathlib import Path
from typing import Any

DEFINITIONS = Path(__file__).with_name("units.txt")
"""Definitions of the accepted units.  The units of the group `metric` accept prefixes."""
PREFIXES = ("", "p", "n", "µ", "m", "c", "d", "da", "h", "k", "M", "G", "T")
"""Symbols of the metric prefixes, used in hints."""
MOST_FACTORS = 12
"""Largest number of factors in a unit.  It is limited because pint parses long products by
recursion."""
PLURALS = frozenset({"lb", "oz"})
"""Symbols with a plural.  Other symbols take no plural s, because it could be mistaken for a
second: Pas for Pa*s."""
CYCLIC = ("hertz", "counts_per_second")
"""Suffixes of pint's names for cyclic frequencies.  Here, 1 Hz is one turn per second, or 2 pi
rad/s."""

_NUMBER = re.compile(r"[+\-−]?(?:\d+\.?\d*|\.\d+)(?:[eE][+\-−]?\d+)?", re.ASCII)
_NOT_FINITE = re.compile(r"[+\-−]?(?:infinity|inf|nan)(?![^\W\d_])", re.IGNORECASE)
_FRACTION = re.compile(r"/\s*([1-9]\d*)\s*(.*)", re.ASCII | re.DOTALL)
"""Pattern for the rest of a fraction after its numerator."""
_NAME = r"(?:[^\W\d⁻¹²³]+|°)"
_POWER = r"(?:\s*(?:\^|\*\*)\s*-?[1-9](?!\d)|⁻?[¹²³](?!\w))?"
_SIGN = r"\s*(?:[*·⋅](?!\*)|/)\s*"
_PRODUCT = re.compile(f"{_NAME}{_POWER}(?:{_SIGN}{_NAME}{_POWER})*")
_FACTOR = re.compile(rf"(/?)\s*({_NAME})({_POWER})")
_RAISED = str.maketrans("⁻¹²³", "-123")
_EXACT = Context(prec=40)


class UnitError(Exception):
    """Error for a text or an object that is not a quantity.  The message states the reason as part
    of a sentence."""


@dataclass(frozen=True)
class Unit:
    """A product of units.

    Attributes
    ----------
    names : dict
        Exponents of the factors, by pint's names.
    root : dict
        Exponents of the root units, by name.  The radian is a root unit.
    factor : decimal.Decimal
        The unit divided by the product of its root units, dimensionless.

    Raises
    ------
    UnitError
        If the product contains a cyclic frequency.
    """

    names: dict
    root: dict
    factor: Decimal

    def __post_init__(self) -> None:
        if len(self.names) > 1 and any(name.endswith(CYCLIC) for name in self.names):
            raise UnitError(f"{self} leaves open whether 2 pi belongs to the hertz")

    def __str__(self) -> str:
        """The unit as text for messages."""
        if not self.names:
            return "that of a pure number"
        return "*".join(name if n == 1 else f"{name}^{n:g}" for name, n in self.names.items())


@cache
def registry() -> Any:
    """The pint.UnitRegistry of the accepted units.

    The registry computes in decimals, so that "1 um", "1e-3 mm" and "0.000001 m" become equal
    floats.
    """
    import pint

    return pint.UnitRegistry(DEFINITIONS, non_int_type=Decimal)


def factors(text: str) -> list[tuple[str, int]]:
    """Names and exponents of the units in a product, in the order of the text.

    An integer exponent follows ^ or **, or is a superscript.  Two units are separated by *, / or a
    dot.  Division is read from left to right.  Raises UnitError at the first character that does
    not fit.
    """
    product = _PRODUCT.match(text)
    if product is None:
        raise UnitError(f"stopped at {text!r}, where a unit was expected")
    if product.end() < len(text):
        rest = text[product.end() :].strip()
        raise UnitError(f"read {product[0]!r} and stopped at {rest!r}")
    units = _FACTOR.findall(text)
    if len(units) > MOST_FACTORS:
        raise UnitError(f"found more than {MOST_FACTORS} units in a row")
    powers = [int(power.translate(_RAISED).strip(" ^*") or 1) for _, _, power in units]
    return [(one[1], -n if one[0] else n) for one, n in zip(units, powers, strict=True)]


def read_unit(text: str) -> Unit:
    """Read a unit from a text such as "kg/m^3".  Raises UnitError."""
    with localcontext(_EXACT):
        names = [("degree" if name == "°" else name, power) for name, power in factors(text)]
        for name, _ in names:
            _check_name(name)
        parsed = registry().parse_units("*".join(f"{name}**({power})" for name, power in names))
        factor, root = registry().get_root_units(parsed)
    return Unit(_exponents(parsed), _exponents(root), Decimal(factor))


def pint_unit(quantity: Any) -> Unit:
    """The unit of a pint quantity from any registry, with the factors of that registry.

    Raises UnitError for a scale with an offset or a logarithm.
    """
    zero, one = (type(quantity)(size, quantity.units).to_root_units() for size in (0, 1))
    if zero.magnitude != 0:
        raise UnitError(f"{quantity.units} is a scale with an offset or a logarithm, not a factor")
    factor = Decimal(repr(float(one.magnitude)))  # shortest decimals, as in the definition
    unit = Unit(_exponents(quantity.units), _exponents(one.units), factor)
    if list(unit.names.values()) == [1] and next(iter(unit.names)).endswith(CYCLIC):
        hertz = si_unit("Hz")  # pint leaves out the turn
        with localcontext(_EXACT):
            return replace(unit, root=hertz.root, factor=factor * hertz.factor)
    return unit


def _check_name(name: str) -> None:
    """Raise UnitError unless a name is an accepted unit.  A prefix is allowed only if the unit
    accepts one."""
    units = registry()
    metric = units.get_group("metric").members
    readings = units.parse_unit_name(name)
    prefix, base = readings[0][:2] if readings else ("", "")
    symbol = units.get_symbol(base) if base else ""
    plural = symbol not in {base, *PLURALS} and name.endswith(f"{symbol}s")
    if base and not plural and (base in metric or not prefix):
        return
    hint = " (the mil of workshops is thou)" if name in ("mil", "mils") else ""
    accepted = {
        f"{prefix}{units.get_symbol(one)}"
        for one in units.get_group("root").members
        for prefix in (PREFIXES if one in metric else [""])
    }
    similar = sorted(one for one in accepted if one.lower() == name.lower())
    remedy = f" (did you mean {' or '.join(similar)}?)" if similar else ", as in MPa and Hz"
    raise UnitError(f"{name!r} is none of the units accepted here{hint}; capitals count{remedy}")


def _exponents(unit: Any) -> dict[str, Any]:
    """Names and exponents of a pint.Unit."""
    return dict((1 * unit).unit_items())


@cache
def si_unit(text: str) -> Unit:
    """The SI unit for a text such as "kg/m^3".  The empty text is the unit of pure numbers."""
    return read_unit(text) if text else Unit({}, {}, Decimal(1))


def exact(number: Decimal, ratio: Decimal, over: Decimal = Decimal(1)) -> float:
    """number * ratio / over as a float.  Rounding occurs only in the conversion to a float."""
    with localcontext(_EXACT):
        return float(number * ratio / over)


def split_number(text: str) -> tuple[str, str]:
    """Split a text after the number at its start.  Return the number, as a text that float accepts,
    and the rest."""
    text = text.strip()
    number = _NUMBER.match(text)
    if _NOT_FINITE.match(text):
        raise UnitError("it is not finite")
    if not text:
        raise UnitError("the text is empty")
    if number is None:
        hint = _of_other_digits(text.lstrip("+-−."))
        raise UnitError(f"stopped at {text!r}, where a number was expected{hint}")
    return number[0].replace("−", "-"), text[number.end() :].lstrip()


def stopped(read_so_far: str, rest: str) -> str:
    """A message that states where reading stopped, with a hint about the likely meaning."""
    hint = ", since decimals follow a point and thousands have no separator" if "," in rest else ""
    fraction = _FRACTION.fullmatch(rest)
    if fraction:
        value = exact(Decimal(read_so_far), Decimal(1), Decimal(fraction[1]))
        hint = f" (did you mean {f'{value!r} {fraction[2]}'.strip()!r}?)"
    return f"read {read_so_far} and stopped at {rest!r}{hint or _of_other_digits(rest)}"


def _of_other_digits(text: str) -> str:
    """A hint if a text begins with a non-ASCII digit."""
    return ", since numbers have the digits 0 to 9" if re.match(r"(?![0-9])\d", text) else ""
