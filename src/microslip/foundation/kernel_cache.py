"""Folders for code compiled by compiled.py.

Numba checks stored code by the date and size of the function's own file.  It ignores edits of other
files that the function uses.  So the name of the folder contains a digest of all compiled functions
and of the modules that they import.  Each edit changes the name.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

from microslip.foundation import source_digest

FOLDER_NAME = "compiled-"
"""Prefix of the folder names."""


class BySources:
    """Numba cache locator.  It returns the folder and the stamp for a function's compiled code.

    The name of the folder depends on the sources.  So a copy of the package with the same sources
    uses the same compiled code, even if the dates of its files differ.
    """

    def __init__(self, function: Callable):
        self.function = function

    @classmethod
    def from_function(cls, function: Callable, file: str) -> BySources:
        """Create the locator for a function."""
        return cls(function)

    def ensure_cache_path(self) -> None:
        """Make the folder; raises OSError."""
        Path(self.get_cache_path()).mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        """Folder for the compiled code of the function's module."""
        return str(folder() / self.function.__module__)

    def get_source_stamp(self) -> str:
        """A constant stamp, since the folder itself changes with the sources."""
        return ""

    def get_disambiguator(self) -> str:
        """First line number of the function.  It distinguishes functions of the same name."""
        return str(self.function.__code__.co_firstlineno)


def places() -> list[Path]:
    """Possible parent folders, in the order in which they are tried."""
    chosen = [Path(place) for place in [os.environ.get("NUMBA_CACHE_DIR")] if place]
    return [*chosen, source_digest.PACKAGE / "__pycache__", user_cache_path("microslip")]


@cache
def folder() -> Path:
    """Folder for the compiled kernels of the running sources.  It is created if it does not exist.

    The first writable parent is used: NUMBA_CACHE_DIR, the folder of the package, the user's cache
    folder, or a temporary folder.  A temporary folder is reported once on standard error.
    """
    name = FOLDER_NAME + source_digest.LOADED.kernels_digest[:16]
    for place in places():
        if _is_usable(place / name):
            return place / name
    fallback = Path(tempfile.gettempdir(), f"microslip-{_user()}", name)
    if not (_is_usable(fallback) and _is_private(fallback.parent)):
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
    """True if a folder exists or can be made, and files can be written to it."""
    try:
        place.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=place):
            return True
    except OSError:
        return False


def _is_private(place: Path) -> bool:
    """True if a folder belongs to this user, and no other user can write to it."""
    if not hasattr(os, "getuid"):
        return True
    about = place.stat()
    return about.st_uid == os.getuid() and not about.st_mode & 0o022 and not place.is_symlink()


def _user() -> int | str:
    return os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
