"""How an error is printed behind +-: nobody may read less than what is claimed."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, Context, Decimal

DIGITS = 2
"""Rounded up to one digit, an error could appear to be twice as large as it is."""
_ROUNDED_UP = Context(prec=DIGITS, rounding=ROUND_CEILING)


def error_text(error: float) -> str:
    """An error with two digits, rounded up; infinity, NaN and 0 as they are.

    What is rounded are the shortest decimals that mean this float: 0.01 stays 0.01, although the
    float of that name lies a little above it.
    """
    error = float(error)
    if math.isfinite(error):
        error = float(_ROUNDED_UP.create_decimal(Decimal(repr(error))))
    return f"{error:.{DIGITS}g}"
