"""The configuration of sweeps and studies: read YAML, check it, fill in defaults, expand the axes.

The JSON schema in config.schema.yaml holds the shape, the ranges, the defaults and a description of
every key. What it cannot say is checked here: duplicates, and settings that do not go together.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

import codecs
import io
import os
from collections.abc import Iterable
from pathlib import Path

import yaml

from microslip.config import axes as grids
from microslip.config import certified, extended, propulsion, schema
from microslip.config.axes import axis_of, refuse_crowd
from microslip.config.records import (
    MOTION_OF_SWEEP,
    Accuracy,
    Claims,
    ConfigError,
    Configuration,
    Stability,
    StudyPoint,
)
from microslip.config.strict_yaml import StrictLoader
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError
from microslip.foundation.user_files import content_of
from microslip.solver import method_names

# The points of a study's map are computed by every model, at every tolerance.
MOST_MAP_POINTS = 10_000

# Bytes of a configuration; that of the paper has 18 kB, and PyYAML reads about 100 kB a second.
MOST_BYTES = 1_000_000

# Up to these amplitudes there is static friction to be judged, by the maps of the paper.
STATIC_AMPLITUDES = {"transverse": 1.0, "bore": 5.0}


def load(path: str | os.PathLike) -> Configuration:
    """Read and check the YAML file `path`; return a Configuration or raise ConfigError.

    Files that it names are looked for beside it, then in the working directory.
    """
    return from_mapping(read_yaml(path), source=str(path), folders=[Path(path).parent])


def read_yaml(path: str | os.PathLike) -> dict:
    """Parse a YAML file into a dict, refusing keys that occur twice.

    Raises ConfigError, one line with the file, and the line in it that is at fault.
    """
    if "\0" in str(path):
        raise ConfigError(f"{str(path)!r}: cannot be read: no name of a file")
    try:
        content = content_of(path, MOST_BYTES)
    except OSError as error:
        raise ConfigError(_one_line(f"{path}: cannot be read: {error.strerror}")) from None
    except ValueError as error:
        raise ConfigError(f"{path}: {error}") from None
    try:
        mapping = yaml.load(_as_text(content, path), StrictLoader)
    except RecursionError:
        raise ConfigError(f"{path}: not valid YAML: too many levels") from None
    except yaml.reader.ReaderError as error:
        line = content.decode(errors="replace")[: error.position].count("\n") + 1
        raise ConfigError(
            f"{path}: not valid YAML: line {line}: the character {chr(error.character)!a} is not "
            "allowed; allowed: text"
        ) from None
    except yaml.YAMLError as error:
        hint = "; allowed: spaces, no tabs" if "'\\t'" in str(error) else ""
        raise ConfigError(f"{path}: not valid YAML: {_one_line(error)}{hint}") from None
    if mapping is None:
        raise ConfigError(f"{path}: is empty; allowed: keys and values, sweeps at least")
    if not isinstance(mapping, dict):
        raise ConfigError(
            f"{path}: {schema.shown(mapping)} is not a mapping; allowed: keys and values"
        )
    return mapping


def with_files_found(
    mapping: dict, source: str = "configuration", folders: Iterable = (), strict: bool = True
) -> dict:
    """A parsed configuration, its defaults filled in, that says where the files lie that it names.

    A job that is handed it finds them wherever it runs.  Arguments as for `from_mapping`; strict:
    whether a file that is not there is refused.  Raises ConfigError.
    """
    filled = schema.filled(mapping)
    where = f"{source}: extended"
    found = extended.with_files_found(filled["extended"], where, folders, strict)
    pulled = extended.with_files_found(filled["drives"], f"{source}: drives", folders, strict)
    return filled | {"extended": found, "drives": pulled}


def _as_text(content: bytes, path: str | os.PathLike) -> io.StringIO:
    """Bytes as a stream that knows its name; raises ConfigError for what is not UTF-8."""
    try:
        text = io.StringIO(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        utf_16 = content[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)
        hint = ", and this seems to be UTF-16" if utf_16 else ""
        byte = content[error.start]
        raise ConfigError(
            f"{path}: line {line}: not text: byte 0x{byte:02x}; allowed: UTF-8{hint}"
        ) from None
    text.name = str(path)  # what the parser calls it
    return text


def from_mapping(
    mapping: dict, source: str = "configuration", ask_solver: bool = True, folders: Iterable = ()
) -> Configuration:
    """Check a parsed configuration and return it as a Configuration.

    source: how messages name the origin, usually the file. ask_solver: whether the solver, which
    takes some half a second to import, is to say if it knows what `extended` names, and whether
    files have to be there; nothing else in what is returned depends on it. folders: where files
    that it names are looked for, before the working directory. Raises ConfigError.
    """
    try:
        problem = schema.problem(mapping)
    except RecursionError:
        problem = "not valid YAML: a key that holds itself"
    if problem is not None:
        raise ConfigError(f"{source}: {_one_line(problem)}")
    filled = with_files_found(mapping, source, folders, strict=ask_solver)
    sweeps = {
        name: grids.of_paper(name, filled["sweeps"][name], f"{source}: sweeps.{name}")
        for name in MOTION_OF_SWEEP
        if name in filled["sweeps"]
    }
    others = extended.sweeps(filled["extended"], f"{source}: extended")
    pulled = extended.pulled_sweeps(filled["drives"], f"{source}: drives", others)
    if ask_solver:
        extended.refuse_unsolvable(list(others.values()), f"{source}: extended")
        extended.refuse_unsolvable(list(pulled.values()), f"{source}: drives")
    extended.refuse_mixtures(list(others.values()), f"{source}: extended")
    drifting = certified.maps(pulled, filled["drives"], f"{source}: drives")
    if ask_solver and drifting:
        certified.refuse_unsolvable(drifting, f"{source}: drives")
    given = filled["sweeps"] | filled["extended"] | filled["drives"]
    return Configuration(
        results=filled["results"],
        points_per_job={
            name: given[name]["points_per_job"] or filled["points_per_job"]
            for name in (*sweeps, *others, *pulled)
        },
        sweeps=sweeps,
        extended=others,
        drives=pulled,
        histories=filled["histories"],
        accuracy=_accuracy(filled["accuracy"], f"{source}: accuracy"),
        stability=_stability(filled["stability"], f"{source}: stability"),
        claims=_claims(filled["claims"], f"{source}: claims"),
        propulsion=propulsion.study(filled["propulsion"], f"{source}: propulsion", ask_solver),
        certified=certified.maps(sweeps, filled["sweeps"], f"{source}: sweeps")
        | certified.maps(others, filled["extended"], f"{source}: extended")
        | drifting,
    )


# From settings to studies


def _accuracy(given: dict, where: str) -> Accuracy:
    grid = given["map"]
    axes = {
        name: axis_of(grid[name], f"{where}.map.{name}", positive=True)
        for name in ("velocity", "amplitude_transverse", "amplitude_bore", "tolerance")
    }
    for name, values in axes.items():
        if len(values) < 2 and name != "tolerance":
            raise ConfigError(
                f"{where}.map.{name}: {list(values)} is not allowed; allowed: two numbers or more"
            )
    for name in ("amplitude_transverse", "amplitude_bore"):
        count = len(axes["velocity"]) * len(axes[name])
        refuse_crowd(count, f"{where}.map.velocity x {name}", MOST_MAP_POINTS)
    points = [_study_point(name, p, f"{where}.points") for name, p in given["points"].items()]
    return Accuracy(
        methods=_methods(given["methods"], where),
        points={point.name: point for point in points},
        levels=given["levels"],
        repeats=given["repeats"],
        map_velocity=axes["velocity"],
        map_amplitude={s: axes[f"amplitude_{s}"] for s in ("transverse", "bore")},
        map_tolerance=axes["tolerance"][::-1],
    )


def _stability(given: dict, where: str) -> Stability:
    axes = given["axes"]
    return Stability(
        methods=_methods(given["methods"], where),
        tolerance=float(number(given["tolerance"])),
        axes=None if axes is None else tuple(_once(axes, f"{where}.axes")),
    )


def _claims(given: dict, where: str) -> Claims:
    names = ("velocity", "amplitude_transverse", "amplitude_bore")
    axes = {name: axis_of(given[name], f"{where}.{name}", positive=True) for name in names}
    for name in names[1:]:
        count = len(axes["velocity"]) * len(axes[name])
        refuse_crowd(count, f"{where}.velocity x {name}", MOST_MAP_POINTS)
    amplitude = {s: axes[f"amplitude_{s}"] for s in ("transverse", "bore")}
    for motion, values in amplitude.items():
        if values[0] > STATIC_AMPLITUDES[motion]:
            raise ConfigError(
                f"{where}.amplitude_{motion}: {list(values)} is not allowed; allowed: at least one "
                f"number up to {STATIC_AMPLITUDES[motion]:g}, where there is static friction"
            )
    return Claims(
        tolerance=float(number(given["tolerance"])),
        velocity=axes["velocity"],
        amplitude=amplitude,
        cells=given["cells"],
    )


def _study_point(name: str, given: dict, where: str) -> StudyPoint:
    where = f"{where}.{name}.amplitude"
    steady, amplitude = given["motion"] == "continuous-bore", given["amplitude"]
    if steady and amplitude is not None:
        raise ConfigError(
            f"{where}: {amplitude} is not allowed; {given['motion']} has no amplitude"
        )
    if not steady and amplitude is None:
        raise ConfigError(f"{where}: missing; required for {given['motion']}")
    return StudyPoint(
        name=str(name),
        motion=given["motion"],
        velocity=float(number(given["velocity"])),
        amplitude=None if steady else float(number(amplitude)),
        poisson=float(number(given["poisson"])),
        title=given["title"] or str(name),
    )


def _methods(given: list[str] | None, where: str) -> tuple[str, ...]:
    if given is None:
        return method_names.names()
    for i, text in enumerate(_once(given, f"{where}.methods")):
        try:
            method_names.check(text)
        except InputError as error:
            raise ConfigError(f"{where}.methods[{i}]: {error.value!r}: {error.allowed}") from None
    return tuple(given)


def _once(values: list[str], where: str) -> list[str]:
    twice = next((value for i, value in enumerate(values) if value in values[:i]), None)
    if twice is not None:
        raise ConfigError(f"{where}: {twice} occurs twice; allowed: different values")
    return values


def _one_line(text: object) -> str:
    return " ".join(str(text).split())
