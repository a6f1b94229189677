"""Files that names speak of, such as "file:pad.csv,grid=samples": what is asked, where the file is.

A result belongs to what a file holds and not to where it lies, so that the name of its pressure has
the digest of the content and no path: "file:sha256=0123456789abcdef,grid=samples".  This process
remembers where it found what; another one is told by `remember`.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NoReturn

from microslip.foundation.errors import InputError

PREFIX = "file:"
GRID = "cells"
"""Default meaning of the values of a grid, see pressures.grid.READINGS."""
DIGITS = 16
MOST_BYTES = 100_000_000
OPTIONS = re.compile(r"(?:^|,)(grid|sha256|decimal|encoding)=([^,]*)$")
DECIMALS = {"point": ".", "comma": ","}
"""Decimal marks by the words that names have for them."""
EXAMPLE = "a file, as in file:measured.csv or file:measured.csv,grid=samples"

_PLACES: dict[str, Path] = {}
"""Digest -> where a file with it was."""


@dataclass(frozen=True)
class NamedFile:
    """A file as given by a name: path, digest and options.

    Attributes
    ----------
    path : str
        As it was given; empty if the digest alone names the file.
    grid : str
        Meaning of the values of the grid, see pressures.grid.READINGS.
    digest : str
        First DIGITS hexadecimal digits of the SHA-256 of its content; empty if it is not known.
    decimal, encoding : str
        A key of DECIMALS, and the encoding of the file.
    """

    path: str
    grid: str = GRID
    digest: str = ""
    decimal: str = "point"
    encoding: str = "utf-8"

    @property
    def name(self) -> str:
        """The name that results have: without the path, equal for equal content."""
        return self._text(f"sha256={self.digest}")

    @property
    def placed(self) -> str:
        """The name with the path and the digest, for a process that has to find the file."""
        return self._text(f"{self.path},sha256={self.digest}")

    def _text(self, file: str) -> str:
        usual = NamedFile("")
        options = {name: getattr(self, name) for name in ("grid", "decimal", "encoding")}
        unusual = [f",{k}={v}" for k, v in options.items() if v != getattr(usual, k)]
        return f"{PREFIX}{file}" + "".join(unusual)


def speaks_of_file(name: object) -> bool:
    """Whether a name is that of a file."""
    return isinstance(name, str) and name.startswith(PREFIX)


def parsed(name: str) -> NamedFile:
    """The NamedFile of a name; raises InputError for a name without a file."""
    path, options = name.removeprefix(PREFIX), {}
    while found := OPTIONS.search(path):
        if found[1] in options:
            raise InputError("pressure", name, f"{found[1]} occurs twice; allowed: once")
        options[found[1]], path = found[2], path[: found.start()]
    digest = options.pop("sha256", "")
    file = NamedFile(path, digest=digest, **options)
    if file.decimal not in DECIMALS:
        raise InputError("pressure", name, "allowed for decimal is point or comma")
    if not (file.path or file.digest) or "\0" in path:
        raise InputError("pressure", name, f"allowed is {EXAMPLE}")
    return file


def found(name: str, folders: Iterable[str | os.PathLike] = ()) -> tuple[NamedFile, bytes]:
    """The file that a name speaks of, with its absolute path and digest, and its content.

    Parameters
    ----------
    name : str
        Such as "file:pad.csv"; a digest in it must be that of the file.
    folders : iterable of paths
        Where a relative path is looked for; the working directory comes after them.

    Raises
    ------
    InputError
        Where there is no such file, or it is not the one that the digest is of; the message says
        where it was looked for.
    """
    file = parsed(name)
    place = _place(name, file, folders)
    content = _read(name, place)
    digest = hashlib.sha256(content).hexdigest()[:DIGITS]
    if file.digest not in ("", digest):
        raise InputError("pressure", name, f"{place} has changed: its sha256 begins with {digest}")
    _PLACES[digest] = place
    return replace(file, path=str(place), digest=digest), content


def remember(names: Iterable[str]) -> None:
    """Note where files are, from names with path and digest; other names do not count."""
    for file in map(parsed, filter(speaks_of_file, names)):
        if file.digest and file.path:
            _PLACES[file.digest] = Path(file.path)


def base_name(name: str) -> str:
    """Base name of the file of a name, for messages; "" if it is not known here."""
    if not speaks_of_file(name):
        return ""
    file = parsed(name)
    return Path(file.path or _PLACES.get(file.digest, "")).name


def _place(name: str, file: NamedFile, folders: Iterable[str | os.PathLike]) -> Path:
    if not file.path:
        if file.digest in _PLACES:
            return _PLACES[file.digest]
        raise InputError(
            "pressure",
            name,
            "no file with this content is known here; allowed is its path, as in file:measured.csv",
        )
    here = Path.cwd()
    # an absolute path stays itself in every folder
    places = list(dict.fromkeys(Path(here, folder, file.path) for folder in (*folders, here)))
    for place in places:
        try:
            if os.path.lexists(place):
                return place
        except OSError:  # a name that the system does not take
            pass
    looked = ", ".join(str(place) for place in places)
    hint = "; allowed after the path: grid=cells or grid=samples" if "," in file.path else ""
    raise InputError(
        "pressure", name, f"{file.path} cannot be read: No such file; looked for {looked}{hint}"
    )


def _read(name: str, place: Path) -> bytes:
    def refuse(why: str | None) -> NoReturn:
        raise InputError("pressure", name, f"{place} cannot be read: {why}") from None

    try:
        if not place.is_file():  # a device or a pipe might never end
            refuse("a folder" if place.is_dir() else "not a regular file")
        if place.stat().st_size > MOST_BYTES:
            refuse(f"larger than {MOST_BYTES / 1e6:g} MB, the most that is allowed")
        return place.read_bytes()
    except OSError as error:
        refuse(error.strerror)
