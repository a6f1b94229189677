"""Files that are whole or not there: written beside their place, flushed to disk and renamed."""

import os
import time
import uuid
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from microslip.foundation.errors import NO_WRITING, CacheError, shown

LEAST_ROOM = 65536
"""Bytes that a disk must still have room for before anything is computed."""
ABANDONED = 3600.0
"""Seconds after which half a file counts as left by a process that was killed."""


def refuse_no_folder(folder: object) -> None:
    """Raise CacheError for what is not the name of a folder: nothing, what is no text, and a ~ that
    no shell has replaced, which would become a folder of that name."""
    path = os.fspath(folder) if isinstance(folder, str | os.PathLike) else ""
    name = path if isinstance(path, str) else ""
    if not name.strip() or "\0" in name:
        raise CacheError(f"{shown(folder)} is not allowed; allowed: the name of a folder")
    if Path(name).parts[:1] == ("~",):
        home = "allowed: the name of a folder, with that of the home folder in place of ~"
        raise CacheError(f"{shown(name)} is not allowed; {home}")


def refuse_unusable(folders: Iterable[str | Path], files: Iterable[str | Path]) -> None:
    """Raise CacheError where a file is in the place of a folder, or a folder in that of a file.

    folders, files: to be made in time, with all folders above them. Makes nothing itself.
    """
    try:
        for folder in map(Path, folders):
            for place in (*reversed(folder.parents), folder):
                if os.path.lexists(place) and not place.is_dir():
                    raise CacheError(f"{place} is not a folder; allowed: a folder, or a new name")
        for file in map(Path, files):
            if file.is_dir():
                raise CacheError(f"{file} is a folder; allowed there: a file, or nothing yet")
    except OSError as error:
        raise CacheError(advice("use", folder, error)) from error


def write_atomically(path: Path, content: bytes) -> None:
    """Write bytes to `path` so that it holds all of them or what it held before.

    Raises CacheError, one line that says what to do, where the system refuses.
    """
    with writing_beside(path) as beside:
        beside.write_bytes(content)


@contextmanager
def writing_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Context that yields a Path beside `path` to write to, and puts it in place at its end.

    The file is flushed to disk before it is renamed.  After an error or an interrupt `path` is what
    it was.  Raises CacheError, one line that says what to do, where the system refuses.
    """
    path = Path(path)
    beside = _unique_beside(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield beside
        with open(beside, "rb") as file:
            os.fsync(file.fileno())
        os.replace(beside, path)
    except OSError as error:
        raise CacheError(advice("write", path, _cause(error, beside))) from error
    except RuntimeError as error:
        # What netCDF says when HDF5 could not write.
        if not str(error).startswith("NetCDF: "):
            raise
        raise CacheError(advice("write", path, _cause(error, beside))) from error
    finally:
        # Gone already after the rename, left by an interrupt; in a read-only folder never made.
        with suppress(OSError):
            beside.unlink()


def _unique_beside(path: Path) -> Path:
    """A name beside a path that no other thread, process or container writes to."""
    return path.with_name(f".{path.name}.{uuid.uuid4().hex[:16]}.part")


def _cause(error: Exception, beside: Path) -> Exception:
    """The error that prevents writing next to a file, if there is one, else the given error.

    HDF5 says "Permission denied" and "HDF error" on a full disk.
    """
    if getattr(error, "errno", None) in NO_WRITING:
        return error
    try:
        check_room(beside.parent)
    except OSError as truth:
        return truth
    return error


def check_room(folder: Path) -> None:
    """Write a small file to a folder and remove it; raises OSError where that is refused."""
    trial = _unique_beside(Path(folder, "room"))
    try:
        with open(trial, "wb") as file:
            file.write(bytes(LEAST_ROOM))
            file.flush()
            os.fsync(file.fileno())
    finally:
        with suppress(OSError):
            trial.unlink()


def clear_abandoned(folder: Path) -> list[Path]:
    """Remove what processes that were killed have left half written; return the paths.

    A file that has been written to within the last hour is left alone: it may be about to be put in
    place.
    """
    found = []
    for path in Path(folder).rglob(".*.part"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > ABANDONED:
                path.unlink()
                found.append(path)
    return found


def advice(verb: str, path: str | Path, error: Exception) -> str:
    """One line: what could not be done, why, and what to do about it."""
    reason = getattr(error, "strerror", None) or error
    return (
        f"cannot {verb} {path}: {reason}; make room or set permissions there, or choose another "
        "folder for results, and run again: finished points are kept"
    )
