"""Conversion of numbers and their error estimates to text, with as many digits as the error
allows."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

ERROR_DIGITS = 2
"""Number of significant digits of an error.  Rounding up to one digit could double the error."""
EXACT_DIGITS = 4
"""Number of significant digits of a number without an error."""
EXACT = 1e-9
"""Relative error below which a number is printed without its error, because all printed digits are
correct."""
ROUNDING = 1e-12
"""Error below which a zero is printed without its error.  It is the rounding error of numbers near
1."""
FIXED = -4, 7
"""Range of decimal exponents in which numbers are printed without an exponent."""
_ROUNDED_UP = Context(prec=ERROR_DIGITS, rounding=ROUND_CEILING)
_WIDE = Context(prec=800)
"""Decimal context with enough digits for calculations with any two floats."""
_WITHOUT_ROUNDING_ERROR = Context(prec=12)
"""Decimal context that rounds to digits without the rounding error of floats."""
SEPARATOR = " +- "


def error_text(error: float) -> str:
    """Format an error with two significant digits, rounded up.  Infinity, NaN and 0 are unchanged.

    The shortest decimal representation of the float is rounded.  So 0.01 stays 0.01, although its
    float is slightly larger.
    """
    error = float(error)
    if math.isfinite(error):
        error = float(_rounded_up(error))
    return f"{error:.{ERROR_DIGITS}g}"


def number_text(
    value: float, error: float = 0.0, unit: str = "", *, digits: int = EXACT_DIGITS
) -> str:
    """Format a number with its error estimate and its unit.

    Parameters
    ----------
    value, error : float
        The number and its error estimate, both in this unit.
    unit : str
        Unit to print after the numbers.
    digits : int
        Number of significant digits of a number whose error is 0, or less than a billionth of the
        number.

    Returns
    -------
    str
        A text such as "0.2263 +- 0.0072 N".  The error is rounded up to two significant digits, and
        the number is rounded to the last decimal of the error.  If the error is too small to be
        printed, trailing zeros of the number are kept.  For a number without an error, trailing
        zeros are removed.  A number that is 0 within its error, or within the rounding error of
        numbers near 1, is printed as 0.  Its printed error is then the error plus the absolute
        value of the number.
    """
    value, error = float(value), float(error)
    text = _text(value, error, digits)
    return f"{text} {unit}".rstrip()


def _text(value: float, error: float, digits: int) -> str:
    if not math.isfinite(value):
        return f"{value:g}"
    if not math.isfinite(error):
        return f"{_plain(value, digits)}{SEPARATOR}{error:g}"
    if error <= EXACT * abs(value):
        return _plain(value, digits, zeros=error > 0.0)
    if abs(value) <= error <= ROUNDING:
        return "0"
    if abs(value) <= max(error, ROUNDING):
        return f"0{SEPARATOR}{_short(_rounded_up(abs(value) + error))}"
    rounded = _rounded_up(error)
    exponent = rounded.adjusted() + 1 - ERROR_DIGITS
    number = Decimal(repr(value)).quantize(Decimal((0, (1,), exponent)), context=_WIDE)
    low, high = FIXED
    if low <= number.adjusted() < high:
        return f"{number:f}{SEPARATOR}{rounded.quantize(number, context=_WIDE):f}"
    power = number.adjusted()
    parts = [part.scaleb(-power, context=_WIDE) for part in (number, rounded)]
    parts[1] = parts[1].quantize(parts[0], context=_WIDE)
    return f"({parts[0]:f}{SEPARATOR}{parts[1]:f})e{power:+03d}"


def _plain(value: float, digits: int, zeros: bool = False) -> str:
    """Format a number with `digits` significant digits.  Only very large and very small numbers
    have an exponent.

    zeros: True to keep trailing zeros.
    """
    if value == 0.0:
        return "0"
    number = Context(prec=digits).create_decimal(Decimal(repr(value)))
    if zeros:
        place = Decimal((0, (1,), number.adjusted() + 1 - digits))
        return _short(number.quantize(place, context=_WIDE))
    return _short(number.normalize())


def _short(number: Decimal) -> str:
    """Format a decimal with all its digits.  Only very large and very small numbers have an
    exponent."""
    low, high = FIXED
    return f"{number:f}" if low <= number.adjusted() < high else f"{float(number):g}"


def _rounded_up(error: float) -> Decimal:
    return _ROUNDED_UP.create_decimal(Decimal(repr(error)))


def interval_text(low: float, high: float, unit: str = "", *, error: float = 0.0) -> str:
    """Format an interval.  Both ends are rounded outwards to two significant digits of the width.

    Parameters
    ----------
    low, high : float
        Ends of the interval, in the unit.
    unit : str
        Unit to print after the numbers.
    error : float
        Error estimate of both ends, in the unit.  It extends the interval on both sides.  An
        interval of positive numbers is not extended below 0.
    """
    low, high = float(low), float(high)
    if not error <= EXACT * abs(high):
        low, high = (max(low - error, 0.0) if low >= 0.0 else low - error), high + error
    size = max((abs(end) for end in (low, high) if math.isfinite(end)), default=0.0)
    width = high - low if math.isfinite(high - low) else size
    digits = ERROR_DIGITS if width > EXACT * size else EXACT_DIGITS
    place = Decimal(repr(width if width > EXACT * size else size)).adjusted() + 1 - digits
    ends = _outwards(low, place, ROUND_FLOOR), _outwards(high, place, ROUND_CEILING)
    if digits == EXACT_DIGITS or size and not 10.0 ** FIXED[0] <= size < 10.0 ** FIXED[1]:
        texts = [end if isinstance(end, str) else _short(end.normalize()) for end in ends]
    else:
        texts = [end if isinstance(end, str) else f"{end:f}" for end in ends]
    return f"{texts[0]} to {texts[1]} {unit}".strip()


def _outwards(end: float, place: int, rounding: str) -> Decimal | str:
    """Round the end of an interval to a multiple of a power of 10.  Infinity and NaN become
    texts."""
    if not math.isfinite(end):
        return f"{end:g}"
    number = _WITHOUT_ROUNDING_ERROR.create_decimal(Decimal(repr(end)))
    return number.quantize(Decimal((0, (1,), place)), rounding=rounding, context=_WIDE) + 0


def aligned(columns: Mapping[str, tuple[Sequence[float], Sequence[float] | None]]) -> list[str]:
    """Lines of a right-aligned table of numbers and their errors.

    columns: values and their errors (None for exact values), by the heading of the column.
    """
    texts = []
    for heading, (values, errors) in columns.items():
        errors = [0.0] * len(values) if errors is None else errors
        cells = [number_text(*pair) for pair in zip(values, errors, strict=True)]
        width = max(map(len, (heading, *cells)))
        texts.append([f"{cell:>{width}}" for cell in (heading, *cells)])
    return ["  ".join(row) for row in zip(*texts, strict=True)]


PREFIXES = (
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("", 1.0),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
)
"""Metric prefixes of printed units, and their sizes."""


def prefixed(value: float, unit: str) -> tuple[str, float]:
    """The unit with the largest metric prefix that leaves the value at least 1, and its size.  For
    0, the unit has no prefix."""
    size = abs(value) or 1.0
    prefix, factor = next((one for one in PREFIXES if size >= one[1]), PREFIXES[-1])
    return f"{prefix}{unit}", factor


def prefixed_text(value: float, unit: str, digits: int = EXACT_DIGITS) -> str:
    """Format an exact quantity with a metric prefix.  value: in the SI unit."""
    name, size = prefixed(value, unit)
    return number_text(value / size, unit=name, digits=digits)
