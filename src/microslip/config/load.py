"""Read a YAML file and convert it to the checked records of a configuration.

`settings` contains the types, ranges and defaults of all keys.  This module checks combinations of
keys and expands axes.
"""

import codecs
import io
import math
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml

from microslip.config import certified, extended, schema
from microslip.config.axes import DRIVES, MOST_POINTS, refuse_crowd
from microslip.config.records import (
    CERTIFIED,
    MODELS_OF_MOTION,
    MOTION_OF_SWEEP,
    RESERVED,
    ConfigError,
    Configuration,
    Refusal,
    Sweep,
)
from microslip.config.settings import Root, SteadySweep
from microslip.config.strict_yaml import StrictLoader
from microslip.foundation import named_files
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import NamedFile

MOST_BYTES = 1_000_000
"""Largest size of a configuration in bytes.  PyYAML reads about 100 kB per second."""
MOST_PANELS, MOST_LINES = 12, 8
"""Largest number of sweeps in a figure of maps, and in a figure of lines.  A sweep counts once for
each Poisson's ratio."""


# Files


def load(path: str | os.PathLike) -> Configuration:
    """Read and check a YAML file; return a Configuration or raise ConfigError.

    Motion and pressure files are searched for in the folder of the YAML file, then in the working
    directory.
    """
    return from_mapping(read_yaml(path), source=str(path), folders=[Path(path).parent])


def read_yaml(path: str | os.PathLike) -> dict:
    """Parse a YAML file into a dict.

    Raises ConfigError if the file cannot be read, if the YAML is invalid, or if a key occurs
    twice.  The message is one line with the file and the line number.
    """
    if "\0" in str(path):
        raise ConfigError(f"{str(path)!r}: cannot be read: not the name of a file")
    try:
        content = named_files.content_of(path, MOST_BYTES)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
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
        raise ConfigError(f"{path}: not valid YAML: {error}{hint}") from None
    if mapping is None:
        raise ConfigError(f"{path}: is empty; allowed: keys and values, sweeps at least")
    if not isinstance(mapping, dict):
        message = f"{schema.short_json(mapping)} is not a mapping; allowed: keys and values"
        raise ConfigError(f"{path}: {message}")
    return mapping


def _as_text(content: bytes, path: str | os.PathLike) -> io.StringIO:
    """Decode a file to a text stream; raises ConfigError if it is not UTF-8."""
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
    text.name = str(path)  # for messages of the parser
    return text


# Settings


def with_defaults_and_paths(
    mapping: dict, source: str = "configuration", folders: Iterable = ()
) -> dict:
    """Fill in the defaults and the file paths of a parsed configuration.

    A job can use the result in any working directory.

    Parameters
    ----------
    mapping, source, folders
        As for `from_mapping`.

    Raises
    ------
    ConfigError
    """
    filled = _settings(mapping, source).model_dump(warnings=False)
    for key, entries in entries_with_files(filled).items():
        for name, entry in entries.items():
            with _errors_at(f"{source}: {key}.{name}"):
                for role in filter(entry.__contains__, ROLES):
                    if file := _file_in(entry[role], role, folders, strict=True):
                        entry[role] = file.placed
    return filled


ROLES = ("motion", "pressure")
"""Keys whose values can name files."""


def entries_with_files(filled: dict) -> dict[str, dict[str, dict]]:
    """Return all entries that can name files, as key -> name -> entry.

    filled: configuration with all defaults.
    """
    return {key: filled[key] for key in ("extended", "drives")}


def remember_files(filled: dict) -> None:
    """Store the paths of all files named in a configuration from `with_defaults_and_paths`.

    A request identifies a file by its content.
    """
    entries = [one for place in entries_with_files(filled).values() for one in place.values()]
    named_files.remember(entry[role] for entry in entries for role in ROLES if role in entry)


def _settings(mapping: dict, source: str) -> Root:
    from pydantic import ValidationError

    try:
        return Root.model_validate(mapping)
    except ValidationError as error:
        line = schema.error_line(error.errors(include_url=False))
        raise ConfigError(f"{source}: {line}") from None


def _file_in(name: str, role: str, folders: Iterable, strict: bool) -> NamedFile | None:
    """Return the file in the name of a motion or a pressure, with its path and digest.

    Returns None for a name without a file.  For a missing file, raises InputError if `strict` is
    True, and otherwise returns None.
    """
    if not named_files.speaks_of_file(name):
        return None
    try:
        file = named_files.parse(name, role)
        if not (file.digest and file.path):
            return named_files.read(name, role, folders)[0]
        named_files.remember([name])  # an earlier call found the file
        return file
    except InputError:
        if strict:
            raise
        return None


@contextmanager
def _errors_at(where: str) -> Iterator[None]:
    """Context manager that converts errors to ConfigError.  The message begins with `where`."""
    try:
        yield
    except ConfigError:
        raise
    except Refusal as error:
        key = f".{error.key}" if error.key else ""
        raise ConfigError(f"{where}{key}: {error}") from None
    except InputError as error:  # solver arguments and keys have the same names
        line = f"{where}.{error.argument}: {error.value!r}: {error.allowed}"
        raise ConfigError(line) from None
    except ValueError as error:  # from readers of files
        raise ConfigError(f"{where}: {error}") from None


