"""Folders for the compiled code of functions that compiled.py compiles.

Numba looks at the date and size of a function's own file to see if its code on disk is still good.
What the function calls or takes from another file may have changed all the same.  So the code is
kept in a folder that is named by the sources of all compiled functions and of what they import:
after an edit another folder is used, and what is in it was compiled from what is there now.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numba
from platformdirs import user_cache_path

from microslip.foundation import source_digest

FOLDER_NAME = "compiled-"
"""Prefix of the names of these folders."""


@contextmanager
def kept_in(place: Path) -> Iterator[None]:
    """Context in which Numba takes note of where to keep what it will compile."""
    config = numba.config
    before = config.CACHE_DIR, getattr(config, "CACHE_LOCATOR_CLASSES", "")
    # An older Numba that knows no locators of others takes the first alone: it keeps apart then
    # what copies of the package in other places have compiled.
    config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = str(place), f"{__name__}.BySources"
    try:
        yield
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before


class BySources:
    """Tells Numba where a function's compiled code is: what it asks of a cache locator.

    The folder is named by the sources, so no date or size has to be looked at, and a copy of the
    package with the same sources finds the same code.
    """

    def __init__(self, function: Callable):
        self.function = function

    @classmethod
    def from_function(cls, function: Callable, file: str) -> BySources:
        """The locator of a function."""
        return cls(function)

    def ensure_cache_path(self) -> None:
        """Make the folder; raises OSError."""
        Path(self.get_cache_path()).mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        """Folder of the function's module."""
        return str(folder() / self.function.__module__)

    def get_source_stamp(self) -> str:
        """A constant stamp, since the folder itself changes with the sources."""
        return ""

    def get_disambiguator(self) -> str:
        """Tells functions of the same name apart."""
        return str(self.function.__code__.co_firstlineno)


def folder() -> Path:
    """Folder of the code compiled from the sources that are running; it is there after the call.

    The first that can be written to of: the one that NUMBA_CACHE_DIR names, the package's own, the
    user's folder for caches, a temporary one, which is said once.
    """
    if not _found:
        _found.append(_first_usable())
    return _found[0]


_found: list[Path] = []


def places() -> list[Path]:
    """Folders that may hold folders of compiled code, in the order in which they are tried."""
    given = [Path(numba.config.CACHE_DIR)] if numba.config.CACHE_DIR else []
    return [*given, source_digest.PACKAGE / "__pycache__", user_cache_path("microslip")]


def _first_usable() -> Path:
    name = FOLDER_NAME + source_digest.of_kernels()[:16]
    for place in places():
        if _is_usable(place / name):
            return place / name
    fallback = Path(tempfile.gettempdir(), f"microslip-{_user()}", name)
    if not (_is_usable(fallback) and _is_ones_own(fallback.parent)):
        fallback = Path(tempfile.mkdtemp(prefix="microslip-"))
    if "MICROSLIP_SAID_COMPILED" not in os.environ:
        os.environ["MICROSLIP_SAID_COMPILED"] = "1"  # jobs of a run inherit it
        print(
            f"microslip: compiled code is kept in {fallback}, since neither "
            f"{' nor '.join(map(str, places()))} can be written to; NUMBA_CACHE_DIR names another",
            file=sys.stderr,
        )
    return fallback


def _is_usable(place: Path) -> bool:
    """Whether a folder is there, or can be made, and files can be written to it."""
    try:
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=place):
            return True
    except OSError:
        return False


def _is_ones_own(place: Path) -> bool:
    """Whether nobody else can put code into a folder that all users may write beside."""
    if not hasattr(os, "getuid"):
        return True
    about = place.stat()
    return about.st_uid == os.getuid() and not about.st_mode & 0o022 and not place.is_symlink()


def _user() -> int | str:
    return os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
