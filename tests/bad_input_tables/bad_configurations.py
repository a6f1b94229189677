"""Bad configurations, each with parts of its one line after the name of the file.

A line starts with the key. Its parts are the value, the reason, and the allowed values.
"""

import re

import yaml

GOOD = """
sweeps:
  transverse:
    motion: transverse
    velocity: [0.1, 1]
    amplitude: [0, 1]
  bore:
    motion: bore
    velocity: {log: [0.1, 10, 3]}
    amplitude: [0.25, {linear: [0, 1, 3]}]
  continuous_bore:
    motion: continuous-bore
    velocity: 1
figures:
  look: {kind: map, sweep: bore}
  forces: {kind: history, sweep: transverse}
"""
T, B, C = "sweeps.transverse", "sweeps.bore", "sweeps.continuous_bore"
TOLERANCES = ">= 1e-06 and <= 0.1"
MODELS = "auto, rigid, slider"

# Key to set in GOOD, its value in YAML (None: no such key), parts. The line starts with the key.
KEYS = [
    ("reslts", "x", "unknown key; did you mean results?", "points_per_job"),
    ("results", "' '", '" " is not allowed', "text for a folder"),
    ("results", "r{x}", '"r{x}"', "without braces, *, ?"),
    ("results", "5", "5 is not allowed", "text for a folder"),
    ("points_per_job", "0", "0 is not allowed", ">= 1"),
    ("points_per_job", "1.5", "1.5 is not allowed", "a whole number"),
    ("sweeps", "[bore]", '["bore"] is not allowed', "a mapping of names"),
    ("sweeps.Bore", "{}", '"Bore" is not allowed', "small letters, digits and _"),
    ("sweeps.all", "{motion: bore, velocity: 1}", "another result or rule has this name"),
    (C, "~", "null is not allowed", "velocity"),
    (f"{T}.velocities", "[1]", "unknown key; did you mean velocity?"),
    (f"{T}.motion", None, "missing; required: motion"),
    (f"{T}.motion", "5", "5 is not allowed", "text"),
    (f"{T}.motion", "eliptic", "'eliptic'", "did you mean elliptic?", "transverse, longitudinal"),
    (f"{T}.pressure", "hertzian", "'hertzian'", "allowed is ", "hertz"),
    (f"{T}.title", "''", '"" is not allowed', "text on one line"),
    (f"{T}.amplitude", None, "missing; required for transverse"),
    (f"{T}.velocity", None, "missing; required: velocity, or force"),
    (f"{T}.force", "0.5", "is not allowed beside velocity; allowed: one of them"),
    (f"{T}.mass", "1", "1.0: allowed beside a stiffness alone"),
    (f"{T}.velocity[0]", "-0.1", "-0.1 is not allowed", ">= 0"),
    (f"{T}.velocity[1]", "fast", '"fast" is text', "a number"),
    (f"{T}.velocity[1]", "'0.1'", '"0.1" is text', "without quotes"),
    (f"{T}.velocity[1]", "'inf'", '"inf" is text', "a number"),
    (f"{T}.velocity[1]", "true", "true is not allowed", "a number"),
    (f"{T}.velocity[1]", ".nan", "nan is not allowed", "a finite number"),
    (f"{T}.velocity[1]", "1.0e+9", "1000000000.0 is not allowed", "<= 1e+06"),
    (f"{T}.velocity", "all", '"all" is text', "a number"),
    (f"{T}.velocity", "[]", "[] is not allowed", "a list of"),
    (f"{T}.velocity", "{}", "{} is not allowed", "{log: [first, last, count]}"),
    (f"{T}.velocity", "[[1]]", "[[1]] is not allowed", "a list of numbers and ranges"),
    (f"{B}.velocity", "{logs: [1, 2, 3]}", "did you mean log?"),
    (f"{B}.velocity.log", "[1, 2]", "[1, 2] is not allowed", "[first, last, count]"),
    (f"{B}.velocity.log[0]", "0", "0 is not allowed", "> 0"),
    (f"{B}.velocity.log", "[10, 1, 3]", "[10, 1, 3] is not allowed", "last above first"),
    (f"{B}.velocity.log[2]", "1", "1 is not allowed", "a whole number >= 2"),
    (f"{B}.amplitude[1].linear[0]", "-1", "-1 is not allowed", ">= 0"),
    (f"{C}.poisson", "0.7", "0.7 is not allowed", ">= 0 and <= 0.5"),
    (f"{C}.poisson", "[]", "[] is not allowed", "a list"),
    (f"{C}.model", "poler", '"poler" is not allowed; did you mean polar?', MODELS),
    (f"{C}.model", "radial", "'radial': does not apply to continuous-bore"),
    (f"{C}.method", "eulr", "'eulr'", "did you mean euler?"),
    (f"{C}.tolerance", "1", "1 is not allowed", TOLERANCES),
    (f"{C}.cells", "7", "7 is not allowed", "an even number >= 4"),
    (f"{C}.cells", "5000", "5000 is not allowed", "<= 1000"),
    (f"{C}.steps", "9", "9 is not allowed", "an even number >= 8"),
    (f"{C}.amplitude", "1", "[1.0] is not allowed; continuous-bore has no amplitude"),
    (f"{T}.error", "0", "0 is not allowed", ">= 1e-05 and <= 0.1"),
    ("figures.bore", "{kind: map, sweep: bore}", "another result or rule has this name"),
    ("figures.look.kind", None, "missing; required: kind"),
    ("figures.look.kind", "maps", '"maps" is not allowed; did you mean map?', "history, map"),
    ("figures.look.sweep", None, "missing; required: the name of a sweep"),
    ("figures.look.sweep", "bores", '"bores" is no sweep; did you mean bore?', "transverse"),
    ("figures.look.sweep", "[bore, bore]", "bore occurs twice", "different values"),
    ("figures.look.velocity", "1", "is not allowed for the kind map; allowed: kind, sweep"),
    ("figures.forces.velocity", "0", "0 is not allowed", "> 0"),
    ("figures.forces.periods", "0", "0 is not allowed", ">= 1"),
    ("figures.forces.sweep", "[bore, transverse]", "is not allowed; allowed: one sweep"),
]

