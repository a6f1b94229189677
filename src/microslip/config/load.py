"""Read a YAML file and convert it to a checked configuration."""

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any, get_args

import yaml
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from microslip.config.settings import DRIVES, Configuration, Refusal, Sweep, short_json
from microslip.foundation import named_files
from microslip.foundation.errors import InputError
from microslip.foundation.files import content_of
from microslip.foundation.spec import near_miss

MOST_BYTES = 1_000_000
"""Largest size of a configuration in bytes.  PyYAML reads about 100 kB per second."""
MOST_VALUES = 100_000
"""Largest number of keys and values in a file after expansion of aliases."""
ROLES = ("motion", "pressure")
"""Keys of a sweep whose values can name files."""


class ConfigError(ValueError):
    """Error for an invalid configuration.  The message is one line with the file, the key, the
    value and the allowed values."""

    def __init__(self, message: object):
        super().__init__(" ".join(str(message).split()))


# YAML


class Loader(yaml.SafeLoader):
    """Loader for the numbers of YAML 1.2, in which 1e-3 is a number and 010 is 10.

    It refuses keys that occur twice, and files with too many values.
    """

    yaml_implicit_resolvers = {
        first: [(tag, rule) for tag, rule in rules if tag.rpartition(":")[2] not in REPLACED]
        for REPLACED in [("int", "float", "timestamp")]
        for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def get_single_node(self) -> yaml.Node | None:
        """Parse the document.  Its size is checked before any value is constructed."""
        node = super().get_single_node()
        if node is not None and _size(node, {}) > MOST_VALUES:
            raise yaml.MarkedYAMLError(None, None, f"more than {MOST_VALUES} values with aliases")
        return node

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        """Refuse a key that occurs twice, before merged mappings add their keys."""
        keys = [key.value for key, _ in node.value if key.tag != "tag:yaml.org,2002:merge"]
        twice = next((key for i, key in enumerate(keys) if key in keys[:i]), None)
        if twice is not None and not getattr(node, "merged", False):
            mark = [key.start_mark for key, _ in node.value if key.value == twice][1]
            raise yaml.MarkedYAMLError(None, None, f"the key {twice} occurs twice", mark)
        node.merged = True
        super().flatten_mapping(node)

    def construct_number(self, node: yaml.ScalarNode) -> int | float:
        """Construct a number in base 10."""
        text = node.value.lower()
        if re.fullmatch("[-+]?[0-9]+", text):
            return int(text)
        value = float(re.sub(r"\.(inf|nan)$", r"\1", text))
        if value == 0.0 and re.search("[1-9]", text.partition("e")[0]):
            raise ValueError(f"{node.value} is nearer 0 than a float; write 0")
        return value

    def construct_object(self, node: yaml.Node, deep: bool = False) -> object:
        """Construct a value.  An error of a constructor gets a line number."""
        try:
            return super().construct_object(node, deep)
        except (ValueError, TypeError, KeyError) as error:
            kind = node.tag.rpartition(":")[2]
            raise yaml.MarkedYAMLError(None, None, f"{kind}: {error}", node.start_mark) from None


NUMBER = r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN)"
Loader.add_implicit_resolver("tag:number", re.compile(f"^(?:{NUMBER})$"), list("-+.0123456789"))
for _tag in ("tag:number", "tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
    Loader.add_constructor(_tag, Loader.construct_number)


def _size(node: yaml.Node, sizes: dict[int, int]) -> int:
    """Number of nodes in a tree after expansion of aliases.  sizes: sizes of nodes by id."""
    if sizes.get(id(node)) == 0:
        raise yaml.MarkedYAMLError(None, None, "a value contains itself", node.start_mark)
    if id(node) not in sizes:
        sizes[id(node)] = 0  # until the children are counted
        children = node.value if isinstance(node.value, list) else []
        flat = [child for one in children for child in (one if isinstance(one, tuple) else [one])]
        sizes[id(node)] = 1 + sum(_size(child, sizes) for child in flat)
    return sizes[id(node)]


def read_yaml(path: str | os.PathLike) -> dict:
    """Parse a YAML file into a dict.

    Raises ConfigError if the file cannot be read, if the YAML is invalid, or if a key occurs
    twice.  The message is one line with the file and the line number.
    """
    try:
        content = content_of(path, MOST_BYTES)
        text = content.decode("utf-8-sig")
        mapping = yaml.load(text, Loader)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = content[error.start]
        raise ConfigError(
            f"{path}: line {line}: not text: byte 0x{byte:02x}; allowed: UTF-8"
        ) from None
    except yaml.YAMLError as error:
        position = getattr(error, "position", None)  # of a character that is not allowed
        line_ = "" if position is None else f"line {text[:position].count(chr(10)) + 1}: "
        hint = "; allowed: spaces, no tabs" if "'\\t'" in str(error) else ""
        raise ConfigError(f"{path}: not valid YAML: {line_}{error}{hint}") from None
    except RecursionError:
        raise ConfigError(f"{path}: not valid YAML: too many levels") from None
    except ValueError as error:  # the file is too large, or its name is no name
        raise ConfigError(f"{path!s}: {error}") from None
    if not isinstance(mapping, dict):
        found = "is empty" if mapping is None else f"{short_json(mapping)} is not a mapping"
        raise ConfigError(f"{path}: {found}; allowed: keys and values, sweeps at least")
    return mapping


def reread(config: dict, paths: Iterable[str | os.PathLike]) -> dict:
    """Return a copy of a configuration in which `read_yaml` has read the values from files.

    Snakemake reads files as YAML 1.1, in which 1e-3 is a text and 010 is 8.

    config: configuration as Snakemake has merged it from these files and from --config.
    """
    old: dict = {}
    new: dict = {}
    for path in paths:
        with open(path, encoding="utf-8-sig") as file:
            _update(old, yaml.safe_load(file))
        _update(new, read_yaml(path))
    return _replaced(config, old, new)


def _update(mapping: dict, other: dict) -> None:
    for key, value in other.items():
        if isinstance(value, dict) and isinstance(mapping.get(key), dict):
            _update(mapping[key], value)
        else:
            mapping[key] = value


def _replaced(value: Any, old: Any, new: Any) -> Any:
    if value == old:
        return new
    if not (isinstance(value, dict) and isinstance(old, dict) and isinstance(new, dict)):
        return value
    return {
        k: _replaced(v, old[k], new[k]) if k in old and k in new else v for k, v in value.items()
    }


# Configurations


def load(path: str | os.PathLike) -> Configuration:
    """Read and check a YAML file; return a Configuration or raise ConfigError.

    Motion and pressure files are searched for in the folder of the YAML file, then in the working
    directory.
    """
    source = str(path)
    configuration = from_mapping(read_yaml(path), source=source, folders=[Path(path).parent])
    refuse_unsolvable(configuration, source=source)
    return configuration


def from_mapping(
    mapping: dict, source: str = "configuration", folders: Iterable = ()
) -> Configuration:
    """Check a parsed configuration.

    Parameters
    ----------
    mapping : dict
        Parsed YAML.
    source : str
        Name of the configuration in messages, usually the file.
    folders : iterable of paths
        Folders in which motion and pressure files are searched for, before the working directory.

    Returns
    -------
    Configuration
        Files of motions and pressures are named by their content.  `refuse_unsolvable` checks
        whether the solver accepts the points.

    Raises
    ------
    ConfigError
        If the configuration is invalid.
    """
    try:
        configuration = Configuration.model_validate(mapping)
    except ValidationError as error:
        raise ConfigError(f"{source}: {_line(error.errors(include_url=False))}") from None
    sweeps = dict(configuration.sweeps)
    for name, sweep in sweeps.items():
        with _errors_at(f"{source}: sweeps.{name}"):
            files = {role: _file_in(getattr(sweep, role), role, folders) for role in ROLES}
        names = {role: file.name for role, file in files.items() if file is not None}
        if names:
            sweeps[name] = sweep.model_copy(update=names)
    return configuration.model_copy(update={"sweeps": sweeps})


def with_paths(mapping: dict, folders: Iterable = ()) -> dict:
    """Return a checked mapping in which the files of sweeps have absolute paths and digests.

    A job can use the result in any working directory.
    """
    sweeps = {name: dict(sweep) for name, sweep in mapping.get("sweeps", {}).items()}
    for sweep in sweeps.values():
        for role in ROLES:
            if (file := _file_in(sweep.get(role, ""), role, folders)) is not None:
                sweep[role] = file.placed
    return mapping | ({"sweeps": sweeps} if sweeps else {})


def refuse_unsolvable(
    configuration: Configuration,
    names: Iterable[str] | None = None,
    source: str = "configuration",
) -> None:
    """Raise ConfigError for a sweep that the solver refuses.

    Motions, pressures, models and drives are checked at the ends of all axes.  The solver is
    imported, which takes half a second.

    names: names of the sweeps to check; the default is all sweeps.
    """
    for name in configuration.sweeps if names is None else names:
        if name in configuration.sweeps:
            with _errors_at(f"{source}: sweeps.{name}"):
                _refuse_corners(configuration.sweeps[name])


def _refuse_corners(sweep: Sweep) -> None:
    from microslip.answer.limits import choose_model, problem_of, refuse
    from microslip.scene.by_name import motion_named, pressure_named

    motion = motion_named(sweep.motion)
    pressure_named(sweep.pressure)
    if motion.periodic and not sweep.amplitude:
        raise Refusal(f"missing; required for {motion.name}", "amplitude")
    if sweep.amplitude and not motion.periodic:
        message = f"{list(sweep.amplitude)} is not allowed; {motion.name} has no amplitude"
        raise Refusal(message, "amplitude")
    names = ("velocity", "amplitude", "poisson", *DRIVES)
    ends = [dict.fromkeys((v[0], v[-1]) if (v := getattr(sweep, n)) else (None,)) for n in names]
    for place in product(*ends):
        at: dict[str, Any] = dict(zip(names, place, strict=True))
        drive = {name: at.pop(name) for name in DRIVES}
        problem = problem_of(sweep.motion, pressure=sweep.pressure, drive=drive, **at)
        moves = at["velocity"] != 0.0 or sweep.drives
        model = choose_model(problem, sweep.model) if moves or sweep.model != "auto" else None
        if sweep.drives:
            assert model is not None
            refuse(problem, model)


def _file_in(name: Any, role: str, folders: Iterable) -> named_files.NamedFile | None:
    """Return the file in the name of a motion or a pressure, with its path and digest, or None.

    Raises InputError if the file is missing.
    """
    if not (named_files.speaks_of_file(name) or named_files.speaks_of_module(name)):
        return None
    file = named_files.parse(name, role)
    if file.digest and file.path:  # an earlier call found the file
        named_files.remember([name])
        return file
    return named_files.read(name, role, folders)[0]


# Messages


@contextmanager
def _errors_at(where: str) -> Iterator[None]:
    """Context manager that converts errors to ConfigError.  The message begins with `where`."""
    try:
        yield
    except Refusal as error:
        key = f".{error.key}" if error.key else ""
        raise ConfigError(f"{where}{key}: {error}") from None
    except InputError as error:  # solver arguments and keys have the same names
        line = f"{where}.{error.argument}: {error.value!r}: {error.allowed}"
        raise ConfigError(line) from None
    except ValueError as error:  # from readers of files
        raise ConfigError(f"{where}: {error}") from None


def _line(errors: list[ErrorDetails]) -> str:
    """Message for one of the errors of pydantic, with the key, the value and the allowed values.

    Unknown keys come first, since a mistyped key is also missing.
    """
    error = min(errors, key=lambda e: e["type"] != "extra_forbidden")
    *outer, last = keys = [key for key in error["loc"] if key != "[key]"] or [""]
    where = ".".join(map(str, keys))
    refusal = error.get("ctx", {}).get("error")
    if isinstance(refusal, Refusal):
        dot = "." if where and refusal.key and not refusal.key.startswith((".", "[")) else ""
        return f"{where}{dot}{refusal.key}: {refusal}"
    if error["type"] == "extra_forbidden":
        names = list(_model_at(outer).model_fields)
        hint = near_miss(last, names)
        return f"{where}: unknown key; {hint}allowed: {', '.join(names)}"
    if error["type"] == "missing":
        fields = _model_at(outer).model_fields.items()
        return f"{where}: missing; required: {', '.join(n for n, f in fields if f.is_required())}"
    is_model = error["type"].startswith("model")
    names = list(_model_at(keys).model_fields) if is_model else []
    allowed = f"a mapping with the keys {', '.join(names)}" if names else "a mapping of names"
    return f"{where}: {short_json(error['input'])} is not allowed; allowed: {allowed}"


def _model_at(keys: list) -> type[BaseModel]:
    """Return the model of the settings at these keys, such as ["sweeps", "bore"]."""
    model: type[BaseModel] = Configuration
    rest = [key for key in keys if key != ""]
    while rest:
        annotation = model.model_fields[rest.pop(0)].annotation
        if getattr(annotation, "__origin__", None) is dict:
            rest = rest[1:]  # the name of an entry
        models = [annotation, *get_args(annotation)]
        model = next(m for m in models if isinstance(m, type) and issubclass(m, BaseModel))
    return model
