"""Bad configurations, each with parts of its one line after the name of the file.

A line starts with the key. Its parts are the value, the reason, and the allowed values.
"""

import re

import yaml

GOOD = """
sweeps:
  transverse:
    velocity: [0.1, 1]
    amplitude: [0, 1]
  bore:
    velocity: {log: {start: 0.1, stop: 10, count: 3}}
    amplitude: {linear: {start: 0, stop: 1, count: 3}}
  continuous_bore:
    velocity: [1]
"""
T, B, C = "sweeps.transverse", "sweeps.bore", "sweeps.continuous_bore"
MAP = f"{T}.adaptive"
RATIO = ">= 0 and <= 0.5"
TOLERANCES = ">= 1e-06 and <= 0.1"
MODELS = "auto, rigid, slider"

# Key to set in GOOD, its value in YAML (None: no such key), parts. The line starts with the key.
KEYS = [
    ("reslts", "x", "unknown key; did you mean results?", "points_per_job"),
    ("results", "' '", '" " is not allowed', "text for a folder"),
    ("results", "r{x}", '"r{x}"', "without braces, *, ?"),
    ("results", "5", "5 is not allowed", "text for a folder"),
    ("points_per_job", "0", "0 is not allowed", ">= 1"),
    (f"{T}.points_per_job", "0", "0 is not allowed", ">= 1"),
    ("points_per_job", "1.5", "1.5 is not allowed", "a whole number"),
    ("sweeps", None, "missing; required: sweeps"),
    ("sweeps", "{}", "{} is not allowed", "transverse, bore, continuous_bore"),
    ("sweeps", "[bore]", '["bore"] is not allowed', "transverse, bore, continuous_bore"),
    ("sweeps.bores", "{}", "unknown key; did you mean bore?"),
    (C, "~", "null is not allowed", "velocity"),
    (f"{T}.velocities", "[1]", "unknown key; did you mean velocity?"),
    (f"{T}.amplitude", None, "missing; required: velocity, amplitude"),
    (f"{T}.velocity[0]", "-0.1", "-0.1 is not allowed", ">= 0"),
    (f"{T}.velocity[1]", "fast", '"fast" is text', "a number"),
    (f"{T}.velocity[1]", "'0.1'", '"0.1" is text', "without quotes: 0.1"),
    (f"{T}.velocity[1]", "1e-3", '"1e-3" is text', "write 1.0e-3"),
    (f"{T}.velocity[1]", "'inf'", '"inf" is text', "a finite number"),
    (f"{T}.velocity[1]", "true", "true is not allowed", "a number"),
    (f"{T}.velocity[1]", ".nan", "nan is not allowed", "a finite number"),
    (f"{T}.velocity[1]", "1.0e+9", "1000000000.0 is not allowed", "<= 1e+06"),
    (f"{T}.velocity", "all", '"all" is not allowed', "a list of"),
    (f"{T}.velocity", "[]", "[] is not allowed", "a list of"),
    (f"{T}.velocity", "{}", "{} is not allowed", "linear or log"),
    (f"{T}.velocity", "[0.3, 0.30000000000000004]", "0.3 occurs twice", "different values"),
    (f"{T}.velocity", "[0, -0.0]", "0 occurs twice", "different values"),
    (f"{B}.velocity.logs", "{}", "unknown key; did you mean log?"),
    (f"{B}.velocity.log.start", "0", "0 is not allowed", "> 0"),
    (f"{B}.velocity.log.start", "1.0e-320", "1e-320 is not allowed", "nearer 10"),
    (f"{B}.velocity.log.stop", "0.1", "0.1 is not allowed", "a number above 0.1"),
    (f"{B}.velocity.log.count", "1", "1 is not allowed", ">= 2"),
    (f"{B}.velocity.log.count", None, "missing; required: start, stop, count"),
    (f"{C}.poisson", "0.7", "0.7 is not allowed", RATIO),
    (f"{T}.adaptive", "[]", "[] is not allowed", "error, tolerance or null"),
    (f"{T}.adaptive.error", "0", "0 is not allowed", ">= 1e-05 and <= 0.1"),
    (f"{C}.poisson", "[]", "[] is not allowed", "a list"),
    (f"{C}.model", "poler", '"poler" is not allowed; did you mean polar?', MODELS),
    (f"{C}.model", "radial", '"radial" does not apply to continuous-bore', "auto, rigid, polar"),
    (f"{C}.tolerance", "1", "1 is not allowed", TOLERANCES),
    (f"{C}.cells", "7", "7 is not allowed", "an even number >= 4"),
    (f"{C}.cells", "5000", "5000 is not allowed", "<= 1000"),
    (f"{C}.steps", "9", "9 is not allowed", "an even number >= 8"),
    ("histories.bore", "{}", "unknown key; allowed: transverse, field, transients"),
    ("histories.transverse.velocity", "0", "0 is not allowed", "> 0"),
    ("histories.transverse.amplitude", "-1", "-1 is not allowed", ">= 0"),
    ("histories.transverse.periods", "0", "0 is not allowed", ">= 1"),
    ("histories.transverse.cells", "5", "5 is not allowed", "an even number"),
    ("histories.transients.velocity", "0", "0 is not allowed", "> 0"),
]

