"""Odd inputs: calls with a part of their error message."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import xarray as xr
from bad_input_tables.odd_quantities import Q

# Function, changes of a valid call, part of the error message.

SPAN, HUGE, HIDDEN = np.timedelta64(16), 10**5000, np.ma.array(0.5, mask=True)
NO_NUMBERS = [None, [0.5], "0.5", True, 0.5j, Decimal("0.5"), np.array([0.5]), HIDDEN, SPAN, HUGE]
NO_NUMBERS += [xr.DataArray([0.5, 0.6]), xr.DataArray(0.5, attrs={"units": "mm"}), np.array(True)]
NAMES = [None, ["a"], b"a", HUGE, np.array(["a"]), pd.Series(["hertz", "a"])]

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
    ("solve", {"motion": "elliptic:lateral=0,forward=0"}, "'elliptic:lateral=0,forward=0'"),
    ("solve", {"motion": "transverse:amplitude=1"}, "unknown number amplitude"),
    ("solve", {"pressure": "powr:exponent=2"}, "pressure = 'powr:exponent=2': did you mean power?"),
    ("solve", {"pressure": "power:exponent=1e300"}, "pressure = 'power:exponent=1e300'"),
    ("solve", {"pressure": "file:"}, "as in file:measured.csv"),
    ("solve", {"pressure": "file:nothing.csv"}, "No such file"),
    ("solve", {"pressure": "file:."}, "a folder"),
    ("history", {"travel": None}, "travel = None: allowed is a number"),
    ("history", {"travel": 1e300}, "travel = 1e+300: allowed is"),
    (
        "history",
        {"motion": "continuous-bore", "amplitude": None, "velocity": 1e-320},
        "velocity = ",
    ),
    ("history", {"periods": None}, "periods = None: allowed is a whole number"),
    ("history", {"periods": 10**9}, "periods = 1000000000: allowed is"),
    ("history", {"steps": 10**12}, "steps = 1000000000000: allowed is"),
    ("history", {"cells": SPAN}, "cells = "),
    *(
        (function, {"pressure": pd.Series(["hertz", "punch"])}, "pressure = ")
        for function in ("history", "period", "propulsion", "shakedown")
    ),
    ("propulsion", {"progress": 5}, "progress = 5: allowed is a function"),
    ("history", {"cells": 10**7}, "cells = 10000000: allowed is"),
    ("history", {"start": np.array(["full-slip", "a"])}, "start = "),
    ("period", {"cells": 10**12}, "cells = 1000000000000: allowed is"),
    ("period", {"angles": 10**12}, "angles = 1000000000000: allowed is"),
    ("period", {"cells": 1000, "angles": 1000, "steps": 1000}, "cells x angles x steps"),
    ("period", {"motion": "continuous-bore", "amplitude": None}, "one that oscillates"),
    ("traction_field", {"cells": 0}, "cells = 0: allowed is a whole number of at least 2"),
    ("traction_field", {"velocity": 0}, "velocity = 0.0"),
    ("traction_field", {"motion": "transverse", "amplitude": 1.0}, "motion = 'transverse'"),
    ("open_map", {"name": "transvers"}, "name = 'transvers': did you mean transverse? allowed"),
    ("to_xarray", {"record": 5}, "record = 5: allowed is one of Result,"),
    ("Material", {"young": HUGE}, "young = "),
]

# Bad arguments of Friction.at, many of which NumPy would convert to numbers.

TIMES = np.array(["2020-01-01"], "datetime64[ns]")
VELOCITIES = ["1_0", True, HIDDEN, None, HUGE, [True, False], np.array([0.1 + 1j]), TIMES]
VELOCITIES += [np.ma.array([0.1, 0.3], mask=[True, False]), Q(1, "mm/s"), [0.1, np.nan], -0.1]
VELOCITIES += [[[0.1, 0.3]], [0.1, None], xr.DataArray(["0.1"], dims="t")]
VELOCITIES += [xr.DataArray([-0.1], dims="t")]

AT = [({"velocity": value}, "velocity = ") for value in VELOCITIES]
AT += [({"amplitude": value}, "amplitude = ") for value in (None, "0.5", HIDDEN, -1)]
AT += [({"poisson": value}, "poisson = ") for value in ("0", True, HUGE, 0.5)]
AT += [({"tolerance": value}, "tolerance = ") for value in ("1e-2", True, [0.5], 0, np.nan, HUGE)]
NUMBERS = [Decimal("0.3"), Fraction(3, 10), np.float32(0.3), [Decimal("0.3")], pd.Series([0.3])]
