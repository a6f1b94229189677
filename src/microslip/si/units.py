"""Numbers and units of texts: a strict grammar, the names that count, and pint for their values."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from functools import cache
from pathlib import Path
from typing import Any

DEFINITIONS = Path(__file__).with_name("units.txt")
"""Definitions of the units that are known; those of its group `metric` take prefixes."""
PREFIXES = ("", "p", "n", "µ", "m", "c", "d", "da", "h", "k", "M", "G", "T")
"""Symbols of the prefixes, for hints."""
MOST_FACTORS = 12
"""Units that a text may multiply; pint reads long products by recursion."""
PLURALS = frozenset({"lb", "oz"})
"""Symbols that take a plural; behind all others an s would be a second left without its sign, as in
Pas for Pa*s."""
CYCLIC = ("hertz", "counts_per_second")
"""How names of units end that count periods: 1 Hz is one turn a second."""
TURN_RATE = {"radian": 1, "second": -1}
"""Root units of what turns; pint itself takes radians for pure numbers."""

_NUMBER = re.compile(r"[+\-−]?(?:\d+\.?\d*|\.\d+)(?:[eE][+\-−]?\d+)?", re.ASCII)
_NOT_FINITE = re.compile(r"[+\-−]?(?:infinity|inf|nan)(?![^\W\d_])", re.IGNORECASE)
_FRACTION = re.compile(r"/\s*([1-9]\d*)\s*(.*)", re.ASCII | re.DOTALL)
"""Text after the numerator of a fraction."""
_NAME = re.compile(r"[^\W\d⁻¹²³]+|°")
_POWER = re.compile(r"\s*(?:\^|\*\*)\s*(-?[1-9])(?!\d)|(⁻?[¹²³])(?!\w)")
_SIGN = re.compile(r"\s*(?:([*·⋅])(?!\*)|(/))\s*")
_RAISED = str.maketrans("⁻¹²³", "-123")
_EXACT = Context(prec=40)


class UnitError(Exception):
    """A text that is no unit.

    Attributes
    ----------
    reason : str
        Why not, as the middle of a sentence.
    """

    def __init__(self, reason: str):
        self.reason = reason
        super().__init__(reason)


@dataclass(frozen=True)
class Unit:
    """A unit that has been read.

    Attributes
    ----------
    names : dict
        pint's names of the units it is made of, and their exponents.
    root : dict
        Names of its root units, and their exponents; radians are one of them.
    factor : decimal.Decimal
        The unit over the product of its root units, dimensionless.
    """

    names: dict
    root: dict
    factor: Decimal

    @property
    def counts_periods(self) -> bool:
        """Whether it is a cyclic frequency: hertz or cycles a second, by name."""
        return len(self.names) == 1 and self.root.get("second") == -1 and self._has_cyclic

    @property
    def _has_cyclic(self) -> bool:
        return any(name.endswith(CYCLIC) for name in self.names)

    @property
    def mixes_periods(self) -> bool:
        """Whether hertz is a part of it: nobody can say whether 2 pi is meant there."""
        return self._has_cyclic and not self.counts_periods


@cache
def registry() -> Any:
    """The pint.UnitRegistry in use.

    It computes in decimals, so that "1 um", "1e-3 mm" and "0.000001 m" are one number, to the last
    bit.
    """
    import pint

    return pint.UnitRegistry(DEFINITIONS, non_int_type=Decimal)


def factors(text: str) -> list[tuple[str, int]]:
    """The units that a text multiplies: their names and exponents, in the order of the text.

    Names with whole exponents after ^ or **, or superscripts, and one of * / and the dot between
    them; division goes from left to right.  Raises UnitError at the first character that does not
    fit.
    """
    found, place, sign = [], 0, 1
    while True:
        name = _NAME.match(text, place)
        if name is None:
            where = f"at {text[place:]!r}" if text[place:] else f"at the end of {text!r}"
            raise UnitError(f"stopped {where}, where a unit was expected")
        power = _POWER.match(text, name.end())
        exponent = int((power[1] or power[2]).translate(_RAISED)) if power else 1
        found.append((name[0], sign * exponent))
        if len(found) > MOST_FACTORS:
            raise UnitError(f"found more than {MOST_FACTORS} units in a row")
        place = (power or name).end()
        if place == len(text):
            return found
        between = _SIGN.match(text, place)
        if between is None:
            raise UnitError(f"read {text[:place]!r} and stopped at {text[place:].strip()!r}")
        place, sign = between.end(), -1 if between[2] else 1


def read_unit(text: str) -> Unit:
    """The unit that a text such as "kg/m^3" names; raises UnitError."""
    with localcontext(_EXACT):
        names = [("degree" if name == "°" else name, power) for name, power in factors(text)]
        for name, _ in names:
            _refuse_strange(name)
        parsed = registry().parse_units("*".join(f"{name}**({power})" for name, power in names))
        factor, root = registry().get_root_units(parsed)
    return Unit(_exponents(parsed), _exponents(root), Decimal(factor))


def _refuse_strange(name: str) -> None:
    """Raise UnitError unless a name is a known one, with a prefix if it takes one."""
    units = registry()
    metric = units.get_group("metric").members
    readings = units.parse_unit_name(name)
    prefix, base = readings[0][:2] if readings else ("", "")
    symbol = units.get_symbol(base) if base else ""
    # an s behind a symbol is a second left without its sign, as in Pas for Pa*s
    plural = symbol not in {base, *PLURALS} and name.endswith(f"{symbol}s")
    if base and not plural and (base in metric or not prefix):
        return
    hint = " (the mil of workshops is thou)" if name in ("mil", "mils") else ""
    known = {
        f"{prefix}{units.get_symbol(one)}"
        for one in units.get_group("root").members
        for prefix in (PREFIXES if one in metric else [""])
    }
    meant = sorted(one for one in known if one.lower() == name.lower())
    remedy = f" (did you mean {' or '.join(meant)}?)" if meant else ", as in MPa and Hz"
    raise UnitError(
        f"{name!r} is none of the units that are known here{hint}; capitals count{remedy}"
    )


def _exponents(unit: Any) -> dict[str, Any]:
    """Names and exponents of a pint.Unit."""
    return dict((1 * unit).unit_items())


@cache
def si_unit(text: str) -> Unit:
    """A unit of the SI, by such a text as "kg/m^3"; the empty one is that of pure numbers."""
    return read_unit(text) if text else Unit({}, {}, Decimal(1))


def full_turn() -> Decimal:
    """2 pi, with pint's digits of it."""
    return read_unit("turn").factor


def exact(number: Decimal, ratio: Decimal, over: Decimal = Decimal(1)) -> float:
    """number * ratio / over as a float, rounded once."""
    with localcontext(_EXACT):
        return float(number * ratio / over)


def split_number(text: str) -> tuple[str, str]:
    """The number at the start of a text, as digits that float takes, and what follows it."""
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
    """Message with the position where reading stopped, and a hint at the likely meaning."""
    hint = ", since decimals follow a point and nothing parts thousands" if "," in rest else ""
    fraction = _FRACTION.fullmatch(rest)
    if fraction:
        value = exact(Decimal(read_so_far), Decimal(1), Decimal(fraction[1]))
        hint = f" (did you mean {f'{value!r} {fraction[2]}'.strip()!r}?)"
    return f"read {read_so_far} and stopped at {rest!r}{hint or _of_other_digits(rest)}"


def _of_other_digits(text: str) -> str:
    """A hint if a text begins with a digit of another script than Latin."""
    return ", since numbers have the digits 0 to 9" if re.match(r"(?![0-9])\d", text) else ""
