"""The configuration of a sweep: read YAML, check it, fill in defaults, expand the axes.

The JSON schema beside this module (schemas/config.schema.yaml) holds the shape, the ranges, the
defaults and a description of every key. What a schema cannot say is checked here: text that was
meant as a number, values that are not finite, duplicates, models that do not apply to a scene.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

import difflib
import json
import math
from dataclasses import asdict, dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import jsonschema
import yaml

from .keys import number

SCHEMA_PATH = Path(__file__).parent / "schemas" / "config.schema.yaml"
# Sweeps are named like their datasets, scenes as on the command line.
SCENE_OF_SWEEP = {"transverse": "transverse", "bore": "bore", "continuous_bore": "continuous-bore"}

# The single runs, for figures, that a dataset carries besides its sweep.
HISTORIES_OF_SWEEP = {
    "transverse": ("transverse",),
    "bore": (),
    "continuous_bore": ("field", "transients"),
}
# What microslip.models refuses, which takes too long to import here; a test keeps them the same.
MODELS_OF_SCENE = {
    "transverse": ("auto", "rigid", "slider", "radial", "polar", "cartesian"),
    "bore": ("auto", "rigid", "polar", "cartesian"),
    "continuous-bore": ("auto", "rigid", "polar", "cartesian"),
}


class ConfigError(ValueError):
    """A configuration that cannot be used. The message is one line: file, key, value, allowed."""


@dataclass(frozen=True)
class Sweep:
    """A grid of points. The axes are ascending tuples of floats, all dimensionless."""

    name: str
    scene: str
    velocity: tuple
    amplitude: tuple | None  # None: the scene has no amplitude
    poisson: tuple
    poisson_is_axis: bool  # a list was given, so the dataset gets a dimension of this name
    model: str
    tolerance: float
    cells: int | None
    steps: int | None

    @property
    def spans_a_map(self):
        """Whether there is an area to draw: two amplitudes and two velocities above 0 at least."""
        positive = [velocity for velocity in self.velocity if velocity > 0]
        return len(self.amplitude or ()) > 1 and len(positive) > 1


@dataclass(frozen=True)
class Configuration:
    """A checked configuration with its defaults filled in and its axes expanded."""

    results: str
    points_per_job: int
    sweeps: dict  # name -> Sweep, in the order of SCENE_OF_SWEEP
    histories: dict  # transverse, field, transients -> dict of settings, as in the schema

    def of_sweep(self, name):
        """All settings that the dataset of the sweep `name` depends on, as a dict for JSON."""
        names = HISTORIES_OF_SWEEP[name]
        return {
            "sweep": asdict(self.sweeps[name]),
            "histories": {history: self.histories[history] for history in names},
        }


def load(path):
    """Read and check the YAML file `path`; return a Configuration or raise ConfigError."""
    return from_mapping(read_yaml(path), source=str(path))


def read_yaml(path):
    """Parse a YAML file into a dict, refusing keys that occur twice. Raises ConfigError."""
    try:
        with open(path, encoding="utf-8") as file:
            mapping = yaml.load(file, _UniqueKeyLoader)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: not valid YAML: {' '.join(str(error).split())}") from None
    if not isinstance(mapping, dict):
        raise ConfigError(f"{path}: {_shown(mapping)} is not a mapping; allowed: keys and values")
    return mapping


def from_mapping(mapping, source="configuration"):
    """Check a parsed configuration and return it as a Configuration.

    source: how messages name the origin, usually the file. Raises ConfigError.
    """
    _refuse_non_finite(mapping, source, ())
    errors = jsonschema.Draft202012Validator(schema()).iter_errors(mapping)
    # A mistyped key is both unknown and missing; the first of the two helps more.
    first = min(
        errors, key=lambda e: (e.validator != "additionalProperties", _key(e)), default=None
    )
    if first is not None:
        raise ConfigError(f"{source}: {_explain(first)}")
    filled = _filled(mapping, schema())
    sweeps = {
        name: _sweep(name, filled["sweeps"][name], source)
        for name in SCENE_OF_SWEEP
        if name in filled["sweeps"]
    }
    return Configuration(filled["results"], filled["points_per_job"], sweeps, filled["histories"])


@cache
def schema():
    """Return the JSON schema as a dict, shared by all callers: do not change it."""
    return yaml.safe_load(SCHEMA_PATH.read_text(encoding="utf-8"))


# From settings to sweeps


def _sweep(name, given, source):
    where = f"{source}: sweeps.{name}"
    scene = SCENE_OF_SWEEP[name]
    poisson = given["poisson"]
    sweep = Sweep(
        name=name,
        scene=scene,
        velocity=_axis(given["velocity"], f"{where}.velocity"),
        amplitude=_axis(given["amplitude"], f"{where}.amplitude") if "amplitude" in given else None,
        poisson=_axis(poisson if isinstance(poisson, list) else [poisson], f"{where}.poisson"),
        poisson_is_axis=isinstance(poisson, list),
        model=given["model"],
        tolerance=float(number(given["tolerance"])),
        cells=given["cells"],
        steps=given["steps"],
    )
    _refuse_mismatch(sweep, where)
    return sweep


def _axis(given, where):
    if isinstance(given, list):
        values = [float(number(value)) for value in given]
    else:
        ((spacing, spec),) = given.items()
        values = _spaced(spacing, spec, f"{where}.{spacing}")
    values.sort()
    for low, high in pairwise(values):
        if high - low <= 1e-9 * high:
            raise ConfigError(f"{where}: {high:.12g} occurs twice; allowed: different values")
    return tuple(values)


def _spaced(spacing, spec, where):
    start, stop, count = spec["start"], spec["stop"], spec["count"]
    if stop <= start:
        raise ConfigError(f"{where}.stop: {stop} is not allowed; allowed: a number above {start}")
    if spacing == "linear":
        values = (start + (stop - start) * i / (count - 1) for i in range(count))
    else:
        values = (start * math.exp(math.log(stop / start) * i / (count - 1)) for i in range(count))
    # Six digits make the coordinates readable, and the same on every machine.
    return [float(f"{value:.6g}") for value in values]


def _refuse_mismatch(sweep, where):
    """Refuse settings that are fine one by one but not together."""
    known = MODELS_OF_SCENE[sweep.scene]
    if sweep.model not in known:
        raise ConfigError(
            f'{where}.model: "{sweep.model}" does not apply to {sweep.scene}; '
            f"allowed: {', '.join(known)}"
        )
    if sweep.model == "radial" and sweep.poisson[-1] > 0:
        raise ConfigError(
            f"{where}.poisson: {sweep.poisson[-1]:g} does not go with model radial; allowed: 0"
        )
    static = sweep.velocity[0] == 0
    if static and sweep.model != "auto":
        raise ConfigError(
            f"{where}.velocity: 0, the static limit, does not go with model {sweep.model}; "
            "allowed: numbers > 0, or model auto"
        )
    if static and sweep.scene == "transverse" and sweep.poisson[-1] > 0:
        raise ConfigError(
            f"{where}.velocity: 0, the static limit, is known for poisson 0 only; "
            "allowed: numbers > 0"
        )


# Defaults


def _filled(value, rule):
    """Copy `value` with the defaults of the schema `rule` filled in, and whole floats as int."""
    rule = _resolved(rule)
    if isinstance(value, dict):
        rules = rule.get("properties", {})
        whole = {k: _resolved(r)["default"] for k, r in rules.items() if "default" in _resolved(r)}
        return {k: _filled(v, rules[k]) for k, v in {**whole, **value}.items()}
    if isinstance(value, list):
        return list(value)
    if "integer" in rule.get("type", ()) and value is not None:
        return int(value)
    return value


def _resolved(rule):
    if "$ref" not in rule:
        return rule
    return {**schema()["$defs"][rule["$ref"].rpartition("/")[2]], **rule}


# Messages


def _refuse_non_finite(value, source, path):
    if isinstance(value, dict):
        for key, item in value.items():
            _refuse_non_finite(item, source, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            _refuse_non_finite(item, source, (*path, index))
    elif isinstance(value, float) and not math.isfinite(value):
        raise ConfigError(f"{source}: {_dotted(path)}: {value} is not allowed; allowed: finite")


def _explain(error):
    """One line for a jsonschema error: key, value, what is allowed."""
    rule, value = error.schema, error.instance
    if error.validator == "additionalProperties":
        return _unknown_key(error)
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in value)
        path = _dotted((*error.absolute_path, missing))
        return f"{path}: missing; required: {', '.join(error.validator_value)}"
    where = _key(error)
    wants_number = {"number", "integer"} & set(_types(rule))
    if isinstance(value, str) and wants_number:
        return f"{where}: {_shown(value)} is text; {_as_number(value)}"
    return f"{where}: {_shown(value)} is not allowed; allowed: {_allowed(rule)}"


def _unknown_key(error):
    known = list(error.schema.get("properties", {}))
    unknown = next(key for key in error.instance if key not in known)
    near = difflib.get_close_matches(str(unknown), known, n=1)
    hint = f"did you mean {near[0]}? " if near else ""
    path = _dotted((*error.absolute_path, unknown))
    return f"{path}: unknown key; {hint}allowed: {', '.join(known)}"


def _as_number(text):
    try:
        value = float(text)
    except ValueError:
        return "allowed: a number"
    if not math.isfinite(value):
        return "allowed: a finite number"
    mantissa, _, exponent = text.lower().partition("e")
    if not exponent:
        return f"write the number without quotes: {text}"
    # YAML 1.1 takes it for a number only with a point before and a sign after the e.
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"write {mantissa}e{int(exponent):+d}"


def _allowed(rule):
    if "enum" in rule:
        return ", ".join(rule["enum"])
    kinds = _types(rule)
    if "array" in kinds and "object" in kinds:
        return f"a list of {_allowed(_resolved(rule['items']))}, or linear or log spacing"
    if kinds == ["object"]:
        return f"a mapping with the keys {', '.join(rule['properties'])}"
    words = {"number": "a number", "integer": "a whole number", "array": "or a list of them"}
    words |= {"string": "text for a folder, without braces, * and ?", "null": "or null"}
    limits = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<="}
    ranges = [f"{sign} {rule[key]:g}" for key, sign in limits.items() if key in rule]
    if rule.get("multipleOf") == 2:
        words["integer"] = "an even number"
    first, *others = [words[kind] for kind in kinds]
    return " ".join([first, " and ".join(ranges), *others]).replace("  ", " ").strip()


def _types(rule):
    kinds = rule.get("type", [])
    return [kinds] if isinstance(kinds, str) else kinds


def _key(error):
    return _dotted(error.absolute_path) or "(top level)"


def _dotted(path):
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def _shown(value):
    text = json.dumps(value, default=str, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."


class _UniqueKeyLoader(yaml.SafeLoader):
    """YAML silently keeps the last of two equal keys; here that is an error."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if key_node.tag != "tag:yaml.org,2002:merge" and str(key) in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key} occurs twice", key_node.start_mark
                )
            seen.add(str(key))
        return super().construct_mapping(node, deep)
