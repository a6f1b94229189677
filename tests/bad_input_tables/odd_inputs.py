"""What a stranger tries: each with its answer by arithmetic, or words of the line that refuses it.

A number is expected where there is a reason for it besides the code; a text is a part of the one
line of a refusal.
"""

import datetime
import math
from decimal import Decimal
from fractions import Fraction
from math import pi

import numpy as np
import pandas as pd
import xarray as xr
from bad_input_tables.odd_quantities import Q

# Quantities

INCH, POUND, GRAVITY = 0.0254, 0.45359237, 9.80665  # by definition
NONE_OF = "is none of the units"
NUMBER_EXPECTED = "where a number was expected"

QUANTITIES = [
    ("5 inch", "m", 5 * INCH),
    ("2 feet", "m", 24 * INCH),
    ("1 yd", "m", 36 * INCH),
    ("5 metre", "m", 5.0),
    ("5 micrometre", "m", 5e-6),
    ("5 millimeters", "m", 5e-3),
    ("5 \N{MICRO SIGN}", "m", 5e-6),  # the micron of old
    ("1 dm", "m", 0.1),
    ("5 m\N{SUPERSCRIPT THREE}/m^2", "m", 5.0),
    ("1.e-3 m", "m", 1e-3),
    ("5e3m", "m", 5e3),
    ("0e999999 m", "m", 0.0),
    ("1" + "0" * 5000 + "e-5000 m", "m", 1.0),
    ("30e6 psi", "Pa", 30e6 * POUND * GRAVITY / INCH**2),
    ("30000 ksi", "Pa", 30e6 * POUND * GRAVITY / INCH**2),
    ("30e6 lbf/in^2", "Pa", 30e6 * POUND * GRAVITY / INCH**2),
    ("210\N{NO-BREAK SPACE}GPa", "Pa", 210e9),
    ("210000 N/mm\N{SUPERSCRIPT TWO}", "Pa", 210e9),
    ("1 bar", "Pa", 1e5),
    ("2 bars", "Pa", 2e5),
    ("10N", "N", 10.0),
    ("1E3 N", "N", 1e3),
    ("5 newtons", "N", 5.0),
    ("10 lbf", "N", 10 * POUND * GRAVITY),
    ("2 kips", "N", 2000 * POUND * GRAVITY),
    ("1 dyn", "N", 1e-5),
    ("10 ft/s", "m/s", 120 * INCH),
    ("10 fps", "m/s", 120 * INCH),
    ("10 in/s", "m/s", 10 * INCH),
    ("10 mph", "m/s", 10 * 63360 * INCH / 3600),
    ("36 kph", "m/s", 10.0),
    ("10 mm/sec", "m/s", 0.01),
    ("1 um/us", "m/s", 1.0),
    ("1 kcps", "Hz", 1000.0),
    ("1 krpm", "Hz", 1000 / 60),
    ("360 degrees/second", "Hz", 1.0),
    ("60 cycles/min", "Hz", 1.0),
    ("216000 deg/min", "rad/s", 20 * pi),
    ("1 gon", "rad", pi / 200),
    ("1 cycle", "rad", 2 * pi),
    ("490 lb/ft^3", "kg/m^3", 490 * POUND / (12 * INCH) ** 3),
    ("490 lbs/ft^3", "kg/m^3", 490 * POUND / (12 * INCH) ** 3),
    ("7.85 g/cc", "kg/m^3", 7850.0),
    ("7.85 t/m^3", "kg/m^3", 7850.0),
    ("50\N{NO-BREAK SPACE}%", "", 0.5),
    ("0.30%", "", 0.003),
    ("10 Hzs", "Hz", NONE_OF),  # Hz*s is a number
    ("5 Pas", "Pa", NONE_OF),  # Pa*s is a viscosity
    ("5 MPas", "Pa", NONE_OF),
    ("5 ins", "m", NONE_OF),
    ("10 Ns", "N", NONE_OF),
    ("5 mms", "m", NONE_OF),
    ("30 Mpsi", "Pa", NONE_OF),
    ("10 kp", "N", NONE_OF),
    ("10 Newton", "N", "capitals count"),
    ("5 \uff4d\uff4d", "m", NONE_OF),  # full-width letters
    ("1 kc/s", "Hz", NONE_OF),
    ("10 c/s", "Hz", NONE_OF),
    ("10 RPM", "Hz", NONE_OF),
    ("10 r/min", "Hz", NONE_OF),
    ("60 bpm", "Hz", NONE_OF),
    ("10 ips", "m/s", NONE_OF),
    ("10 kmh", "m/s", NONE_OF),
    ("0.5 \N{MASCULINE ORDINAL INDICATOR}", "rad", NONE_OF),
    ("5e m", "m", "stopped at 'm'"),
    ("5 e3 m", "m", "stopped at '3 m'"),
    ("1e 3 N", "N", "stopped at '3 N'"),
    ("10^3 N", "N", "read 10 and stopped at '^3 N'"),
    ("2*10^3 N", "N", "read 2 and stopped at '*10^3 N'"),
    ("2\N{MULTIPLICATION SIGN}10^3 N", "N", "read 2 and stopped at"),
    ("1..2 um", "m", "stopped at '.2 um'"),
    ("1-2 um", "m", "stopped at '-2 um'"),
    ("1 um p-p", "m", "read 'um' and stopped at 'p-p'"),
    ("\N{PLUS-MINUS SIGN}1 um", "m", NUMBER_EXPECTED),
    ("< 1 um", "m", NUMBER_EXPECTED),
    ("1,000 N", "N", "nothing parts thousands"),
    ("1\N{RIGHT SINGLE QUOTATION MARK}000 N", "N", "read 1 and stopped at"),
    ("5 \N{SQUARE MM}", "m", "read 5 and stopped at"),
    ("30\N{PRIME}", "rad", "read 30 and stopped at"),
    ("0.5 deg.", "rad", "stopped at '.'"),
    ("10 /s", "Hz", "stopped at '/s'"),
    ("10 mm s^-1", "m/s", "stopped at 's^-1'"),
    ("1 s", "Hz", "the unit is second"),
    ("50 us", "Hz", "the unit is microsecond"),
    ("10 lb", "N", "the unit is pound"),
    ("5 mm/s/s", "m/s", "the unit is"),
    ("1 m/m", "m/s", "that of a pure number"),
    ("5 \N{PER MILLE SIGN}", "", "read 5 and stopped at"),
    ("50 per cent", "", "stopped at 'per cent'"),
    ("1/3", "", "read 1 and stopped at '/3'"),
    ("50\N{FULLWIDTH PERCENT SIGN}", "", "read 50 and stopped at"),
    ("0e99999999999999999999 m", "m", "exponent is beyond the range"),
    ("1e-99999999999999999999 m", "m", "exponent is beyond the range"),
    ("5 " + "m*" * 3000 + "m", "m", "more than 12 units"),
    ("5 " + "m*m/m/" * 3000 + "m", "m", "more than 12 units"),
    (10**5000, "m", "not finite"),
    (datetime.timedelta(seconds=5), "Hz", "timedelta"),
    (np.ma.masked, "m", "MaskedConstant"),
    (pd.NA, "m", "NAType"),
]

