"""Unusual configurations, files of pressures and datasets.

A row has an input and its result: a value, or words of the error message.
"""

import numpy as np
import xarray as xr
from stubs.eq6_map import map_of

from microslip.theory import paper


def refused(*words):
    return {"words": words}


# Configurations: a line for %s in SWEEP, and the resulting `velocity`.

SWEEP = "sweeps:\n  bore:\n    motion: bore\n    amplitude: [1]\n    velocity: %s\n"
VELOCITIES = [
    ("[0.1, 010]", (0.1, 10.0)),
    ("[0.1, 1e-3, 2E+1]", (0.001, 0.1, 20.0)),
    ("[0.1, 1:30]", refused('velocity[1]: "1:30" is text', "allowed: a number")),
    ("[0.1, 1.0e-400]", refused("1.0e-400", "nearer 0")),
    ("[0.1, 0o10]", refused('velocity[1]: "0o10" is text', "allowed: a number")),
    ("[0.1, +.5]", (0.1, 0.5)),
    ("[0.1, '1,5']", refused('"1,5" is text', "allowed: a number")),
    ("[0.1, yes]", refused("true is not allowed")),
    ("[0.1, 1.0e400]", refused("inf is not allowed", "a finite number")),
    ("[0,1, 0,5]", (0.0, 1.0, 5.0)),
    ("!!set {0.1, 1}", refused("is not allowed", "allowed: a number")),
    ("!!binary aGVsbG8=", refused("is not allowed", "allowed: a number")),
    ("{0: 0.1, 1: 1}", refused("velocity:", "{log: [first, last, count]}")),
    ("{log: {start: 1}}", refused("velocity.log", "[first, last, count]")),
    ("[0.1, 0x10]", refused('"0x10" is text')),
    ("[0.1, 1_000]", refused('"1_000" is text')),
    ("[0, 0.0e-400]", (0.0,)),
    ("[1.0e-300, 1]", (1e-300, 1.0)),
]

# Other keys, as YAML at the top level, and words of the message; None: valid.
FIGURE = "figures: {look: {kind: map, sweep: bore, %s}}"
KEYS = [
    ("results: ~/here", ("~/here", "~ in front")),
    ("results: '~'", ('"~"', "~ in front")),
    ("results: s3://bucket/x", ("s3://bucket/x", "://")),
    ('results: "\\ud800"', ("results", "\\ud800", "text for a folder")),
    ('results: "a\\u2028b"', ("results", "text for a folder")),
    ("results: \u00e4 b%25 #c", None),
    ("points_per_job: 010", None),
    ("points_per_job: 10.0", None),
    ("figures: {1: {}, 1: {}}", ("the key 1 occurs twice", "line 6")),
    (f"figures: {{{'x' * 250}: {{}}}}", ("figures", "a name of small letters")),
    ("figures: {x: {kind: map, sweep: {bore: 1}}}", ("figures.x.sweep", "a list of names")),
    (FIGURE % "title: x", ("figures.look.title: unknown key", "kind, sweep")),
]

# Files of pressures: text, and the load shares of the four quarters, or words of the message.  The
# rules of the reader of CSV are in tests/foundation/test_csv_table.py.

HEAD = "forward,lateral,pressure\n"
ROWS = "0,0,1\n0,1,2\n1,0,3\n1,1,4\n"
SEMI = HEAD.replace(",", ";")
PLAIN = [[0.1, 0.2], [0.3, 0.4]]
CSV = [
    (SEMI + "0;0;0\n0;1;2.000\n1;0;3.000\n1;1;5.000\n", [[0.0, 0.2], [0.3, 0.5]]),
    (HEAD + "0,0,1\n0,1,2\n1,0,3.000\n1,1,4\n", PLAIN),
    (",forward,lateral,pressure\n0,0,0,1\n", refused("line 1: the heading")),
    ("x,y,pressure\n" + ROWS, refused("line 1: the heading is 'x,y,pressure'")),
    ("forward [deg],lateral [deg],pressure\n" + ROWS, refused("[deg] is no known unit")),
    ("forward [mm],lateral [mm],pressure [degC]\n" + ROWS, refused("no known unit")),
    ("forward [mm],lateral [in],pressure [psi]\n0,0,1\n0,1,2\n25.4,0,3\n25.4,1,4\n", PLAIN),
    ("forward [\u00b5m],lateral [\u03bcm],pressure\n" + ROWS, PLAIN),
    ((HEAD + ROWS).replace(",", "|"), refused("line 1: the heading")),
    (HEAD + "0,0,1\n0,1e-310,2\n1e-310,0,3\n1e-310,1e-310,4\n", PLAIN),
    (HEAD + "0,0,1\n0,1e20,2\n1,0,3\n1,1e20,4\n", refused("steps in one unit")),
    (HEAD + "1e9,0,1\n1e9,1,2\n1000000001,0,3\n1000000001,1,4\n", PLAIN),
]