POINT = "accuracy.points.a"
STUDIES = [
    ("accuracy.methods", "euler", '"euler" is not allowed', "a list of methods"),
    ("accuracy.methods[1]", "full-newtn", "'full-newtn'", "did you mean full-newton?"),
    ("accuracy.methods[1]", "1", "1: allowed is one of shipped"),
    ("stability.methods", "[euler, euler]", "euler occurs twice", "different values"),
    ("stability.tolerance", "0.5", "0.5 is not allowed", TOLERANCES),
    ("stability.axes", "[edge]", '["edge"] is not allowed', "a mapping of names"),
    ("stability.axes.edge", "{motion: bore, velocity: 1, amplitude: 1}", "no key has several"),
    ("stability.axes.edge.cells[1]", "9", "9 is not allowed", "an even number >= 4"),
    ("accuracy.levels", "7", "7 is not allowed", "<= 6"),
    (f"{POINT}.motion", None, "missing; required: motion, velocity"),
    (f"{POINT}.motion", "bores", '"bores" is not allowed; did you mean bore?', "zigzag"),
    (f"{POINT}.velocity", "0", "0 is not allowed", "> 0"),
    (f"{POINT}.amplitude", None, "missing; required for bore"),
    (f"{POINT}.poisson", "[0, 0.3]", "[0, 0.3] is not allowed", "a number >= 0 and <= 0.5"),
    ("accuracy.map.velocity[0]", "0", "0 is not allowed", "> 0"),
    ("accuracy.map.velocity", "[1]", "[1.0] is not allowed", "two numbers or more"),
    ("accuracy.map.tolerance", "[]", "[] is not allowed", "a list of numbers"),
    ("accuracy.map.tolerance[1]", "1", "1 is not allowed", TOLERANCES),
    ("claims.velocity[0]", "0", "0 is not allowed", "> 0"),
    ("claims.amplitude_bore", "[6, 10]", "[6.0, 10.0] is not allowed", "up to 5"),
    ("claims.amplitude_transverse", "[2]", "[2.0] is not allowed", "up to 1"),
    ("claims.cells", "9", "9 is not allowed", "an even number"),
]

# Keys that GOOD lacks and that cases above change.
STUDIED = """
accuracy:
  methods: [shipped, euler]
  points: {a: {motion: bore, velocity: 1, amplitude: 1}}
  map:
    velocity: [0.1, 1]
    amplitude_transverse: [1, 2]
    amplitude_bore: [1, 2]
    tolerance: [0.01, 0.001]
stability:
  methods: [shipped, euler]
  axes: {edge: {motion: transverse, velocity: 0.01, amplitude: 0.5, cells: [8, 16]}}
claims:
  velocity: [0.1, 1]
  amplitude_transverse: [1]
  amplitude_bore: [1]
"""


def changed(settings):
    """GOOD with settings given as YAML by their keys, such as sweeps.bore.amplitude[0]."""
    mapping = yaml.safe_load(GOOD)
    if any(key.startswith(("accuracy", "stability", "claims.")) for key in settings):
        mapping |= yaml.safe_load(STUDIED)
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


MAP = {f"{T}.error": "1e-2"}
CLOSE = "{linear: [1, 1.000001, 9]}"  # than the six stored digits
GRID = "{linear: [1, 2, %d]}"