# Contacts in SI units: what is changed in a good command line, and the line of the refusal.

PREDICTIONS = [
    ({"speed": "-1 mm/s"}, "--speed = '-1 mm/s': allowed is a finite value at least 0 m/s"),
    ({"load": "0 N"}, "--load = '0 N': allowed is a finite value above 0 N"),
    ({"load": "1e300 N"}, "--radius = '5 mm': by Hertz's theory"),
    ({"load": "1e-300 N"}, "--amplitude = '1 um'"),
    ({"load": "10 kg"}, "--load = '10 kg': the unit is kilogram"),
    (
        {"pressure": "power:exponent=1"},
        "--radius = '5 mm': allowed is none beside a pressure, which needs --contact-radius",
    ),
    ({"radius": "0 m"}, "--radius = '0 m': allowed is a finite value above 0 m"),
    ({"radius": "1e-12 m"}, "--radius = '1e-12 m': by Hertz's theory"),
    ({"radius": "196.85 mil"}, "the mil of workshops is thou"),
    ({"mu": "0"}, "--mu = '0': allowed is a finite value above 0 and at most 10"),
    ({"mu": "1100 %"}, "--mu = '1100 %': allowed is a finite value above 0 and at most 10"),
    ({"mu": "0.3 N"}, "--mu = '0.3 N': read 0.3 and stopped at 'N'"),
    ({"frequency": "0 Hz"}, "--frequency = '0 Hz': allowed is a finite value above 0 Hz"),
    ({"frequency": "50 us"}, "--frequency = '50 us': the unit is microsecond"),
    ({"amplitude": "1 deg"}, "--amplitude = '1 deg': the unit is degree"),
    ({"amplitude": "1 m"}, "allowed is at most 1e+06 times"),
    ({"amplitude": "-1 um"}, "--amplitude = '-1 um': allowed is a finite value at least 0 m"),
    ({"amplitude": None}, "--amplitude: transverse needs it"),
    ({"rotation": "10 rpm"}, "--rotation = '10 rpm': transverse has none"),
    ({"reduction": "50 %"}, "--reduction = '50 %': allowed without an amplitude"),
    ({"amplitude": None, "reduction": "150 %"}, "--reduction = '150 %'"),
    ({"amplitude": None, "reduction": "-10 %"}, "--reduction = '-10 %'"),
    ({"material": "Steel"}, "--material = 'Steel': allowed is one of steel"),
    ({"material": "210 GPa, 0.3"}, "--material = '210 GPa, 0.3': allowed is one of steel"),
    ({"material": "rigid"}, "allowed is an elastic body where the counterbody is rigid"),
    ({"material": None, "young": "210", "nu": "0.3"}, "--young = '210': 210 is a number without"),
    ({"material": None, "young": "210 GPa"}, "--nu: needed"),
    ({"nu": "30 %"}, "--material = 'steel': allowed without young and nu"),
    ({"counterbody": "70 GPa; 0.22"}, "--counterbody = '70 GPa; 0.22'"),
    ({"counterbody": "0.22, 70 GPa"}, "its Young's modulus '0.22'"),
    ({"counterbody": "70 GPa, 0,22"}, "2 commas in it"),
    ({"counterbody": "inf GPa, 0.3"}, "it is not finite"),
    ({"counter_radius": "-4 mm"}, "allowed is a hollow wider than the sphere"),
    ({"counter_radius": "flat"}, "--counter-radius = 'flat'"),
    ({"hardness": "60 HRB"}, "the scale HRB is not known; allowed are Vickers"),
    ({"density": "7.85"}, "--density = '7.85': 7.85 is a number without a unit"),
    ({"tolerance": "1e-3 N"}, "--tolerance = '1e-3 N'"),
    ({"tolerance": "none"}, "--tolerance = 'none'"),
    ({"speed": None}, "--speed: needed, or a force in its place"),
    ({"force": "1 N"}, "--force = '1 N': allowed is a force or a speed, not both"),
    ({"speed": None, "force": "-1 N"}, "--force = '-1 N': allowed is a finite value above 0 N"),
    ({"speed": None, "force": "0 N"}, "--force = '0 N': allowed is a finite value above 0 N"),
    ({"speed": None, "force": "1"}, "--force = '1': 1 is a number without a unit"),
    ({"speed": None, "force": "1 kg"}, "--force = '1 kg': the unit is kilogram"),
    ({"speed": None, "force": "0,5 N"}, "--force = '0,5 N': read 0 and stopped at ',5 N'"),
    (
        {"speed": None, "force": "1 N", "drive_stiffness": "1 N/um"},
        "--drive-stiffness = '1 N/um': allowed is none beside a force",
    ),
    (
        {"speed": None, "force": "1 N", "damping": "1 N*s/m"},
        "--damping = '1 N*s/m': allowed is none beside a force",
    ),
    (
        {"speed": None, "force": "1 N", "amplitude": None, "reduction": "50 %"},
        "--reduction = '50 %': allowed where a speed alone pulls",
    ),
    (
        {"drive_stiffness": "1 N/um", "amplitude": None, "reduction": "50 %"},
        "--reduction = '50 %': allowed where a speed alone pulls",
    ),
    ({"mass": "20 g"}, "--mass = '20 g': allowed beside a force or --drive-stiffness"),
    ({"damping": "1 N*s/m"}, "--damping = '1 N*s/m': allowed beside --drive-stiffness"),
    (
        {"drive_stiffness": "0 N/um"},
        "--drive-stiffness = '0 N/um': allowed is a finite value above",
    ),
    ({"drive_stiffness": "-1 N/um"}, "--drive-stiffness = '-1 N/um': allowed is a finite value"),
    ({"drive_stiffness": "10 N"}, "--drive-stiffness = '10 N': the unit is newton"),
    ({"drive_stiffness": "1 N/um", "mass": "-20 g"}, "--mass = '-20 g': allowed is a finite value"),
    ({"drive_stiffness": "1 N/um", "mass": "20 N"}, "--mass = '20 N': the unit is newton"),
    (
        {"drive_stiffness": "1 N/um", "damping": "5"},
        "--damping = '5': 5 is a number without a unit",
    ),
    (
        {"drive_stiffness": "1 N/um", "mass": "1e308 kg"},
        "--mass = '1e308 kg': over that of the contact, it is beyond the range",
    ),
    (
        {"motion": "longitudinal", "speed": "0 m/s", "drive_stiffness": "1 N/um"},
        "--speed = '0 m/s': allowed is a speed above 0 where a spring pulls",
    ),
    (
        {
            **{"motion": "continuous-bore", "amplitude": None, "frequency": None},
            **{"rotation": "1 Hz", "drive_stiffness": "1 N/um"},
        },
        "--drive-stiffness = '1 N/um': allowed is none for continuous-bore, which is steady",
    ),
    (
        {"motion": "Transverse"},
        "MOTION = 'Transverse': did you mean transverse? allowed is one of transverse",
    ),
    ({"motion": "transverse "}, "MOTION = 'transverse '"),
    ({"motion": "normal:forward=0.5"}, "MOTION = 'normal:forward=0.5'"),
]