AXIS, VALUES = [0.0, 1.0], np.array([[1.0, 2.0], [3.0, 4.0]])


def grid(values=VALUES, **attributes):
    """A grid with attributes for its variables."""
    data = xr.Dataset(
        {"pressure": (("forward", "lateral"), values)}, {"forward": AXIS, "lateral": AXIS}
    )
    for name, given in attributes.items():
        data[name].attrs.update(given)
    return data


MM, UM = {"units": "mm"}, {"units": "um"}
NETCDF = [
    (grid(forward=MM, lateral=UM), "stretched"),
    (grid(forward={"unit": "mm"}, lateral={"UNIT": "um"}), "stretched"),
    (grid(forward={"units": 5}, lateral={"units": 5}), refused("forward has the units 5")),
    (grid(forward={"units": ["mm", "um"]}, lateral=MM), refused("forward has the units")),
    (grid(forward=MM | {"Unit": "um"}, lateral=MM), refused("one attribute units")),
    (grid(forward={"units": "degrees_north"}, lateral=MM), refused("no known unit")),
    (grid().isel(forward=[]), refused("no points")),
    (grid().isel(forward=[0]), refused("not evenly spaced")),
    (grid().rename(forward="lat", lateral="lon"), refused("no variable forward")),
    (grid().rename(pressure="Pressure"), refused("no variable pressure")),
    (grid(VALUES > 1), refused("pressure holds bool")),
    (grid(np.where(VALUES < 4, VALUES, np.inf)), refused("pressure = inf: at forward 1")),
    (grid(pressure={"missing_value": 4.0}), refused("pressure = nan: at forward 1, lateral 1")),
]

# Datasets of other origin: a change, and words of the message of `at`.

VELOCITY, AMPLITUDE = np.geomspace(1e-3, 10, 13), np.linspace(0, 3, 13)
DIMS = ("amplitude", "velocity")


def whole(**attributes):
    """A map of Eq 6 that contains (0.15, 1.3)."""
    mu = paper.large_amplitude_transverse(*np.meshgrid(VELOCITY, AMPLITUDE))
    return map_of(mu, VELOCITY, AMPLITUDE, 1e-4, tolerance=1e-3, **attributes)


def every(name, value):
    return lambda data: data.assign({name: (DIMS, np.full((13, 13), value))})


def axis(name, values):
    return lambda data: data.assign_coords({name: values})


DATASETS = {
    "in percent": (lambda d: d.assign(mu_macro=100 * d.mu_macro), "mu_macro = 100.0"),
    "of text": (every("mu_macro", "a"), "mu_macro = 'of type <U1'"),
    "with errors below 0": (every("mu_macro_error", -1e-4), "mu_macro_error = -0.0001"),
    "velocity as text": (axis("velocity", [str(v) for v in VELOCITY]), "velocity = 'of type"),
    "logarithms of velocity": (axis("velocity", np.log10(VELOCITY)), "velocity = -3.0"),
    "two that contradict each other": (
        lambda d: xr.concat([d, d.assign(mu_macro=0.5 * d.mu_macro)], "velocity"),
        "is there twice",
    ),
}

# Arguments of open_map: name, further arguments, words.
OPENED = [
    (None, {}, "name = None"),
    ("", {}, "name = ''"),
    ("s3://b/x.nc", {}, "is not there"),
    ("x" * 300 + ".nc", {}, "File name too long"),
    ("transverse", {"results": None}, "results = None"),
    ("transverse", {"results": "x" * 300}, "File name too long"),
    ("transverse", {"results": "~"}, "'~'"),
]
# Damage to the bytes of a dataset without a stamp.
DAMAGES = {
    "cut off": lambda content: content[: len(content) // 2],
    "half of it zeros": lambda content: content[: len(content) // 2].ljust(len(content), b"\0"),
}