def from_mapping(
    mapping: dict, source: str = "configuration", ask_solver: bool = True, folders: Iterable = ()
) -> Configuration:
    """Check a parsed configuration and return it as a Configuration.

    Parameters
    ----------
    mapping : dict
        Parsed YAML.
    source : str
        Name of the configuration in messages, usually the file.
    ask_solver : bool
        True to check motions, pressures and drives with the solver, and to refuse missing files.
        Importing the solver takes half a second.  The result does not depend on this argument.
    folders : iterable of paths
        Folders in which motion and pressure files are searched for, before the working directory.

    Raises
    ------
    ConfigError
        If the configuration is invalid.  The message is one line with the source, the key, the
        value and the allowed values.
    """
    settings = _settings(mapping, source)
    entries: dict[str, SteadySweep] = {}
    families: dict[str, dict[str, Sweep]] = {}
    maps = {}
    for family in ("sweeps", "extended", "drives"):
        members = getattr(settings, family)
        order = MOTION_OF_SWEEP if family == "sweeps" else members
        families[family] = {}
        for name in (name for name in order if name in members):
            with _errors_at(f"{source}: {family}.{name}"):
                if family != "sweeps":
                    _refuse_taken(name, {*entries} | ({*members} - {name}))
                sweep = _sweep(name, members[name], folders, ask_solver)
                families[family][name] = sweep
                if ask_solver and family != "sweeps":
                    extended.refuse_unsolvable(sweep)
                if (adaptive := getattr(members[name], "adaptive", None)) is not None:
                    map_ = certified.map_of(sweep, adaptive)
                    maps[map_.name] = map_
        entries |= members
    with _errors_at(f"{source}: extended"):
        _refuse_mixtures(list(families["extended"].values()))
    return Configuration(
        results=settings.results,
        **families,
        points_per_job={
            name: sweep.points_per_job or settings.points_per_job for name, sweep in entries.items()
        },
        histories={name: dict(run) for name, run in settings.histories},
        accuracy=settings.accuracy,
        stability=settings.stability,
        claims=settings.claims,
        certified=maps,
    )


# Sweeps


def _sweep(name: str, entry: Any, folders: Iterable, strict: bool) -> Sweep:
    """Convert the settings of a sweep to a Sweep.  Raises Refusal for combinations that are not
    allowed."""
    drives = tuple(
        (drive, tuple(axis), isinstance(axis.raw, list | dict))
        for drive in DRIVES
        if (axis := getattr(entry, drive, None)) is not None
    )
    of_paper, amplitude = name in MOTION_OF_SWEEP, getattr(entry, "amplitude", None)
    more: dict[str, Any] = {"motion": MOTION_OF_SWEEP.get(name)}
    if not of_paper:
        if not drives and not hasattr(entry, "group"):
            raise Refusal("missing; required: force or stiffness")
        names = {role: _by_content(getattr(entry, role), role, folders, strict) for role in ROLES}
        more = {"title": entry.title or name, "drives": drives} | names
        more |= {"group": entry.group} if hasattr(entry, "group") else {}
    sweep = Sweep(
        name=name,
        velocity=tuple(entry.velocity or ()),
        amplitude=None if amplitude is None else tuple(amplitude),
        poisson=tuple(entry.poisson),
        poisson_is_axis=isinstance(entry.poisson.raw, list),
        model=entry.model,
        tolerance=None if entry.tolerance is None else float(number(entry.tolerance)),
        cells=entry.cells,
        steps=entry.steps,
        **more,
    )
    axes = [sweep.velocity or (None,), sweep.amplitude or (None,), sweep.poisson]
    refuse_crowd(math.prod(map(len, axes + [values for _, values, _ in drives])), MOST_POINTS)
    models = MODELS_OF_MOTION[sweep.motion] if of_paper else (sweep.model,)
    if sweep.model not in models:
        message = f'"{sweep.model}" does not apply to {sweep.motion}; allowed: {", ".join(models)}'
        raise Refusal(message, "model")
    if of_paper and sweep.model == "radial" and sweep.poisson[-1] > 0:
        message = f"{sweep.poisson[-1]:g} does not go with model radial; allowed: 0"
        raise Refusal(message, "poisson")
    return sweep


def _refuse_taken(name: str, others: Iterable[str]) -> None:
    """Raise Refusal if a sweep has the name of another result."""
    if name in RESERVED or name in others or name.removeprefix(CERTIFIED) in others:
        raise Refusal("another result has this name; allowed: a new one")


def _by_content(name: str, role: str, folders: Iterable, strict: bool) -> str:
    """Name of a motion or a pressure.  The path of a file in the name is replaced by the file's
    digest."""
    file = _file_in(name, role, folders, strict)
    return name if file is None else file.name


def _refuse_mixtures(sweeps: list[Sweep]) -> None:
    """Raise Refusal for a group of sweeps that does not fit in one figure."""
    for group in dict.fromkeys(sweep.group for sweep in sweeps):
        together = [sweep for sweep in sweeps if sweep.group == group]
        first, last = together[0], together[-1]
        for sweep in together:
            if sweep.drawn_over != first.drawn_over:
                raise Refusal(
                    f"{group} is drawn over {first.drawn_over} for {first.name}, and this sweep "
                    f"over {sweep.drawn_over}; allowed: another group",
                    f"{sweep.name}.group",
                )
        most = MOST_PANELS if first.spans_a_map else MOST_LINES
        drawn = sum(len(sweep.poisson) for sweep in together)
        if drawn > most:
            ratios = " at their Poisson's ratios" if drawn > len(together) else ""
            raise Refusal(
                f"{group} has {drawn} sweeps{ratios}; allowed: up to {most}, or another group",
                f"{last.name}.group",
            )
