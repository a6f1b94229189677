"""Odd quantities: what each is in its SI unit, by arithmetic, or which words refuse it.

Rows (value, unit, expected): a number is the value in that unit, a text is what the one line of the
refusal must hold.
"""

from decimal import Decimal
from fractions import Fraction
from math import pi

import numpy as np
import pint

Q = pint.UnitRegistry().Quantity
"""Of one registry for all tests, since to load one takes a while."""


class Uncertain:
    """What stands for a number with an uncertainty."""

    def __repr__(self):
        return "5.0+/-0.1"


class Tagged(np.ndarray):
    """An array of another library that keeps its unit to itself."""


LENGTHS = [
    ("5 mm", 5e-3),
    ("5mm", 5e-3),
    ("+5 mm", 5e-3),
    ("  5 mm\t", 5e-3),
    ("5\nmm", 5e-3),
    ("5\u00a0mm", 5e-3),  # no-break space
    ("5\u2009mm", 5e-3),  # thin space
    ("5\u202fmm", 5e-3),  # narrow no-break space
    (".5 mm", 5e-4),
    ("5. mm", 5e-3),
    ("1e-6m", 1e-6),
    ("1E-6 m", 1e-6),
    ("1e\u22126 m", 1e-6),  # Unicode minus
    ("\u22126 mm", -6e-3),
    ("-6 mm", -6e-3),
    ("\uff15 mm", 5e-3),  # full-width five, which float takes
    ("1 \u00b5m", 1e-6),  # micro sign
    ("1 \u03bcm", 1e-6),  # Greek mu
    ("1 um", 1e-6),
    ("1 micron", 1e-6),
    ("5 mm^1", 5e-3),
    ("5 mm**1", 5e-3),
    ("5 mm\u00b2/mm", 5e-3),
    ("2 in", 0.0508),
    ("1 thou", 25.4e-6),
    ("3 \u00c5", 3e-10),
    ("0 mm", 0.0),
    (0.005, 5e-3),
    (Decimal("0.005"), 5e-3),
    (Fraction(1, 8), 0.125),
    (np.float32(0.5), 0.5),
    (np.int64(2), 2.0),
    (np.array(0.5), 0.5),
    (Q(5, "mm"), 5e-3),
    (Q(np.array(5.0), "mm"), 5e-3),
    (Q(Decimal(5), "mm"), 5e-3),
    ("0,5 um", "read 0 and stopped at ',5 um'"),
    ("1,5 mm", "decimals follow a point"),
    ("1.000,5 mm", "stopped at ',5 mm'"),
    ("1 000 mm", "read 1 and stopped at '000 mm'"),
    ("1\u2009000 mm", "read 1 and stopped at '000 mm'"),
    ("1'000 mm", "stopped at"),
    ("1_000 mm", "stopped at '_000 mm'"),
    ("0x10 mm", "stopped at '10 mm'"),
    ("5\uff0c5 mm", "stopped at"),  # full-width comma
    ("1 \u00b1 0.1 um", "stopped at '\u00b1 0.1 um'"),
    ("1(1) um", "stopped at '(1) um'"),
    ("1 2 um", "stopped at '2 um'"),
    ("10 3 um", "stopped at '3 um'"),
    ("1 - 2 um", "stopped at '- 2 um'"),
    ("\u22481 um", "where a number was expected"),
    ("~1 um", "where a number was expected"),
    ("$1 um", "where a number was expected"),
    ("<5 mm", "where a number was expected"),
    ("--5 mm", "where a number was expected"),
    ("- 5 mm", "where a number was expected"),
    ("\u20136 mm", "where a number was expected"),  # en dash
    ("mm", "where a number was expected"),
    ("five mm", "where a number was expected"),
    ("five", "'five'"),
    ("\u00bd mm", "where a number was expected"),
    ("5\u00b2 mm", "stopped at"),
    ("\ufeff5 mm", "where a number was expected"),  # byte-order mark
    ("5\u200bmm", "stopped at"),  # zero-width space
    ("1/2 mm", "read 1 and stopped at '/2 mm'"),
    ("2*5 mm", "stopped at '*5 mm'"),
    ("5*mm", "stopped at '*mm'"),
    ("5 (mm)", "stopped at '(mm)'"),
    ("5 mm mm", "read 'mm' and stopped at 'mm'"),
    ("1 um extra", "read 'um' and stopped at 'extra'"),
    ("5 mm.", "stopped at '.'"),
    ("5 mm, 6 mm", "stopped at ', 6 mm'"),
    ("5 mm rad", "stopped at 'rad'"),
    ("5 mm*rad", "the unit is millimeter*radian"),
    ("5 mm*percent", "'percent' is none of the units"),
    ("5 mm %", "stopped at '%'"),
    ("5 mm**2", "the unit is millimeter^2"),
    ("5 mm^0", "stopped at '^0'"),
    ("5 mm^1.0", "stopped at '.0'"),
    ("5 mm*", "at the end of 'mm*'"),
    ("3 um/s", "the unit is"),
    ("5 N", "units of m"),
    ("5 MM", "capitals count"),
    ("5 M", "'M' is none of the units"),
    ("10 n", "'n' is none of the units"),
    ("5 Em", "'Em' is none of the units"),
    ("5 mil", "thou"),
    ("5 c*s", "'c' is none of the units"),
    ("5 degC", "'degC' is none of the units"),
    ("5 dB", "'dB' is none of the units"),
    ('5"', "stopped at"),
    ("1e-6", "a number without a unit"),
    ("5", "a number without a unit"),
    ("", "the text is empty"),
    ("\u00a0", "the text is empty"),
    ("nan m", "not finite"),
    ("inf m", "not finite"),
    ("-Infinity mm", "not finite"),
    ("1e400 m", "beyond the range"),
    ("1e-400 m", "below the range"),
    ("1e-320 nm", "below the range"),
    (float("nan"), "not finite"),
    (float("inf"), "not finite"),
    (10**400, "not finite"),
    (None, "NoneType"),
    (b"5 mm", "bytes"),
    ([5], "list"),
    ((5, "mm"), "tuple"),
    (True, "bool"),
    (np.bool_(True), "bool"),
    (1j, "complex"),
    (np.array([1.0, 2.0]), "an array of shape (2,)"),
    (np.array([5e-3]), "an array of shape (1,)"),
    (np.array(5e-3).view(Tagged), "Tagged"),
    (np.timedelta64(5, "s"), "timedelta64"),
    (Q(5, ""), "that of a pure number"),
    (Q(5, "mm*rad"), "the unit is millimeter*radian"),
    (Q(5, "degC"), "an offset or a logarithm"),
    (Q([1.0, 2.0], "mm"), "an array of shape (2,)"),
    (Q(1j, "mm"), "complex"),
    (Q(Uncertain(), "mm"), "Uncertain"),
    (Q(5, "mm").units, "Unit"),
]
RATES = [  # unit, value in Hz; in rad/s it is 2 pi times as much
    ("10 Hz", 10.0),
    ("0.01 kHz", 10.0),
    ("10 cps", 10.0),
    ("10 cycles/s", 10.0),
    ("10 turns/s", 10.0),
    ("10 rps", 10.0),
    ("600 rpm", 10.0),
    ("600 rev/min", 10.0),
    ("0.6 krpm", 10.0),
    ("3600 deg/s", 10.0),
    ("3600 \u00b0/s", 10.0),
    ("62.83185307179586 rad/s", 10.0),
    ("62.83185307179586 rad\u00b7s\u207b\u00b9", 10.0),
    (Q(10, "Hz"), 10.0),
    (Q(0.01, "kHz"), 10.0),
    (Q(10, "cps"), 10.0),
    (Q(600, "rpm"), 10.0),
    (Q(10, "turn/s"), 10.0),
    (Q(20 * pi, "rad/s"), 10.0),
    (Q(3600, "deg/s"), 10.0),
    (Q(1, "1/s"), "may mean Hz or rad/s"),
    (Q(600, "1/min"), "may mean Hz or rad/s"),
    ("1 s^-1", "may mean Hz or rad/s"),
    ("600 min^-1", "may mean Hz or rad/s"),
    ("1 1/s", "stopped at '1/s'"),
    ("10 Hz*rad", "leaves open whether 2 pi"),
    ("10 deg*Hz", "leaves open whether 2 pi"),
    (Q(10, "Hz*rad"), "leaves open whether 2 pi"),
    ("10 hz", "capitals count"),
    ("10 KHz", "capitals count"),
    ("10 Bq", "'Bq' is none of the units"),
    ("10 rads/s", "'rads' is none of the units"),
    ("10 rad", "the unit is radian"),
    ("10 s", "the unit is second"),
    ("10", "a number without a unit"),
]
OTHERS = [
    ("0.5 deg", "rad", 0.5 * pi / 180),
    ("0.5\u00b0", "rad", 0.5 * pi / 180),
    ("30 arcmin", "rad", 0.5 * pi / 180),
    ("0.25 turn", "rad", 0.5 * pi),
    ("3 mrad", "rad", 3e-3),
    (Q(0.5, "deg"), "rad", 0.5 * pi / 180),
    ("0.1", "rad", "a number without a unit"),
    ("1 mm", "rad", "the unit is millimeter"),
    ("5 mil", "rad", "'mil' is none of the units"),
    (Q(0.1, ""), "rad", "that of a pure number"),
    ("0.3", "", 0.3),
    ("30 %", "", 0.3),
    ("30%", "", 0.3),
    ("30 percent", "", 0.3),
    (Q(30, "percent"), "", 0.3),
    (Q(3, "N") / Q(0.01, "kN"), "", 0.3),
    ("0,3", "", "decimals follow a point"),
    ("3e-1 %%", "", "stopped at '%%'"),
    ("0.3 mm/mm", "", "stopped at 'mm/mm'"),
    ("0.3 rad", "", "stopped at 'rad'"),
    ("0.3 dB", "", "stopped at 'dB'"),
    (Q(0.3, "rad"), "", "the unit is radian"),
    (Q(3, "dB"), "", "an offset or a logarithm"),
    ("210 GPa", "Pa", 210e9),
    ("210 kN/mm^2", "Pa", 210e9),
    ("210e3 N/mm\u00b2", "Pa", 210e9),
    ("2.1 Mbar", "Pa", 210e9),
    ("210 mPa", "Pa", 0.21),
    ("210 Mpa", "Pa", "capitals count"),
    ("210 gpa", "Pa", "capitals count"),
    ("210 G Pa", "Pa", "read 'G' and stopped at 'Pa'"),
    ("210 at", "Pa", "'at' is none of the units"),
    ("1.5e3 N", "N", 1500.0),
    ("1 daN", "N", 10.0),
    ("1 kgf", "N", 9.80665),
    ("10 kg*m/s^2", "N", 10.0),
    ("1,5 N", "N", "decimals follow a point"),
    ("1 kg", "N", "the unit is kilogram"),
    ("10 kn", "N", "the unit is knot"),
    ("10 Nm", "N", "'Nm' is none of the units"),
    ("3.6 km/h", "m/s", 1.0),
    ("60 mm/min", "m/s", 1e-3),
    ("1 ft/s", "m/s", 0.3048),
    ("1 mm/s^1", "m/s", 1e-3),
    ("1 mm*Hz", "m/s", "leaves open whether 2 pi"),
    (Q(1, "mm*Hz"), "m/s", "leaves open whether 2 pi"),
    ("1 mm*rad/s", "m/s", "the unit is"),
    ("1 c", "m/s", "'c' is none of the units"),
    ("1 m per s", "m/s", "stopped at 'per s'"),
    ("1 m//s", "m/s", "stopped at '/s'"),
    ("7.85 g/cm^3", "kg/m^3", 7850.0),
    ("7.85 kg/L", "kg/m^3", 7850.0),
    ("7850 kg*m**-3", "kg/m^3", 7850.0),
    ("7850 kg/m3", "kg/m^3", "stopped at '3'"),
    ("7850 kg m^-3", "kg/m^3", "stopped at 'm^-3'"),
]
ROWS = [(value, "m", expected) for value, expected in LENGTHS]
ROWS += [(value, "Hz", expected) for value, expected in RATES]
ROWS += [
    (value, "rad/s", expected if isinstance(expected, str) else 2 * pi * expected)
    for value, expected in RATES
]
ROWS += OTHERS
