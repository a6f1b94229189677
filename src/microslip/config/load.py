"""Read a YAML file and convert it to a checked configuration."""

import os
import re
from collections.abc import Callable, Collection, Iterable
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import ValidationError

from microslip.config.settings import Configuration, Refusal, Sweep, problem_of
from microslip.foundation import named_files, spec
from microslip.foundation.errors import InputError, shown
from microslip.foundation.files import content_of

T = TypeVar("T")

MOST_BYTES = 1_000_000
"""Largest size of a configuration file, in bytes.  PyYAML reads about 100 kB per second."""
MOST_VALUES = 100_000
"""Largest number of keys and values in a file, counted after expansion of aliases."""
ROLES = ("motion", "pressure")
"""Keys of a sweep whose values can name files."""


class ConfigError(ValueError):
    """Error for an invalid configuration.  The message is one line with the file, the key, the
    value, and the allowed values."""

    def __init__(self, message: object):
        super().__init__(" ".join(str(message).split()))


# YAML


class Loader(yaml.SafeLoader):
    """YAML loader that reads numbers by the rules of YAML 1.2: 1e-3 is a number, and 010 is 10.

    The loader refuses keys that occur twice, and files with too many values.
    """

    yaml_implicit_resolvers = {
        first: [(tag, rule) for tag, rule in rules if tag.rpartition(":")[2] not in REPLACED]
        for REPLACED in [("int", "float", "timestamp")]
        for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def get_single_node(self) -> yaml.Node | None:
        """Parse the document, and check its size before any value is constructed."""
        node = super().get_single_node()
        if node is not None and _size(node, {}) > MOST_VALUES:
            raise yaml.MarkedYAMLError(None, None, f"more than {MOST_VALUES} values with aliases")
        return node

    def construct_number(self, node: yaml.ScalarNode) -> int | float:
        """Construct a number in base 10."""
        if re.fullmatch("[-+]?[0-9]+", node.value):
            return int(node.value)
        return spec.read("value", re.sub(r"\.(inf|nan)$", r"\1", node.value.lower()))

    def construct_object(self, node: yaml.Node, deep: bool = False) -> object:
        """Construct a value.  The line number is added to the message of an error."""
        try:
            return super().construct_object(node, deep)
        except (ValueError, TypeError, KeyError) as error:
            kind = node.tag.rpartition(":")[2]
            raise yaml.MarkedYAMLError(None, None, f"{kind}: {error}", node.start_mark) from None


NUMBER = r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN)"
Loader.add_implicit_resolver("tag:number", re.compile(f"^(?:{NUMBER})$"), list("-+.0123456789"))
for _tag in ("tag:number", "tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
    Loader.add_constructor(_tag, Loader.construct_number)


def _size(node: yaml.Node, sizes: dict[yaml.Node, int]) -> int:
    """Return the number of nodes in a tree after expansion of aliases.  Raises MarkedYAMLError if a
    key other than << occurs twice in a mapping.

    sizes: sizes of the nodes counted so far; this function adds to it.
    """
    if sizes.get(node) == 0:
        raise yaml.MarkedYAMLError(None, None, "a value contains itself", node.start_mark)
    if node not in sizes:
        sizes[node] = 0  # until the children are counted
        children = node.value if isinstance(node.value, list) else []
        if isinstance(node, yaml.MappingNode):
            first: dict[str, yaml.Node] = {}
            for key, _ in node.value:
                if first.setdefault(str(key.value), key) is not key and key.value != "<<":
                    problem = f"the key {key.value} occurs twice"
                    raise yaml.MarkedYAMLError(None, None, problem, key.start_mark)
            children = [child for pair in node.value for child in pair]
        sizes[node] = 1 + sum(_size(child, sizes) for child in children)
    return sizes[node]


def read_yaml(path: str | os.PathLike) -> dict:
    """Parse a YAML file into a dict.

    Raises ConfigError if the file cannot be read, if the YAML is invalid, or if a key occurs
    twice.  The message is one line with the file and the line number.
    """
    try:
        content = content_of(path, MOST_BYTES)
        text = content.decode("utf-8-sig")
        mapping = yaml.load(text, Loader)
        if isinstance(mapping, dict):
            return mapping
        found = "is empty" if mapping is None else f"{shown(mapping)} is not a mapping"
        problem = f"{found}; allowed: keys and values, sweeps at least"
    except OSError as error:
        problem = f"cannot be read: {error.strerror}"
    except UnicodeDecodeError as error:
        line, byte = content.count(b"\n", 0, error.start) + 1, content[error.start]
        problem = f"line {line}: not text: byte 0x{byte:02x}; allowed: UTF-8"
    except yaml.YAMLError as error:
        hint = "; allowed: spaces, no tabs" if "'\\t'" in str(error) else ""
        problem = f"not valid YAML: {_yaml_problem(error, text)}{hint}"
    except RecursionError:
        problem = "not valid YAML: too many levels"
    except ValueError as error:  # the file is too large, or its name is no name
        problem = str(error)
    raise ConfigError(f"{path!s}: {problem}")


def _yaml_problem(error: Any, text: str) -> str:
    """Return the message of a YAMLError, with line numbers instead of excerpts."""
    if isinstance(error, yaml.reader.ReaderError):
        line = text.count("\n", 0, error.position) + 1
        return f"line {line}: {error.reason}: #x{error.character:04x}"
    marks = ((error.context, error.context_mark), (error.problem, error.problem_mark))
    parts = [f"line {mark.line + 1}: {what}" if mark else what for what, mark in marks if what]
    return "; ".join(parts)


def reread(config: dict, paths: Iterable[str | os.PathLike]) -> dict:
    """Return a copy of a configuration, in which the values from files have been read again with
    `read_yaml`.

    Snakemake reads files as YAML 1.1, in which 1e-3 is a string and 010 is 8.

    config: configuration that Snakemake merged from these files and from --config.
    """
    from snakemake.utils import update_config

    old: dict = {}
    new: dict = {}
    for path in paths:
        with open(path, encoding="utf-8-sig") as file:
            update_config(old, yaml.safe_load(file))
        update_config(new, read_yaml(path))
    return _replaced(config, old, new)


def _replaced(value: Any, old: Any, new: Any) -> Any:
    """Return `new` if `value` equals `old`; otherwise, return `value`.  Values inside mappings are
    replaced in the same way.  An ellipsis stands for a missing value."""
    if value == old and new is not ...:
        return new
    if not all(isinstance(one, dict) for one in (value, old, new)):
        return value
    return {k: _replaced(v, old.get(k, ...), new.get(k, ...)) for k, v in value.items()}


# Configurations


def load(path: str | os.PathLike) -> Configuration:
    """Read a YAML file and return the checked Configuration.  Raises ConfigError if the
    configuration is invalid.

    Motion and pressure files are searched for in the folder of the YAML file, then in the working
    directory.
    """
    configuration = from_mapping(read_yaml(path), source=str(path), folders=[Path(path).parent])
    refuse_unsolvable(configuration, source=str(path))
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
        Name of the configuration in messages, usually the name of the file.
    folders : iterable of paths
        Folders in which motion and pressure files are searched for, before the working directory.

    Returns
    -------
    Configuration
        The checked configuration, in which files of motions and pressures are named by their
        content.  To check that the solver accepts the points, call `refuse_unsolvable`.

    Raises
    ------
    ConfigError
        If the configuration is invalid.
    """
    try:
        configuration = Configuration.model_validate(mapping)
    except ValidationError as error:
        raise ConfigError(f"{source}: {_line(error)}") from None

    def with_names(sweep: Sweep) -> Sweep:
        files = {role: _file_in(getattr(sweep, role), role, folders) for role in ROLES}
        return sweep.model_copy(update={role: file.name for role, file in files.items() if file})

    sweeps = _called(with_names, configuration.sweeps, source)
    return configuration.model_copy(update={"sweeps": sweeps})


def with_paths(mapping: dict, folders: Iterable = ()) -> dict:
    """Return a copy of a checked mapping in which the files of the sweeps have absolute paths and
    digests.

    A job can use this copy in any working directory.
    """
    sweeps = {name: dict(sweep) for name, sweep in mapping.get("sweeps", {}).items()}
    for sweep, role in product(sweeps.values(), ROLES):
        if (file := _file_in(sweep.get(role, ""), role, folders)) is not None:
            sweep[role] = file.placed
    return mapping | {"sweeps": sweeps}


def refuse_unsolvable(
    configuration: Configuration,
    names: Collection[str] | None = None,
    source: str = "configuration",
) -> None:
    """Raise ConfigError if the solver refuses a sweep.

    Motions, pressures, models and drives are checked at the ends of all axes.  This function
    imports the solver.  The import takes half a second.

    names: names of the sweeps to check; the default is all sweeps.
    """
    sweeps = configuration.sweeps.items()
    chosen = {name: sweep for name, sweep in sweeps if names is None or name in names}
    _called(_refuse_corners, chosen, source)


def _refuse_corners(sweep: Sweep) -> None:
    from microslip.answer.limits import problem_of
    from microslip.answer.request import request_of

    ends = [dict.fromkeys((values[0], values[-1])) for values in sweep.axes.values()]
    for place in product(*ends):
        at: dict[str, Any] = dict(zip(sweep.axes, place, strict=True))
        drive = {name: at.pop(name) for name in sweep.drives}
        problem = problem_of(sweep.motion, pressure=sweep.pressure, drive=drive, **at)
        request_of(problem, model=sweep.model, tolerance=sweep.tolerance)


def _file_in(name: Any, role: str, folders: Iterable) -> named_files.NamedFile | None:
    """Return the path and the digest of the file to which the name of a motion or pressure refers.
    Return None if the name does not refer to a file.

    Raises InputError if the file is missing.
    """
    file = named_files.parse(name, role)
    if file is None or file.digest and file.path:  # an earlier call found the file
        named_files.remember([name])
        return file
    return named_files.read(file, role, folders)[0]


def _called(function: Callable[[Sweep], T], sweeps: dict[str, Sweep], source: str) -> dict[str, T]:
    """Return the result of a function for each sweep.  An InputError about an argument is replaced
    by a ConfigError about the key with the same name."""
    results = {}
    for name, sweep in sweeps.items():
        try:
            results[name] = function(sweep)
        except InputError as error:
            value = "missing;" if error.value is None else f"{shown(error.value)}:"
            line = f"{source}: sweeps.{name}.{error.argument}: {value} {error.allowed}"
            raise ConfigError(line) from None
    return results


def _line(error: ValidationError) -> str:
    """Return a message for the first error, with the key, the value, and the allowed values."""
    first = error.errors(include_url=False)[0]
    where = "".join(f".{key}" for key in first["loc"] if key != "[key]")
    refusal = first.get("ctx", {}).get("error")
    if isinstance(refusal, Refusal):
        return f"{where}{refusal.key}: {refusal}".removeprefix(".")
    allowed = "allowed: a mapping of names"
    return f"{where}: {problem_of(first['input'])}; {allowed}".removeprefix(".")