KEYED, HIGH = "projected-gradient:key=0.5", "projected-gradient:step=high"
POINT = "accuracy.points.a"

STUDIES = [
    (
        "accuracy.methods",
        "projected-gradient",
        '"projected-gradient" is not allowed',
        "a list of text or null",
    ),
    ("accuracy.methods[1]", "full-newtn", "'full-newtn'", "did you mean full-newton?"),
    ("accuracy.methods[1]", "1", "1 is not allowed", "text"),
    (
        "stability.methods",
        "[projected-gradient, projected-gradient]",
        "projected-gradient occurs twice",
        "different values",
    ),
    (
        "stability.methods[1]",
        "'projected-gradient:step=high'",
        "'projected-gradient:step=high'",
        KEYED,
    ),
    ("stability.tolerance", "0.5", "0.5 is not allowed", TOLERANCES),
    ("stability.axes", "[]", "[] is not allowed", "a list"),
    ("stability.axes[0]", "step", '"step" is not allowed; did you mean steps?', "slow-transverse"),
    ("accuracy.levels", "7", "7 is not allowed", "<= 6"),
    ("accuracy.points", "{}", "{} is not allowed", "names"),
    (f"{POINT}.motion", None, "missing; required: motion, velocity"),
    (f"{POINT}.motion", "bores", '"bores" is not allowed; did you mean bore?', "zigzag"),
    (f"{POINT}.velocity", "0", "0 is not allowed", "> 0"),
    (f"{POINT}.amplitude", None, "missing; required for bore"),
    (f"{POINT}.poisson", "[0, 0.3]", "[0, 0.3] is not allowed", "a number >= 0 and <= 0.5"),
    ("accuracy.map.velocity", "[0, 1]", "0 is not allowed", "> 0"),
    ("accuracy.map.velocity", "[1]", "[1.0] is not allowed", "two numbers or more"),
    ("accuracy.map.tolerance", "[]", "[] is not allowed", "a list of numbers"),
    ("accuracy.map.tolerance[1]", "1", "1 is not allowed", TOLERANCES),
    ("claims.velocity", "[0, 1]", "0 is not allowed", "> 0"),
    ("claims.amplitude_bore", "[6, 10]", "[6.0, 10.0] is not allowed", "up to 5"),
    ("claims.amplitude_transverse", "[2]", "[2.0] is not allowed", "up to 1"),
    ("claims.cells", "9", "9 is not allowed", "an even number"),
]

E = "extended.circle"

# Messages of the solver about motions and pressures, and names in use.
EXTENDED = [
    ("extended", "[circle]", '["circle"] is not allowed', "a mapping of names"),
    ("extended", "{Circle: {}}", '"Circle" is not allowed', "small letters, digits and _"),
    (f"{E}.motion", None, "missing; required: velocity, motion, group"),
    (f"{E}.motion", "5", "5 is not allowed", "text"),
    (f"{E}.motion", "eliptic", "'eliptic'", "did you mean elliptic?", "transverse, longitudinal"),
    (f"{E}.pressure", "hertzian", "'hertzian'", "allowed is ", "hertz"),
    (f"{E}.group", "My figure", '"My figure" is not allowed', "small letters, digits and _"),
    (f"{E}.title", "''", '"" is not allowed', "text on one line"),
    (f"{E}.amplitude", None, "missing; required for elliptic"),
]

# Keys that GOOD lacks and that cases above change.
STUDIED = """
accuracy:
  methods: [shipped, projected-gradient]
  points: {a: {motion: bore, velocity: 1, amplitude: 1}}
  map: {tolerance: [0.01, 0.001]}
stability:
  methods: [shipped, projected-gradient]
  axes: [edge]
claims:
  tolerance: 0.01
"""
MOVED = """
extended:
  circle: {motion: elliptic, group: loops, velocity: [0.1, 1], amplitude: [0.5, 1]}
  line: {motion: "elliptic:phase=0", group: loops, velocity: [0.1, 1], amplitude: [0.5, 1]}
"""


def changed(settings):
    """GOOD with settings given as YAML by their keys, such as sweeps.bore.amplitude[0]."""
    mapping = yaml.safe_load(GOOD)
    if any(key.startswith(("accuracy", "stability")) for key in settings):
        mapping |= yaml.safe_load(STUDIED)
    if any(key.startswith("extended") for key in settings):
        mapping |= yaml.safe_load(MOVED)
    for key, text in settings.items():
        *way, last = (int(k) if k.isdigit() else k for k in re.findall(r"[^.\[\]]+", key))
        place = mapping
        for name in way:
            place = place[name] if isinstance(place, list) else place.setdefault(name, {})
        if text is None:
            del place[last]
        else:
            place[last] = yaml.safe_load(text)
    return yaml.safe_dump(mapping, sort_keys=False)


SPACED = "{start: 1, stop: 2, count: %d}"
GRID = f"{{linear: {SPACED}}}"
CLOSE = "{linear: {start: 1, stop: 1.000001, count: 9}}"  # than the six stored digits

