"""File names such as "file:pad.csv,grid=samples", and functions that read these files.

A result depends on the content of a file and not on its path.  So the digest of the content
replaces the path in the name of a pressure or a motion:
"file:sha256=0123456789abcdef,grid=samples".  A process stores the path for each digest.  `remember`
stores paths from another process.

The module imports nothing slow, because each start of the workflow imports the module.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Generic, TypeGuard, TypeVar

from microslip.foundation.csv_table import check_format
from microslip.foundation.errors import InputError
from microslip.foundation.files import MOST_BYTES, content_of

T = TypeVar("T")

PREFIX = "file:"
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
PACKED = {
    b"\x1f\x8b": "gzip",
    b"PK\x03\x04": "zip, as spreadsheets are",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
}
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
    grid : str
        Meaning of the values of the grid, see pressures.grid.READINGS.
    digest : str
        First DIGITS hexadecimal digits of the SHA-256 of the content.  It is empty if unknown.
    decimal, encoding : str
        Decimal mark (a key of DECIMALS) and encoding of the file.
    pitch : str
        Distance between the cells of a matrix of pressures, see pressures.grid_units.read_pitch.
        It is empty for a file with coordinates.
    """

    path: str
    grid: str = GRID
    digest: str = ""
    decimal: str = "point"
    encoding: str = "utf-8"
    pitch: str = ""

    @property
    def name(self) -> str:
        """The name in results.  It contains no path, so that files with equal content have equal
        names."""
        return self._text(f"sha256={self.digest}")

    @property
    def placed(self) -> str:
        """The name with the path and the digest, for another process that reads the file."""
        return self._text(f"{self.path},sha256={self.digest}")

    def _text(self, file: str) -> str:
        usual = NamedFile("")
        options = {name: getattr(self, name) for name in ("grid", "pitch", "decimal", "encoding")}
        unusual = [f",{k}={v}" for k, v in options.items() if v != getattr(usual, k)]
        return f"{PREFIX}{file}" + "".join(unusual)


class FileReader(Generic[T]):
    """Reads objects from files by name.  The most recent objects are stored, so that files with
    equal content share one object.

    Parameters
    ----------
    argument : str
        Name of the argument, for messages.
    create : callable
        create(file, content) -> object.  Raises ValueError for content in another format.
    """

    def __init__(self, argument: str, create: Callable[[NamedFile, bytes], T]):
        self.argument, self.create = argument, create
        self._cache: dict[str, T] = {}

    def __call__(self, name: str) -> T:
        """Return the object for a name such as "file:measured.csv".

        Raises
        ------
        InputError
            If the file does not exist, has another format, or does not match the digest in the
            name.
        """
        file, content = read(name, self.argument)
        if file.name not in self._cache:
            try:
                self._cache[file.name] = self._created(file, content)
            except ValueError as error:
                problem = str(error).replace("decimal = ','", "decimal=comma after the path")
                raise InputError(self.argument, name, f"{file.path}: {problem}") from None
            if len(self._cache) > LARGEST_CACHE:
                del self._cache[next(iter(self._cache))]
        return self._cache[file.name]

    def _created(self, file: NamedFile, content: bytes) -> T:
        for begins, kind in PACKED.items():
            if content.startswith(begins):
                raise ValueError(f"packed ({kind}); allowed: CSV or netCDF as it is")
        check_format(DECIMALS[file.decimal], file.encoding)
        return self.create(file, content)


def speaks_of_file(name: object) -> TypeGuard[str]:
    """True if the name of a pressure or a motion is the name of a file."""
    return isinstance(name, str) and name.startswith(PREFIX)


def parse(name: str, argument: str = "file") -> NamedFile:
    """Parse the name of a file.  Raises InputError about the argument if the name has another
    form."""
    path, options = name.removeprefix(PREFIX), {}
    while match := OPTIONS.search(path):
        if match[1] in options:
            raise InputError(argument, name, f"{match[1]} occurs twice; allowed: once")
        options[match[1]], path = match[2], path[: match.start()]
    digest = options.pop("sha256", "")
    file = NamedFile(path, digest=digest, **options)
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
    place = _place(name, argument, file, folders)
    content = _content(name, argument, place)
    digest = hashlib.sha256(content).hexdigest()[:DIGITS]
    if file.digest not in ("", digest):
        raise InputError(argument, name, f"{place} has changed: its sha256 begins with {digest}")
    PLACES[digest] = place
    return replace(file, path=str(place), digest=digest), content


def remember(names: Iterable[str]) -> None:
    """Store the file paths from names that contain a path and a digest.  Other names are
    ignored."""
    for file in map(parse, filter(speaks_of_file, names)):
        if file.digest and file.path:
            PLACES[file.digest] = Path(file.path)


def base_name(name: str) -> str:
    """Base name of a file, for messages; "" if this process has not stored the path."""
    if not speaks_of_file(name):
        return ""
    file = parse(name)
    return Path(file.path or PLACES.get(file.digest, "")).name


def _place(name: str, argument: str, file: NamedFile, folders: Iterable[str | os.PathLike]) -> Path:
    if not file.path:
        if file.digest in PLACES:
            return PLACES[file.digest]
        raise InputError(
            argument,
            name,
            "no file with this content is known here; allowed is its path, as in file:measured.csv",
        )
    here = Path.cwd()
    # an absolute path is the same in every folder
    places = list(dict.fromkeys(Path(here, folder, file.path) for folder in (*folders, here)))
    for place in places:
        try:
            if os.path.lexists(place):
                return place
        except OSError:  # a name that the system does not accept
            pass
    looked = ", ".join(str(place) for place in places)
    hint = f"; allowed after the path: {HINT}" if "," in file.path else ""
    raise InputError(
        argument, name, f"{file.path} cannot be read: No such file; looked for {looked}{hint}"
    )


def _content(name: str, argument: str, place: Path) -> bytes:
    try:
        if place.is_file():
            return content_of(place, MOST_BYTES)
        reason = "a folder" if place.is_dir() else "not a regular file"  # a pipe might never end
    except OSError as error:
        reason = str(error.strerror)
    except ValueError as error:
        reason = str(error)
    raise InputError(argument, name, f"{place} cannot be read: {reason}") from None
