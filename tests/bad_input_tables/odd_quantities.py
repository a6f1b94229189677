"""Odd quantities, with their SI values or a part of the error message.

Rows are (value, unit, expected).  A number is the value in the SI unit, computed by hand; a text is
part of the error message.
"""

import datetime
from fractions import Fraction
from math import pi

import numpy as np
import pint

Q = pint.UnitRegistry().Quantity
"""Quantities of one registry for all tests; loading a registry is slow."""


class Uncertain:
    """An object that resembles a number with an uncertainty."""

    def __repr__(self):
        return "5.0+/-0.1"


INCH, POUND, GRAVITY = 0.0254, 0.45359237, 9.80665  # by definition

LENGTHS = [
    ("1e\u22126 m", 1e-6),  # Unicode minus
    ("\u22126 mm", -6e-3),
    ("\uff15 mm", "since numbers have the digits 0 to 9"),  # full-width five
    ("1 \u00b5m", 1e-6),  # micro sign
    ("0", 0.0),  # the same in all units
    ("1/4 inch", "did you mean '0.25 inch'?"),
    (Fraction(1, 8), 0.125),
    ("1,5 mm", "decimals follow a point"),
    ("1 \u00b1 0.1 um", "1 is a number without a unit (did you mean '1 um +- 0.1 um'?)"),
    ("5 mm*rad", "the unit is mm*rad"),
    ("5 N", "units of m"),
    ("5", "a number without a unit"),
    ("nan m", "not finite"),
    ("1e400 m", "beyond the range"),
    ("1e-400 m", "below the range"),
    ("5 mil", "thou"),
    (None, "NoneType"),
    (np.array([1.0, 2.0]), "an array of shape (2,)"),
    (Q(5, "degC"), "stopped at 'C'"),
    (Q(Uncertain(), "mm"), "Uncertain"),
]
RATES = [  # text, value in Hz; the value in rad/s is 2 pi times larger
    ("10 Hz", 10.0),
    (Q(10, "cps"), 10.0),
    ("62.83185307179586 rad\u00b7s\u207b\u00b9", 10.0),
    (Q(20 * pi, "rad/s"), 10.0),
    (Q(1, "1/s"), "may mean Hz or rad/s"),
    ("1 s^-1", "may mean Hz or rad/s"),
    ("1 1/s", "stopped at '1/s'"),
    ("10 Hz*rad", "leaves open whether 2 pi"),
    ("10 hz", "capitals count (did you mean Hz?)"),
]
OTHERS = [
    ("0.5\u00b0", "rad", 0.5 * pi / 180),
    (Q(0.5, "deg"), "rad", 0.5 * pi / 180),
    ("30 %", "", 0.3),
    (Q(30, "percent"), "", 0.3),
    (Q(3, "N") / Q(0.01, "kN"), "", 0.3),
    ("210 Mpa", "Pa", "capitals count (did you mean MPa or mPa?)"),
    ("500 g", "N", "for its weight write gf or kgf, as in '500 gf'"),
    ("100 rpm", "m/s", "its speed is the rate in rad/s times a radius"),
    ("5 N/(m/s)", "N*s/m", "stopped at '/(m/s)'"),
]
OTHERS += [
    ("1" + "0" * 5000 + "e-5000 m", "m", 1.0),
    ("30e6 psi", "Pa", 30e6 * POUND * GRAVITY / INCH**2),
    ("50\N{NO-BREAK SPACE}%", "", 0.5),
    ("5e m", "m", "'e' is none of the units"),
    ("1 m/m", "m/s", "that of a pure number"),
    ("0e99999999999999999999 m", "m", "exponent is beyond the range"),
    ("5 " + "m*" * 3000 + "m", "m", "more than 12 units"),
    (datetime.timedelta(seconds=5), "Hz", "timedelta"),
]
ROWS = [(value, "m", expected) for value, expected in LENGTHS]
ROWS += [(value, "Hz", expected) for value, expected in RATES]
ROWS += [
    (value, "rad/s", expected if isinstance(expected, str) else 2 * pi * expected)
    for value, expected in RATES
]
ROWS += OTHERS