# The same contact in other words: what is changed, and what it is equal to.

SAME = [
    ({"frequency": "7200000 deg/s"}, {"frequency": "20 kHz"}),
    ({"frequency": "1200 krpm"}, {"frequency": "20 kHz"}),
    ({"frequency": "20 kcps"}, {"frequency": "20 kHz"}),
    ({"radius": "0.5 in"}, {"radius": "12.7 mm"}),
    ({"radius": "5\nmm"}, {"radius": "5 mm"}),
    ({"mu": "30 %"}, {"mu": "0.3"}),
    ({"load": "1 kgf"}, {"load": "9.80665 N"}),
    ({"speed": "600 mm/min"}, {"speed": "10 mm/s"}),
    ({"material": " steel "}, {"material": "steel"}),
    ({"material": None, "young": "210GPa", "nu": "30 %"}, {"material": "steel"}),
    ({"counterbody": "70 GPa, 22 %"}, {"counterbody": "7e4 N/mm^2, 0.22"}),
    ({"counter_radius": "\N{MINUS SIGN}1 km"}, {"counter_radius": "-1e3 m"}),
    ({"tolerance": "5 %"}, {"tolerance": "0.05"}),
]

# Python: function, arguments that are changed in a good call, what the one line must hold.

SPAN, HUGE, HIDDEN = np.timedelta64(16), 10**5000, np.ma.array(0.5, mask=True)
NO_NUMBERS = [None, [0.5], {"a": 1}, "0.5", b"0.5", True, np.True_, 0.5j, Decimal("0.5")]
NO_NUMBERS += [Fraction(1, 2), np.array([0.5]), np.array(0.5), HIDDEN, SPAN, float, pd.NA]
NO_NUMBERS += [datetime.datetime(2020, 1, 1), pd.Timestamp("2020-01-01"), HUGE]
NAMES = [None, 1, ["a"], b"a", HUGE, np.array(["a"]), SPAN, pd.Series(["hertz", "a"])]