# Settings that are valid one by one, the key in the message, parts.
TOGETHER = [
    ({"figures.look": "{kind: claims_static}"}, "figures.look.kind", "needs the key claims"),
    ({"figures.look": "{kind: explorer, sweep: continuous_bore}"}, "figures.look.sweep",
     "has no map", "two amplitudes and two velocities above 0"),
    ({f"{B}.velocity": "{log: [1, 2, 30000]}", "figures.look.kind": "explorer"},
     "figures.look.sweep", "points are not allowed", "at most 20000"),
    ({"figures.look.kind": "field"}, "figures.look.sweep", "the motion bore; allowed: continuous"),
    ({"figures.look": "{kind: history, sweep: transverse}"}, "figures.forces.kind", "another"),
    ({"sweeps": "{}", "figures": "{}"}, "sweeps", "required: sweeps, accuracy, stability or"),
    ({f"{T}.model": "radial", f"{T}.poisson": "[0, 0.2]"}, f"{T}.model", "'radial'", "nu > 0"),
    ({f"{B}.model": "slider"}, f"{B}.model", "'slider'", "bore"),
    ({f"{POINT}.motion": "continuous-bore"}, f"{POINT}.amplitude", "1", "has no amplitude"),
    ({f"{B}.amplitude": "[1, 1.0000000001]"}, f"{B}.amplitude", "occurs twice", "different"),
    ({f"{T}.velocity": GRID % 1001, f"{T}.amplitude": GRID % 1000}, T, "at most 1000000"),
    ({"accuracy.map.velocity": GRID % 6000}, "accuracy.map.velocity x amplitude_transverse",
     "at most 10000"),
    ({"stability.axes.edge.velocity": "[1, 2]"}, "stability.axes.edge",
     "velocity and cells has several", "one key"),
    (MAP | {f"{T}.tolerance": "1e-2"}, f"{T}.tolerance", "0.01 is not allowed", "less than the"),
    ({f"{T}.error": "0.1", f"{T}.tolerance": "0.02"}, f"{T}.tolerance", "0.02", "at most 0.01"),
    (MAP | {f"{T}.velocity": "[1]"}, f"{T}.error", "two amplitudes and two velocities above 0"),
    (MAP | {f"{T}.cells": "8"}, f"{T}.error", "is not allowed with cells"),
    ({f"{T}.tolerance": "~"}, f"{T}.tolerance", "null", "cells and steps imposed"),
    ({f"{T}.tolerance": "~", f"{T}.cells": "8"}, f"{T}.tolerance", "or steps imposed"),
    ({f"{C}.tolerance": "~"}, f"{C}.tolerance", "null", "or cells imposed"),
]  # fmt: skip

# Files that are no configuration: their bytes, parts.
FILES = {
    "empty": (b"", "is empty", "sweeps at least"),
    "a list": (b"- 1\n- 2\n", "[1, 2] is not a mapping", "keys and values"),
    "cut off": (GOOD.partition("3]")[0].encode(), "not valid YAML", "line 9"),
    "not UTF-8": (b"# \xe9t\xe9\n" + GOOD.encode(), "line 1: not text: byte 0xe9", "UTF-8"),
    "not UTF-8 further down": (GOOD.encode() + b"# \xe9t\xe9\n", "line 17: not text: byte 0xe9"),
    "UTF-16": (GOOD.encode("utf-16"), "line 1: not text: byte 0xff", "UTF-8"),
    "UTF-16 without a mark": (GOOD[1:].encode("utf-16-le"), "line 1: ", "special characters"),
    "binary": (b"\x89HDF\r\n\x1a\n\x00\x00", "not text: byte 0x89", "UTF-8"),
    "a bell": (GOOD.encode() + b"# \x07\n", "line 17: ", "#x0007"),
    "nothing to merge": (b"sweeps:\n  <<: 5\n", "not valid YAML", "line 2", "merging"),
    "a tag that does not fit": (b"results: !!bool maybe\n", "not valid YAML", "bool", "line 1"),
    "a number of 5000 digits": (b"results: " + b"9" * 5000 + b"\n", "int", "line 1"),
    "a number nearer 0 than a float": (b"results: 1e-400\n", "nearer 0 than a float", "line 1"),
    "a colon too many": (b"results: a: b\n", "not valid YAML", "line 1"),
    "tabs": (GOOD.replace("    ", "\t").encode(), "not valid YAML", "line 4", "no tabs"),
    "a key twice": (
        GOOD.replace("  bore:", "  transverse: {}\n  bore:").encode(),
        "the key transverse occurs twice",
        "line 7",
    ),
    "two documents": (
        GOOD.encode() + b"---\n" + GOOD.encode(),
        "not valid YAML",
        "another document",
    ),
    "a tag": (b"results: !!python/object/apply:os.getcwd []\n", "not valid YAML", "line 1"),
    "an unknown alias": (b"sweeps: *others\n", "not valid YAML", "others"),
    "itself inside": (b"sweeps: &s {transverse: *s}\n", "contains itself"),
    "very deep": (b"[" * 1000, "not valid YAML"),
    "a list for a key": (b"? [1, 2]\n: 3\n", "not valid YAML", "line 1"),
}
