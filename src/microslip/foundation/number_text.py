"""Conversion of numbers and error estimates to text, with as many digits as the error allows."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

ERROR_DIGITS = 2
"""Number of significant digits of an error.  Rounding up to one digit could double the error."""
EXACT_DIGITS = 4
"""Number of significant digits of a number without an error."""
EXACT = 1e-9
"""Relative error below which a number is printed without its error, because all printed digits are
correct."""
ROUNDING = 1e-12
"""If a value is 0 and its error is at most this number, the error is not printed.  Results near 1
have rounding errors of this size."""
SIZES = -4, 7
"""Range of decimal exponents in which numbers are printed without an exponent."""
WIDE = Context(prec=800)
"""Decimal context with enough digits for calculations with any two floats."""
SEPARATOR = " +- "
PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}
"""Metric prefixes of printed units, and their sizes."""


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
        A string such as "0.2263 +- 0.0072 N".  The error is rounded up to two significant digits,
        and the number is rounded to the last decimal of the error.  If the error is too small to be
        printed, trailing zeros of the number are kept.  For a number without an error, trailing
        zeros are removed.  A number that is 0 within its error, or within the rounding error of
        numbers near 1, is printed as 0.  Its printed error is then the error plus the absolute
        value of the number.
    """
    return f"{_text(float(value), float(error), digits)} {unit}".rstrip()


def _text(value: float, error: float, digits: int) -> str:
    if not math.isfinite(value):
        return f"{value:g}"
    if not math.isfinite(error):
        return f"{_plain(value, digits)}{SEPARATOR}{error:g}"
    if error <= EXACT * abs(value):
        return _plain(value, digits, zeros=error > 0.0)
    if abs(value) <= max(error, ROUNDING):
        rest = _short(_rounded(abs(value) + error, ERROR_DIGITS, ROUND_CEILING))
        return "0" if error <= ROUNDING and abs(value) <= error else f"0{SEPARATOR}{rest}"
    above = _rounded(error, ERROR_DIGITS, ROUND_CEILING)
    place = Decimal((0, (1,), above.adjusted() + 1 - ERROR_DIGITS))
    number = Decimal(repr(value)).quantize(place, context=WIDE)
    power = number.adjusted()
    if SIZES[0] <= power < SIZES[1]:
        return f"{number:f}{SEPARATOR}{above.quantize(number, context=WIDE):f}"
    number, above = (part.scaleb(-power, context=WIDE) for part in (number, above))
    return f"({number:f}{SEPARATOR}{above.quantize(number, context=WIDE):f})e{power:+03d}"


def _plain(value: float, digits: int, zeros: bool = False) -> str:
    """Format a number with `digits` significant digits.  If `zeros` is true, trailing zeros are
    kept."""
    number = _rounded(value, digits)
    if not zeros or not number:
        return _short(number.normalize())
    return _short(number.quantize(Decimal((0, (1,), number.adjusted() + 1 - digits)), context=WIDE))


def _short(number: Decimal) -> str:
    """Format a decimal with all its digits.  Only very large and very small numbers are written
    with an exponent."""
    is_usual = not number or SIZES[0] <= number.adjusted() < SIZES[1]
    return f"{number or abs(number):f}" if is_usual else f"{float(number):g}"


def _rounded(number: float, digits: int, rounding: str | None = None) -> Decimal:
    """Round a float, starting from its shortest decimal representation.  For example, 0.01 stays
    exactly 0.01."""
    return Context(prec=digits, rounding=rounding).create_decimal(Decimal(repr(number)))


def interval_text(low: float, high: float, unit: str = "", *, error: float = 0.0) -> str:
    """Format an interval.  Both bounds are rounded outwards, to the decimal place of the second
    significant digit of the interval's width.

    Parameters
    ----------
    low, high : float
        Bounds of the interval, in this unit.
    unit : str
        Unit to print after the numbers.
    error : float
        Error estimate of both bounds, in this unit.  It extends the interval on both sides.  An
        interval of positive numbers is not extended below 0.
    """
    low, high = float(low), float(high)
    if not error <= EXACT * abs(high):
        low, high = (max(low - error, 0.0) if low >= 0.0 else low - error), high + error
    size = max((abs(end) for end in (low, high) if math.isfinite(end)), default=0.0)
    width = high - low if math.isfinite(high - low) else size
    is_wide = width > EXACT * size
    digits = ERROR_DIGITS if is_wide else EXACT_DIGITS
    place = Decimal((0, (1,), Decimal(repr(width if is_wide else size)).adjusted() + 1 - digits))
    is_usual = is_wide and (not size or 10.0 ** SIZES[0] <= size < 10.0 ** SIZES[1])
    texts = []
    for end, rounding in ((low, ROUND_FLOOR), (high, ROUND_CEILING)):
        if math.isfinite(end):
            number = _rounded(end, 12).quantize(place, rounding=rounding, context=WIDE) + 0
            texts.append(f"{number:f}" if is_usual else _short(number.normalize()))
        else:
            texts.append(f"{end:g}")
    return f"{' to '.join(texts)} {unit}".strip()


def prefixed(value: float, unit: str) -> tuple[str, float]:
    """Return the unit with a metric prefix, and the factor of this prefix.  The function chooses
    the largest prefix for which the scaled value is at least 1.  If the value is 0, the unit has no
    prefix."""
    size = abs(value) or 1.0
    prefix, factor = next((one for one in PREFIXES.items() if size >= one[1]), ("p", 1e-12))
    return f"{prefix}{unit}", factor


def prefixed_text(value: float, unit: str, digits: int = EXACT_DIGITS) -> str:
    """Format an exact quantity with a metric prefix.  `value` is the value in the SI unit."""
    name, size = prefixed(value, unit)
    return number_text(value / size, unit=name, digits=digits)