# Settings that are valid one by one, the key in the message, parts.
TOGETHER = [
    ({f"{T}.model": "radial", f"{T}.poisson": "[0, 0.2]"}, f"{T}.poisson", "0.2", "allowed: 0"),
    ({f"{B}.velocity.linear": SPACED % 2}, f"{B}.velocity", '{"log": {', "linear or log"),
    ({f"{POINT}.motion": "continuous-bore"}, f"{POINT}.amplitude", "1", "has no amplitude"),
    ({f"{E}.model": "radial", f"{E}.poisson": "0.3"}, f"{E}.model", "'radial'", "nu > 0"),
    ({f"{E}.motion": "bore", f"{E}.model": "slider"}, f"{E}.model", "'slider'", "bore"),
    ({f"{E}.motion": "continuous-bore"}, f"{E}.amplitude", "[0.5, 1.0]", "has no amplitude"),
    ({"extended.line.amplitude": "[1]"}, "extended.line.group", "allowed: another group"),
    ({f"{B}.amplitude": CLOSE}, f"{B}.amplitude", "1 occurs twice", "different values"),
    ({f"{T}.velocity": GRID % 1001, f"{T}.amplitude": GRID % 1000}, T, "at most 1000000"),
    (
        {"accuracy.map.velocity": GRID % 2000},
        "accuracy.map.velocity x amplitude_transverse",
        "at most 10000",
    ),
]

# Certified maps, resolutions in place of a tolerance.
TOGETHER += [
    ({MAP: "{}"}, f"{MAP}.error", "missing; required: error"),
    ({MAP: "{error: 1.0e-3, tolerance: 1.0e-2}"}, f"{MAP}.tolerance", "less than the error"),
    ({MAP: "{error: 0.1, tolerance: 0.02}"}, f"{MAP}.tolerance", "0.02 is not allowed", "<= 0.01"),
    ({MAP: "{error: 1.0e-2}", f"{T}.velocity": "[1]"}, MAP, "allowed: with two amplitudes"),
    ({MAP: "{error: 1.0e-2}", f"{T}.cells": "8"}, MAP, "with cells or steps imposed"),
    ({f"{T}.tolerance": "~"}, f"{T}.tolerance", "null", "cells and steps imposed"),
    ({f"{T}.tolerance": "~", f"{T}.cells": "8"}, f"{T}.tolerance", "or steps imposed"),
    ({f"{C}.tolerance": "~"}, f"{C}.tolerance", "null", "or cells imposed"),
]

# Files that are no configuration: their bytes, parts.
FILES = {
    "empty": (b"", "is empty", "sweeps at least"),
    "a list": (b"- 1\n- 2\n", "[1, 2] is not a mapping", "keys and values"),
    "cut off": (GOOD.partition("stop")[0].encode(), "not valid YAML", "line 7"),
    "not UTF-8": (b"# \xe9t\xe9\n" + GOOD.encode(), "line 1: not text: byte 0xe9", "UTF-8"),
    "not UTF-8 further down": (GOOD.encode() + b"# \xe9t\xe9\n", "line 11: not text: byte 0xe9"),
    "UTF-16": (GOOD.encode("utf-16"), "line 1: not text: byte 0xff", "UTF-16"),
    "UTF-16 without a mark": (
        GOOD[1:].encode("utf-16-le"),
        "line 1: the character '\\x00'",
        "text",
    ),
    "binary": (b"\x89HDF\r\n\x1a\n\x00\x00", "not text: byte 0x89", "UTF-8"),
    "a bell": (GOOD.encode() + b"# \x07\n", "line 11: the character '\\x07' is not allowed"),
    "nothing to merge": (b"sweeps:\n  <<: 5\n", "not valid YAML", "line 2", "merging"),
    "a key twice, by an alias": (b"a: &k x\n*k : 1\n*k : 2\n", "the key x occurs twice", "line 1"),
    "a tag that does not fit": (b"results: !!bool maybe\n", "not valid YAML", "bool", "line 1"),
    "a number of 5000 digits": (b"results: " + b"9" * 5000 + b"\n", "int", "line 1"),
    "a colon too many": (b"results: a: b\n", "not valid YAML", "line 1"),
    "tabs": (GOOD.replace("    ", "\t").encode(), "not valid YAML", "line 4", "no tabs"),
    "a key twice": (
        GOOD.replace("  bore:", "  transverse: {}\n  bore:").encode(),
        "the key transverse occurs twice",
        "line 6",
    ),
    "two documents": (
        GOOD.encode() + b"---\n" + GOOD.encode(),
        "not valid YAML",
        "another document",
    ),
    "a month too many": (b"results: 2026-13-01\n", "not valid YAML", "month", "line 1"),
    "a tag": (b"results: !!python/object/apply:os.getcwd []\n", "not valid YAML", "line 1"),
    "an unknown alias": (b"sweeps: *others\n", "not valid YAML", "others"),
    "itself inside": (b"sweeps: &s {transverse: *s}\n", "contains itself"),
    "very deep": (b"[" * 1000, "not valid YAML"),
    "a list for a key": (b"? [1, 2]\n: 3\n", "not valid YAML", "line 1"),
}