ROW = {"speed": [1e-3], "amplitude": [1e-6], "frequency": [2e4], "load": [10.0], "mu": [0.1]}
"""One measurement, in SI units."""
ONE_ROW = dict.fromkeys(("speed", "frequency", "load"))

CALLS = [("solve", {"velocity": value}, "velocity = ") for value in NO_NUMBERS]
CALLS += [("solve", {"poisson": value}, "poisson = ") for value in NO_NUMBERS]
CALLS += [("solve", {"cells": value}, "cells = ") for value in NO_NUMBERS[1:]]
CALLS += [
    ("solve", {name: value}, f"{name} = ")
    for name in ("motion", "model", "method", "pressure")
    for value in NAMES
]
CALLS += [
    ("solve", {"progress": "loud"}, "progress = 'loud': allowed is a function"),
    ("solve", {"most_work": SPAN}, "most_work = "),
    ("solve", {"time_limit": SPAN}, "time_limit = "),
    ("solve", {"tolerance": list(range(10**5))}, "allowed is a number"),
    ("solve", {"motion": "eliptic:forward=0.5"}, "motion = 'eliptic:forward=0.5': did you mean"),
    ("solve", {"motion": "elliptic:forward=0.5;phase=90"}, "elliptic:key=0.5"),
    ("solve", {"motion": "elliptic:"}, "elliptic:key=0.5"),
    ("solve", {"motion": "elliptic:forward"}, "elliptic:key=0.5"),
    ("solve", {"motion": "elliptic:phase=90\N{DEGREE SIGN}"}, "elliptic:key=0.5"),
    ("solve", {"motion": "elliptic:forward=50%"}, "elliptic:key=0.5"),
    (
        "solve",
        {"motion": "elliptic:lateral=0,forward=0"},
        "motion = 'elliptic:lateral=0,forward=0'",
    ),
    ("solve", {"motion": "tr\N{CYRILLIC SMALL LETTER A}nsverse"}, "did you mean transverse?"),
    ("solve", {"motion": " transverse"}, "did you mean transverse?"),
    ("solve", {"motion": "transverse:amplitude=1"}, "unknown number amplitude"),
    ("solve", {"pressure": "powr:exponent=2"}, "pressure = 'powr:exponent=2': did you mean power?"),
    ("solve", {"pressure": "power:exponent=1e300"}, "pressure = 'power:exponent=1e300'"),
    ("solve", {"pressure": "file:"}, "as in file:measured.csv"),
    ("solve", {"pressure": "file:nothing.csv"}, "No such file"),
    ("solve", {"pressure": "file:."}, "a folder"),
    ("solve", {"pressure": "FILE:x.csv"}, "pressure = 'FILE:x.csv'"),
    ("history", {"travel": None}, "travel = None: allowed is a number"),
    ("history", {"travel": "5"}, "travel = '5': allowed is a number"),
    ("history", {"travel": True}, "travel = True: allowed is a number"),
    ("history", {"travel": np.array([5.0])}, "travel = array([5.]): allowed is a number"),
    ("history", {"travel": 1e300}, "travel = 1e+300: allowed is"),
    (
        "history",
        {"motion": "continuous-bore", "amplitude": None, "velocity": 1e-320},
        "velocity = ",
    ),
    ("history", {"periods": None}, "periods = None: allowed is a whole number"),
    ("history", {"periods": 10**9}, "periods = 1000000000: allowed is"),
    ("history", {"periods": SPAN}, "periods = "),
    ("history", {"steps": 10**12}, "steps = 1000000000000: allowed is"),
    ("history", {"steps": HUGE}, "steps = "),
    ("history", {"cells": SPAN}, "cells = "),
    ("history", {"cells": 1}, "cells = 1: allowed is a whole number of at least 2"),
    *(
        (function, {"pressure": pd.Series(["hertz", "punch"])}, "pressure = ")
        for function in ("history", "period", "propulsion", "shakedown")
    ),
    ("propulsion", {"progress": 5}, "progress = 5: allowed is a function"),
    ("shakedown", {"progress": 5}, "progress = 5: allowed is a function"),
    ("history", {"cells": 10**7}, "cells = 10000000: allowed is"),
    ("history", {"start": ["full-slip"]}, "start = ['full-slip']: allowed is one of"),
    ("history", {"start": np.array(["full-slip", "a"])}, "start = "),
    ("period", {"cells": 10**12}, "cells = 1000000000000: allowed is"),
    ("period", {"angles": 10**12}, "angles = 1000000000000: allowed is"),
    ("period", {"steps": HUGE}, "steps = "),
    ("period", {"cells": 1000, "angles": 1000, "steps": 1000}, "cells x angles x steps"),
    ("period", {"motion": "continuous-bore", "amplitude": None}, "one that oscillates"),
    ("traction_field", {"cells": 0}, "cells = 0: allowed is a whole number of at least 2"),
    ("traction_field", {"cells": "8"}, "cells = '8': allowed is a whole number"),
    ("traction_field", {"cells": 8.0}, "cells = 8.0: allowed is a whole number"),
    ("traction_field", {"cells": True}, "cells = True: allowed is a whole number"),
    ("traction_field", {"cells": 10**12}, "cells = 1000000000000: allowed is"),
    ("traction_field", {"velocity": 0}, "velocity = 0.0"),
    ("traction_field", {"motion": "transverse", "amplitude": 1.0}, "motion = 'transverse'"),
    *(
        (function, {"results": folder}, "is not allowed; allowed: the name of a folder")
        for function in ("solve_stored", "open_map")
        for folder in (None, 5, b"x", "", "~", "~/x", ["a"], True, "a\0b")
    ),
    *(
        ("open_map", {"name": name}, "name = ")
        for name in (None, 5, b"transverse", ["transverse"], "Transverse", " transverse", "")
    ),
    ("open_map", {"name": "transvers"}, "name = 'transvers': did you mean transverse? allowed"),
    ("open_map", {"results": __file__}, "is not a folder; allowed: the name of a folder"),
    ("solve_stored", {"results": 5}, "results = 5: is not allowed"),
    ("to_xarray", {"record": 5}, "record = 5: allowed is one of Result,"),
    (
        "predict_table",
        {"cases": {"load": ["1 N"], "mu": [0.1, 0.2]}},
        "cases = ['load', 'mu']: columns of 1 and 2 values; allowed are columns of one length",
    ),
    ("fit", {**ONE_ROW, "measured": ROW}, "'load', 'mu']: 1 row; two numbers take at least 3"),
    ("fit", {"map": "transverse.nc"}, "map = 'transverse.nc': allowed is the dataset"),
    (
        "fit",
        {**ONE_ROW, "measured": ROW | {"mu": [math.nan]}},
        "mu = None: empty; allowed: a number in every row",
    ),
    ("fit", {"confidence": 95}, "confidence = 95: allowed is a number above 0 and below 1, such"),
    ("Material", {"young": HUGE}, "young = "),
    ("Material", {"young": "210 gpa"}, "capitals count"),
    ("Material", {"poisson": "300 %"}, "poisson = '300 %'"),
]

