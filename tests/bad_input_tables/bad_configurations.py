"""Bad configurations: values of keys, settings that contradict each other, and files.

The line of a refusal starts with the key.
"""

import re
from copy import deepcopy

import yaml
from stubs.claims_stub import CLAIMS
from stubs.studies_stub import ACCURACY, STABILITY

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
POINT = "accuracy.points.mid"

# Keys to set in GOOD, and bad values in YAML (None: no such key).
VALUES: dict = {
    "reslts": ["x"],
    "results": ["'~'", "s3://bucket/x"],
    "points_per_job": ["0"],
    "sweeps.Bore": ["{}"],
    "sweeps.all": ["{motion: bore, velocity: 1}"],
    f"{T}.motion": [None, "5", "eliptic"],
    f"{T}.amplitude": [None],
    f"{T}.velocity": [None, "[]"],
    f"{T}.force": ["0.5"],
    f"{T}.velocity[0]": ["-0.1", "[1]"],
    f"{T}.velocity[1]": ["fast", "'0.1'", "true", ".nan", "1.0e+9"],
    f"{B}.velocity": ["{logs: [1, 2, 3]}"],
    f"{B}.velocity.log": ["[1, 2]", "[10, 1, 3]"],
    f"{B}.amplitude[1].linear[0]": ["-1"],
    f"{C}.poisson": ["0.7", "[]"],
    f"{C}.model": ["poler"],
    f"{C}.tolerance": ["1"],
    f"{B}.title": ["''", "' '", "x" * 101, r'"a\nb"', r'"\0"', r'"\ud800"', r'"\u2028"'],
    f"{C}.cells": ["7", "5000"],
    f"{T}.error": ["0"],
    "figures.bore": ["{kind: map, sweep: bore}"],
    "figures.look.kind": [None, "maps"],
    "figures.look.sweep": [None, "bores", "[bore, bore]"],
    "figures.forces.sweep": ["[bore, transverse]"],
    "accuracy.methods[1]": ["full-newtn", "1"],
    "stability.methods": ["[euler, euler]"],
    "stability.axes.steps": ["{motion: bore, velocity: 1, amplitude: 1}"],
    f"{POINT}.motion": [None, "bores"],
    f"{POINT}.amplitude": [None],
    "accuracy.map.velocity": ["[1]"],
    "accuracy.map.tolerance[1]": ["1"],
    "claims.amplitude_bore": ["[6, 10]"],
}

# Keys that GOOD lacks and that cases above change.
STUDIED = {"accuracy": ACCURACY, "stability": STABILITY, "claims": CLAIMS}


def changed(settings):
    """GOOD with settings given as YAML by their keys, such as sweeps.bore.amplitude[0]."""
    mapping = yaml.safe_load(GOOD)
    if any(key.startswith(("accuracy", "stability", "claims.")) for key in settings):
        mapping |= deepcopy(STUDIED)
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
LARGE = "{log: [1, 2, 30000]}"
GRID = "{linear: [1, 2, %d]}"

# Settings that are valid one by one, and the key in the message.
TOGETHER: list = [
    ({"figures.look": "{kind: explorer, sweep: continuous_bore}"}, "figures.look.sweep"),
    ({f"{B}.velocity": LARGE, "figures.look.kind": "explorer"}, "figures.look.sweep"),
    ({"figures.look.kind": "field"}, "figures.look.sweep"),
    ({f"{B}.amplitude": "1"}, "figures.look.sweep"),
    ({f"{B}.velocity": "[0, 1]"}, "figures.look.sweep"),
    ({f"{B}.stiffness": "[1, 2]"}, "figures.look.sweep"),
    ({"figures.look": "{kind: curves, sweep: continuous_bore}"}, "figures.look.sweep"),
    ({"figures.forces.sweep": "continuous_bore"}, "figures.forces.sweep"),
    (MAP, "figures.forces.sweep"),
    ({"figures.look": "{kind: history, sweep: transverse}"}, "figures.forces.kind"),
    ({"sweeps": "{}", "figures": "{}"}, "sweeps"),
    ({f"{T}.model": "radial", f"{T}.poisson": "[0, 0.2]"}, f"{T}.model"),
    ({f"{B}.stiffness": "0"}, f"{B}.stiffness"),
    ({f"{B}.mass": "1"}, f"{B}.mass"),
    ({f"{B}.model": "mdr", f"{B}.stiffness": "1"}, f"{B}.model"),
    ({f"{B}.amplitude": "[1, 1.0000000001]"}, f"{B}.amplitude"),
    ({f"{T}.velocity": GRID % 1001, f"{T}.amplitude": GRID % 1000}, T),
    ({"accuracy.map.velocity": GRID % 6000}, "accuracy.map.velocity x amplitude_transverse"),
    ({"stability.axes.steps.velocity": "[1, 2]"}, "stability.axes.steps"),
    (MAP | {f"{T}.tolerance": "1e-2"}, f"{T}.tolerance"),
    ({f"{T}.error": "0.1", f"{T}.tolerance": "0.02"}, f"{T}.tolerance"),
    (MAP | {f"{T}.velocity": "[1]"}, f"{T}.error"),
    ({f"{T}.tolerance": "~"}, f"{T}.tolerance"),
]

# Files that are no configuration: their bytes, and a part of the message.
FILES = {
    "empty": (b"", "is empty"),
    "a list": (b"- 1\n- 2\n", "[1, 2] is not a mapping"),
    "not UTF-8": (b"# \xe9t\xe9\n" + GOOD.encode(), "line 1: not text: byte 0xe9"),
    "a number of 5000 digits": (b"results: " + b"9" * 5000 + b"\n", "int"),
    "a number nearer 0 than a float": (b"results: 1e-400\n", "nearer 0 than"),
    "tabs": (GOOD.replace("    ", "\t").encode(), "line 4"),
    "a key twice": (f"{GOOD}sweeps: {{}}\n".encode(), "the key sweeps occurs twice"),
    "two documents": (GOOD.encode() + b"---\n" + GOOD.encode(), "another document"),
    "a tag": (b"results: !!python/object/apply:os.getcwd []\n", "line 1"),
    "itself inside": (b"sweeps: &s {transverse: *s}\n", "contains itself"),
    "very deep": (b"[" * 1000, "not valid YAML"),
}
