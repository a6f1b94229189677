"""Names of motions and pressures: classes of the package, Python files and data files.

    bore, elliptic:phase=90          a class of the package, with the numbers of its fields
    mine/soft_square.py:share=0.5    the class in a Python file
    file:pad.csv,grid=samples        a data file, with options

A result depends on the content of a file, but not on the folder of the file.  Therefore, if a file
defines a motion or a pressure, the name of this motion or pressure contains a digest:
"soft_square.py:sha256=0123456789abcdef,share=0.5" or "file:sha256=0123456789abcdef,grid=samples".
The digest of a Python file also covers the files that this file imports from its folder.  Each
process has a table of paths, keyed by digest.  If a process receives paths from another process,
`remember` adds these paths to the table.

This module imports only fast modules, because each start of the workflow imports this module.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from microslip.foundation import spec
from microslip.foundation.csv_table import check_format
from microslip.foundation.errors import InputError, described, places_in
from microslip.foundation.files import MOST_BYTES, content_of

if TYPE_CHECKING:
    from microslip.foundation.source_digest import Sources

T = TypeVar("T")

PREFIX = "file:"
PYTHON = re.compile(r"(?:file:)?(.*\.py)(?::(.*))?", re.S)
GRID = "cells"
"""Default meaning of the values of a grid; see pressures.grid.READINGS."""
DIGITS = 16
"""Number of hexadecimal digits of a digest in a name."""
OPTIONS = re.compile(r"(?:^|,)(grid|pitch|sha256|decimal|encoding)=([^,]*)$")
DECIMALS = {"point": ".", "comma": ","}
"""Decimal marks, keyed by the words that represent them in names."""
HINT = (
    "grid=cells or grid=samples, and pitch=0.5 mm, for pressures; decimal=comma or encoding=cp1252"
)
PACKED = {b"\x1f\x8b": "gzip", b"PK\x03\x04": "zip, as spreadsheets are", b"BZh": "bzip2"}
PACKED[b"\xfd7zXZ"] = "xz"
"""Formats of compressed files, keyed by the first bytes of the file."""

PLACES: dict[str, Path] = {}
"""Paths of files, keyed by digest."""


@dataclass(frozen=True)
class NamedFile:
    """The parsed name of a file: path, digest and options.

    Attributes
    ----------
    text : str
        The name as the user wrote it.
    path : str
        Path in the name.  It is empty if the name contains only the digest.
    digest : str
        First DIGITS hexadecimal digits of the SHA-256 of the content.  It is empty if unknown.
    numbers : str
        Parameters of the class in a Python file, such as "share=0.5".
    grid, pitch : str
        Meaning of the values of a grid, and distance between the cells of a matrix; see
        pressures.grid_file.
    decimal, encoding : str
        Decimal mark (a key of DECIMALS) and encoding of a data file.
    """

    text: str = field(compare=False)
    path: str = field(compare=False)
    digest: str = ""
    numbers: str = ""
    grid: str = GRID
    pitch: str = ""
    decimal: str = "point"
    encoding: str = "utf-8"

    @property
    def is_code(self) -> bool:
        """True for a Python file."""
        return self.path.endswith(".py")

    @property
    def name(self) -> str:
        """Name under which results refer to the file.  This name does not contain the folder, so
        that files with equal content have equal names."""
        return self._text(os.path.basename(self.path) if self.is_code else "")

    @property
    def placed(self) -> str:
        """Name that contains the path and the digest.  Other processes use this name to read the
        file."""
        return self._text(self.path)

    def _text(self, path: str) -> str:
        options = ((one, getattr(self, one.name)) for one in fields(self)[4:])
        words = [f"{one.name}={value}" for one, value in options if value != one.default]
        words = [f"sha256={self.digest}", self.numbers, *words]
        words = words if self.is_code else [path, *words]
        return (f"{path}:" if self.is_code else PREFIX) + ",".join(filter(None, words))


def parse(name: object, argument: str = "file") -> NamedFile | None:
    """Parse the name of a data file or of a Python file.

    Returns None if the name does not refer to a data file or a Python file.  Raises InputError
    about the argument if options are invalid.
    """
    if not isinstance(name, str):
        return None
    if match := PYTHON.fullmatch(name):
        words = (match[2] or "").split(",")
        digests = [word for word in words if word.startswith("sha256=")]
        numbers = ",".join(word for word in words if word not in digests)
        return NamedFile(name, match[1], "".join(digests[:1]).removeprefix("sha256="), numbers)
    if not name.startswith(PREFIX):
        return None
    path, options = name.removeprefix(PREFIX), {}
    while match := OPTIONS.search(path):
        if match[1] in options:
            raise InputError(argument, name, f"{match[1]} occurs twice; allowed: once")
        options[match[1]], path = match[2], path[: match.start()]
    file = NamedFile(name, path, options.pop("sha256", ""), **options)
    if file.decimal not in DECIMALS:
        raise InputError(argument, name, "allowed for decimal is point or comma")
    if not (file.path or file.digest) or "\0" in path:
        allowed = "allowed is a file, as in file:measured.csv or file:measured.csv,decimal=comma"
        raise InputError(argument, name, allowed)
    return file


def read(
    file: NamedFile, argument: str, folders: Iterable[str | os.PathLike] = ()
) -> tuple[NamedFile, bytes]:
    """Read a file.  The first result is a copy of `file` with the absolute path and the digest.
    The second result is the content of the file.

    Parameters
    ----------
    file : NamedFile
        If it contains a digest, the content must have this digest.
    argument : str
        Name of the argument, for messages.
    folders : iterable of paths
        Folders that are searched for a file with a relative path.  The working directory is
        searched last.

    Raises
    ------
    InputError
        If the file does not exist, or has another digest.  The message lists the paths that were
        tried.
    """
    place = PLACES.get(file.digest) if not os.path.isabs(file.path) else None
    if not (place or file.path):
        problem = "no file with this content is known here; allowed is its path"
        raise InputError(argument, file.text, f"{problem}, as in file:measured.csv")
    here = Path.cwd()
    # an absolute path is the same in every folder
    places = list(dict.fromkeys(Path(here, folder, file.path) for folder in (*folders, here)))
    place = place or next(filter(os.path.lexists, places), None)
    if place is None:
        looked = f"No such file; looked for {', '.join(map(str, places))}"
        hint = f"; allowed after the path: {HINT}" if "," in file.path else ""
        raise InputError(argument, file.text, f"{file.path} cannot be read: {looked}{hint}")
    try:
        if not place.is_file():  # a pipe might never end
            raise ValueError("a folder" if place.is_dir() else "not a regular file")
        content = content_of(place, MOST_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(argument, file.text, f"{place} cannot be read: {reason}") from None
    digest = hashlib.sha256(content).hexdigest()
    if place.suffix == ".py":
        sources, names = _imports_of(place)
        digest = sources.digest(names)
    digest = digest[:DIGITS]
    if file.digest not in ("", digest):
        problem = f"{place} has changed: its sha256 begins with {digest}"
        raise InputError(argument, file.text, problem)
    PLACES[digest] = place
    return replace(file, path=str(place), digest=digest), content


def remember(names: Iterable[str]) -> None:
    """If a name contains a path and a digest, store the path under the digest.  Other names are
    ignored."""
    for file in filter(None, map(parse, names)):
        if file.digest and os.path.isabs(file.path):
            PLACES[file.digest] = Path(file.path)


def problem_in_code(error: BaseException) -> str:
    """Describe an error in one line if the traceback of the error contains a user's Python file.
    Otherwise, return ""."""
    for path in PLACES.values():
        if path.suffix == ".py" and places_in(error, path):
            return f"{path}: {described(error, path)}"
    return ""


def base_name(name: str) -> str:
    """Return the base name of a file for messages, or "" if this process has not stored the
    path."""
    file = parse(name)
    return Path(file.path or PLACES.get(file.digest, "")).name if file else ""


def read_object(named: NamedFile, argument: str, create: Callable[[NamedFile, bytes], T]) -> T:
    """Read an object from a data file.

    Parameters
    ----------
    named, argument : NamedFile, str
        The file, and the name of the argument for messages.
    create : callable
        create(file, content) returns the object.  It raises ValueError for content in another
        format.

    Raises
    ------
    InputError
        If the file does not exist, has another format, or does not match the digest in the name.
    """
    file, content = read(named, argument)
    try:
        for kind in (kind for first, kind in PACKED.items() if content.startswith(first)):
            raise ValueError(f"packed ({kind}); allowed: CSV or netCDF as it is")
        check_format(DECIMALS[file.decimal], file.encoding)
        return create(file, content)
    except ValueError as error:
        problem = str(error).replace("decimal = ','", "decimal=comma after the path")
        raise InputError(argument, file.text, f"{file.path}: {problem}") from None


# Python files


def _imports_of(path: Path) -> tuple[Sources, set[str]]:
    """Return two values: the `Sources` of the folder that contains a file, and a set of names.  The
    set contains the name of the file, and the names of the files in this folder that the file
    imports."""
    from microslip.foundation.source_digest import Sources  # late, since it imports ast

    sources = Sources(path.parent, "")
    return sources, sources.closure([path.name])


def _run(path: Path, name: str) -> ModuleType:
    """Run a Python file as a module with the given name.  The file can import the files beside it.

    Afterwards, sys.modules contains the previous modules and this module.  Modules that were
    imported from the folder of the file are removed.  Otherwise, a module of the same name in
    another folder would not be imported, and an edited module would not be imported again.
    """
    module = sys.modules[name] = ModuleType(name)
    module.__file__ = str(path)
    beside = {name.partition("/")[0].removesuffix(".py") for name in _imports_of(path)[1]}

    def pop() -> dict[str, ModuleType]:
        names = [name for name in sys.modules if name.partition(".")[0] in beside]
        return {name: sys.modules.pop(name) for name in names}

    others, writes = pop(), sys.dont_write_bytecode
    sys.path.insert(0, str(path.parent))
    sys.dont_write_bytecode = True
    importlib.invalidate_caches()
    try:
        exec(compile(path.read_bytes(), path, "exec"), module.__dict__)
    finally:
        sys.path.remove(str(path.parent))
        sys.dont_write_bytecode = writes
        pop()
        sys.modules.update(others)
    return module


@lru_cache(maxsize=32)
def _class_in(file: NamedFile, base: type) -> type:
    """Return the subclass of `base` in a Python file.  Raises ImportError unless the file contains
    exactly one such class."""
    path = Path(file.path)
    name = f"microslip_{file.digest}_{path.stem}"
    try:
        module = _run(path, name)
    except (Exception, SystemExit) as error:  # a user's code may raise anything
        raise ImportError(f"cannot be imported: {described(error, path)}") from error
    own: list[Any] = [one for one in vars(module).values() if isinstance(one, type)]
    own = [one for one in own if issubclass(one, base) and one.__module__ == name]
    last = [one for one in own if not any(one in other.__mro__[1:] for other in own)]
    if len(last) != 1:
        names = f": {', '.join(one.__name__ for one in last)}" if last else ""
        problem = f"it has {len(last)} subclasses of microslip.{base.__name__}{names}"
        raise ImportError(f"{problem}; allowed is one in a file")
    last[0].text_name = file.name
    return last[0]


# Both, and the classes of the package


class Family(Generic[T]):
    """Callable that returns the motion or the pressure with a given name.

    The objects that were read most recently from data files are stored, so that files with equal
    content share one object.

    Parameters
    ----------
    argument : str
        Name of the argument in messages.
    base : type
        Base class.
    classes : iterable of types
        Classes of the package, in the order of the lists in messages.
    create : callable
        create(file, content) returns the object for a data file; see read_object.

    Attributes
    ----------
    classes : dict of str to type
        Classes of the package, keyed by name.
    """

    def __init__(
        self,
        argument: str,
        base: type,
        classes: Iterable[type[T]],
        create: Callable[[NamedFile, bytes], T],
    ):
        self.argument, self.base, self.create = argument, base, lru_cache(8)(create)
        self.classes = {spec.name_of(one): one for one in classes}
        self._last: dict[str, T] = {}

    def __call__(self, text: str | T) -> T:
        """Return the object for a name such as "power:exponent=1" or "file:measured.csv".  An
        object of the base class is returned unchanged.

        Raises
        ------
        InputError
            If the name is unknown, if its file cannot be used, or if the class does not have a
            parameter or refuses its value.
        """
        if isinstance(text, self.base):
            return cast(T, text)
        if isinstance(text, str) and text in self._last:
            return self._last[text]
        named, path = parse(text, self.argument), ""
        if named is not None and not named.is_code:
            return read_object(named, self.argument, self.create)
        names = [*self.classes, "file:NAME", "NAME.py"]
        if not isinstance(text, str) or text == "file":
            allowed = f"allowed is one of {', '.join(names)}, or an object of {self.base.__name__}"
            raise InputError(self.argument, text, allowed)
        if named is None:
            if "." in text.partition(":")[0]:  # to suggest the prefix
                names[-2] = f"file:{text}"
            name, words = spec.split(text, self.argument, names)
            cls: Any = self.classes[name]
        else:
            file, _ = read(named, self.argument)
            path, name, words = file.path, Path(file.path).name, file.numbers or None
            try:
                cls = _class_in(replace(file, numbers=""), self.base)
            except ImportError as error:
                raise InputError(self.argument, text, f"{path}: {error}") from error
        parameters = [one.name for one in fields(cls)]
        numbers = spec.numbers_in(words, text, self.argument, name, parameters)
        try:
            shared = _shared_object(cls, *sorted(numbers.items()))
        except InputError as error:  # its text omits default values
            raise InputError(self.argument, text, error.allowed) from None
        except (Exception, SystemExit) as error:  # in a user's file
            raise InputError(self.argument, text, f"{path}: {described(error, path)}") from error
        if named is None:  # files can change
            self._last = {text: shared}
        return shared


@lru_cache(maxsize=128)
def _shared_object(cls: Callable[..., T], *numbers: tuple[str, float]) -> T:
    """Return the object of a class with the given parameters.  Calls with equal parameters share
    one object, including its cached properties."""
    return cls(**dict(numbers))