# Questions to a map: velocities and other arguments that NumPy would make numbers of.

TIMES = np.array(["2020-01-01"], "datetime64[ns]")
VELOCITIES = [*NO_NUMBERS[2:4], "1_0", b"0.5", True, np.True_, np.ma.masked, HIDDEN, None, HUGE]
VELOCITIES += [["0.1", "0.3"], [True, False], np.array([0.1 + 1j]), np.datetime64("2020-01-01")]
VELOCITIES += [np.timedelta64(1), TIMES, np.ma.array([0.1, 0.3], mask=[True, False]), pd.NA]
VELOCITIES += [Q(1, "mm/s"), [0.1, np.nan], np.inf, -0.1, [[0.1, 0.3]], [0.1, None]]
VELOCITIES += [xr.DataArray(value, dims="t") for value in (["0.1"], [True], [0.1j], TIMES, [-0.1])]

AT = [({"velocity": value}, "velocity = ") for value in VELOCITIES]
AT += [({"amplitude": value}, "amplitude = ") for value in (None, "0.5", True, HIDDEN, 0.5j, -1)]
AT += [({"poisson": value}, "poisson = ") for value in ("0", True, [0.0], HIDDEN, HUGE, 0.5)]
AT += [
    ({"tolerance": value}, "tolerance = ")
    for value in ("1e-2", True, [0.5], np.array([0.5, 0.4]), 1j, 0, -1, np.nan, np.inf, HUGE, SPAN)
]
NUMBERS = [Decimal("0.3"), Fraction(3, 10), np.float32(0.3), np.array(0.3), [Decimal("0.3")]]
NUMBERS += [pd.Series([0.3]), np.ma.array([0.3]), xr.DataArray([0.3], dims="t")]
