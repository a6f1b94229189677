"""Texts that name motions and pressures, and files with data or classes.

    bore, elliptic:phase=90          a class of the package, with the numbers of its fields
    mine/soft_square.py:share=0.5    the class in a Python file
    file:pad.csv,grid=samples        a data file, with options

A result depends on the content of a file and not on its folder.  So the name of a motion or a
pressure contains a digest: "soft_square.py:sha256=0123456789abcdef,share=0.5" or
"file:sha256=0123456789abcdef,grid=samples".  The digest of a Python file covers the files that it
imports from its folder.  A process stores the path for each digest.  `remember` stores paths from
another process.

The module imports nothing slow, because each start of the workflow imports the module.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Generic, TypeGuard, TypeVar, cast

from microslip.foundation import spec
from microslip.foundation.csv_table import check_format
from microslip.foundation.errors import InputError, described
from microslip.foundation.files import MOST_BYTES, content_of

if TYPE_CHECKING:
    from microslip.foundation.source_digest import Sources

T = TypeVar("T")

PREFIX = "file:"
PYTHON = re.compile(r"(?:file:)?(.*\.py)(?::(.*))?", re.S)
GRID = "cells"
"""Default meaning of the values of a grid, see pressures.grid.READINGS."""
DIGITS = 16
"""Number of hexadecimal digits of a digest in a name."""
OPTIONS = re.compile(r"(?:^|,)(grid|pitch|sha256|decimal|encoding)=([^,]*)$")
DECIMALS = {"point": ".", "comma": ","}
"""Decimal marks, by the words that represent them in names."""
EXAMPLE = "a file, as in file:measured.csv or file:measured.csv,decimal=comma"
HINT = (
    "grid=cells or grid=samples, and pitch=0.5 mm, for pressures; decimal=comma or encoding=cp1252"
)
PACKED = {b"\x1f\x8b": "gzip", b"PK\x03\x04": "zip, as spreadsheets are", b"BZh": "bzip2"}
PACKED[b"\xfd7zXZ"] = "xz"
"""First bytes of a compressed file -> its format."""
LARGEST_CACHE = 8
"""Number of objects that a FileReader keeps."""

PLACES: dict[str, Path] = {}
"""Paths of files by digest."""


@dataclass(frozen=True)
class NamedFile:
    """The parsed name of a file: path, digest and options.

    Attributes
    ----------
    path : str
        Path in the name.  It is empty if the name contains only the digest.
    digest : str
        First DIGITS hexadecimal digits of the SHA-256 of the content.  It is empty if unknown.
    numbers : str
        Numbers for the class in a Python file, such as "share=0.5".
    grid, pitch : str
        Meaning of the values of a grid, and distance between the cells of a matrix; see
        pressures.grid_file.
    decimal, encoding : str
        Decimal mark (a key of DECIMALS) and encoding of a data file.
    """

    path: str = field(compare=False)
    digest: str = ""
    numbers: str = ""
    grid: str = GRID
    pitch: str = ""
    decimal: str = "point"
    encoding: str = "utf-8"

    @property
    def name(self) -> str:
        """The name in results.  It does not contain the folder, so that files with equal content
        have equal names."""
        return self._text(os.path.basename(self.path) if self.path.endswith(".py") else "")

    @property
    def placed(self) -> str:
        """The name with the path and the digest, for another process that reads the file."""
        return self._text(self.path)

    def _text(self, path: str) -> str:
        sha256 = f"sha256={self.digest}"
        if self.path.endswith(".py"):
            return f"{path}:{','.join(filter(None, [sha256, self.numbers]))}"
        options = {one.name: (one.default, getattr(self, one.name)) for one in fields(self)[3:]}
        words = [f"{name}={value}" for name, (usual, value) in options.items() if value != usual]
        return PREFIX + ",".join(filter(None, [path, sha256, *words]))


def speaks_of_file(name: object) -> TypeGuard[str]:
    """True if the name of a pressure or a motion is the name of a data file."""
    return isinstance(name, str) and name.startswith(PREFIX) and not speaks_of_module(name)


def speaks_of_module(name: object) -> TypeGuard[str]:
    """True if the name of a pressure or a motion is the name of a Python file."""
    return isinstance(name, str) and PYTHON.fullmatch(name) is not None


def parse(name: str, argument: str = "file") -> NamedFile:
    """Parse the name of a file.  Raises InputError about the argument if the name has another
    form."""
    if match := PYTHON.fullmatch(name):
        words = (match[2] or "").split(",")
        digests = [word for word in words if word.startswith("sha256=")]
        numbers = ",".join(word for word in words if word not in digests)
        return NamedFile(match[1], "".join(digests[:1]).removeprefix("sha256="), numbers)
    path, options = name.removeprefix(PREFIX), {}
    while match := OPTIONS.search(path):
        if match[1] in options:
            raise InputError(argument, name, f"{match[1]} occurs twice; allowed: once")
        options[match[1]], path = match[2], path[: match.start()]
    file = NamedFile(path, options.pop("sha256", ""), **options)
    if file.decimal not in DECIMALS:
        raise InputError(argument, name, "allowed for decimal is point or comma")
    if not (file.path or file.digest) or "\0" in path:
        raise InputError(argument, name, f"allowed is {EXAMPLE}")
    return file


def read(
    name: str, argument: str, folders: Iterable[str | os.PathLike] = ()
) -> tuple[NamedFile, bytes]:
    """Read the file with this name.  Returns two values: the NamedFile, which contains the absolute
    path and the digest, and the content.

    Parameters
    ----------
    name : str
        Name such as "file:pad.csv".  If it contains a digest, the file must have this digest.
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
    file = parse(name, argument)
    place = PLACES.get(file.digest) if not os.path.isabs(file.path) else None
    place = place or _found(name, argument, file, folders)
    try:
        if not place.is_file():  # a pipe might never end
            raise ValueError("a folder" if place.is_dir() else "not a regular file")
        content = content_of(place, MOST_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(argument, name, f"{place} cannot be read: {reason}") from None
    digest = hashlib.sha256(content).hexdigest()
    if place.suffix == ".py":
        sources, names = _imports_of(place)
        digest = sources.digest(names)
    digest = digest[:DIGITS]
    if file.digest not in ("", digest):
        raise InputError(argument, name, f"{place} has changed: its sha256 begins with {digest}")
    PLACES[digest] = place
    return replace(file, path=str(place), digest=digest), content


def _found(name: str, argument: str, file: NamedFile, folders: Iterable[str | os.PathLike]) -> Path:
    """Path of a file in the folders or in the working directory."""
    if not file.path:
        problem = "no file with this content is known here; allowed is its path"
        raise InputError(argument, name, f"{problem}, as in file:measured.csv")
    here = Path.cwd()
    # an absolute path is the same in every folder
    places = list(dict.fromkeys(Path(here, folder, file.path) for folder in (*folders, here)))
    for place in places:
        with suppress(OSError, ValueError):  # a name that the system does not accept
            if os.path.lexists(place):
                return place
    problem = f"{file.path} cannot be read: No such file; looked for {', '.join(map(str, places))}"
    hint = f"; allowed after the path: {HINT}" if "," in file.path else ""
    raise InputError(argument, name, f"{problem}{hint}")


def _files_in(names: Iterable[str]) -> Iterator[NamedFile]:
    """The names of files among texts."""
    return (parse(name) for name in names if speaks_of_file(name) or speaks_of_module(name))


def remember(names: Iterable[str]) -> None:
    """Store the file paths from names that contain a path and a digest.  Other names are
    ignored."""
    files = (file for file in _files_in(names) if file.digest and os.path.isabs(file.path))
    PLACES.update((file.digest, Path(file.path)) for file in files)


def base_name(name: str) -> str:
    """Base name of a file, for messages; "" if this process has not stored the path."""
    return "".join(Path(f.path or PLACES.get(f.digest, "")).name for f in _files_in([name]))


# Data files


class FileReader(Generic[T]):
    """Reads objects from data files by name.  The most recent objects are stored, so that files
    with equal content share one object.

    Parameters
    ----------
    argument : str
        Name of the argument, for messages.
    create : callable
        create(file, content) -> object.  Raises ValueError for content in another format.
    """

    def __init__(self, argument: str, create: Callable[[NamedFile, bytes], T]):
        self.argument, self.create = argument, lru_cache(LARGEST_CACHE)(create)

    def __call__(self, name: str) -> T:
        """Return the object for a name such as "file:measured.csv".

        Raises
        ------
        InputError
            If the file does not exist, has another format, or does not match the digest in the
            name.
        """
        file, content = read(name, self.argument)
        try:
            for kind in (kind for first, kind in PACKED.items() if content.startswith(first)):
                raise ValueError(f"packed ({kind}); allowed: CSV or netCDF as it is")
            check_format(DECIMALS[file.decimal], file.encoding)
            return self.create(file, content)
        except ValueError as error:
            problem = str(error).replace("decimal = ','", "decimal=comma after the path")
            raise InputError(self.argument, name, f"{file.path}: {problem}") from None


# Python files


def _imports_of(path: Path) -> tuple[Sources, set[str]]:
    """The files of a folder; and the names of a file and of the files there that it imports."""
    from microslip.foundation.source_digest import Sources  # late, since it imports ast

    sources = Sources(path.parent, "")
    return sources, sources.closure([path.name])


@contextmanager
def _importing_from(path: Path) -> Iterator[None]:
    """Context manager in which the files beside a file can be imported.

    Afterwards, sys.modules is as before: files in two folders can have the same name, and an
    edited file is run again.
    """
    beside = {name.partition("/")[0].removesuffix(".py") for name in _imports_of(path)[1]}

    def pop() -> dict[str, ModuleType]:
        names = [name for name in sys.modules if name.partition(".")[0] in beside]
        return {name: sys.modules.pop(name) for name in names}

    others, writes = pop(), sys.dont_write_bytecode
    sys.path.insert(0, str(path.parent))
    sys.dont_write_bytecode = True
    importlib.invalidate_caches()
    try:
        yield
    finally:
        sys.path.remove(str(path.parent))
        sys.dont_write_bytecode = writes
        pop()
        sys.modules.update(others)


@lru_cache(maxsize=32)
def _class_in(file: NamedFile, base: type) -> type:
    """The subclass of `base` in a Python file.  Raises ImportError unless there is one."""
    path = Path(file.path)
    name = f"microslip_{file.digest}_{path.stem}"
    module = sys.modules[name] = ModuleType(name)
    module.__file__ = str(path)
    try:
        with _importing_from(path):
            exec(compile(path.read_bytes(), path, "exec"), module.__dict__)
    except (Exception, SystemExit) as error:  # a user's code may raise anything
        raise ImportError(f"cannot be imported: {described(error, path)}") from error
    own = [one for one in vars(module).values() if isinstance(one, type)]
    own = [one for one in own if issubclass(one, base) and one.__module__ == name]
    last = [one for one in own if not any(one in other.__mro__[1:] for other in own)]
    if len(last) != 1:
        names = f": {', '.join(one.__name__ for one in last)}" if last else ""
        problem = f"it has {len(last)} subclasses of microslip.{base.__name__}{names}"
        raise ImportError(f"{problem}; allowed is one in a file")
    setattr(last[0], spec.TEXT_NAME, file.name)
    return last[0]


# Both, and the classes of the package


class Family(FileReader[T]):
    """Motions or pressures by their texts.

    Parameters
    ----------
    argument : str
        Name of the argument in messages.
    base : type
        Base class.
    classes : iterable of types
        Classes of the package, in the order in which they are listed to users.
    create : callable
        create(file, content) -> object, for data files; see FileReader.

    Attributes
    ----------
    classes : dict of str to type
        Classes of the package by name.
    """

    def __init__(
        self,
        argument: str,
        base: type[T],
        classes: Iterable[type[T]],
        create: Callable[[NamedFile, bytes], T],
    ):
        super().__init__(argument, create)
        self.base = base
        self.classes = {spec.name_of(one): one for one in classes}

    def __call__(self, text: str) -> T:
        """Return the object for a text such as "power:exponent=1" or "file:measured.csv".

        Raises
        ------
        InputError
            If the name is unknown, if its file cannot be used, or if the class lacks a parameter or
            refuses its value.
        """
        if speaks_of_file(text):
            return super().__call__(text)
        names = [*self.classes, "file:NAME", "NAME.py"]
        if not isinstance(text, str) or text == "file":
            raise InputError(self.argument, text, f"allowed is one of {', '.join(names)}")
        path = ""
        if speaks_of_module(text):
            file, _ = read(text, self.argument)
            path, words, example = file.path, file.numbers, f"{Path(file.path).name}:key=0.5"
            try:
                cls: Any = _class_in(replace(file, numbers=""), cast(type, self.base))
            except ImportError as error:
                raise InputError(self.argument, text, f"{path}: {error}") from error
            numbers = spec.numbers_in(words, text, self.argument, example) if words else {}
        else:
            name, numbers = spec.split(text, self.argument, names)
            cls = self.classes[name]
        spec.refuse_unknown(text, self.argument, numbers, [one.name for one in fields(cls)])
        try:
            return _shared_object(cls, *sorted(numbers.items()))
        except InputError as error:  # its text omits default values
            raise InputError(self.argument, text, error.allowed) from None
        except Exception as error:  # in a user's file
            raise InputError(self.argument, text, f"{path}: {described(error, path)}") from error


@lru_cache(maxsize=128)
def _shared_object(cls: Callable[..., T], *numbers: tuple[str, float]) -> T:
    """Return the object for these numbers.  Equal numbers share one object, including its cached
    properties."""
    return cls(**dict(numbers))
