"""Read files, and write files atomically.  A file is written under a temporary name, flushed to
disk and renamed."""

import os
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from microslip.foundation.errors import NO_WRITING, CacheError

MOST_BYTES = 100_000_000
"""Largest size of a file that is read, in bytes."""
LEAST_ROOM = 65536
"""Free disk space in bytes that a calculation needs to start."""
ABANDONED = 3600.0
"""Age, in seconds, above which a partial file is assumed to be left over from a killed process."""
_PARTIAL: set[Path] = set()
"""Temporary files that this process is writing."""


def content_of(path: str | os.PathLike, most: int = MOST_BYTES) -> bytes:
    """Read the content of a file.  Raises OSError if the file cannot be read.  Raises ValueError if
    the file has more than `most` bytes, or if the file is an endless device."""
    with open(path, "rb") as file:
        content = file.read(most + 1)
    if len(content) > most:
        raise ValueError(f"larger than {most / 1e6:g} MB; allowed: at most that")
    return content


def refuse_unusable(folders: Iterable[str | Path], files: Iterable[str | Path]) -> None:
    """Raise CacheError if the path of a folder is a file, or the path of a file is a folder.

    folders, files: paths that a run will make.  The parent folders of these paths are checked as
    well.
    """
    for folder in map(Path, folders):
        with _advice("use", folder):
            for place in (*reversed(folder.parents), folder):
                if os.path.lexists(place) and not place.is_dir():
                    raise CacheError(f"{place} is not a folder; allowed: a folder, or a new name")
    for file in map(Path, files):
        with _advice("use", file):
            if file.is_dir():
                raise CacheError(f"{file} is a folder; allowed there: a file, or nothing yet")


def write_atomically(path: Path, content: bytes) -> None:
    """Write bytes to a file, either all of them or none.  Raises CacheError if writing fails."""
    with writing_beside(path) as beside:
        beside.write_bytes(content)


@contextmanager
def writing_beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Context manager that yields a temporary Path in the folder of `path`.  At the end, the
    temporary file is renamed to `path`.

    The file is flushed to disk before it is renamed.  After an error or an interrupt, `path` is
    unchanged.  Raises CacheError if the operating system reports an error.
    """
    path = Path(path)
    # no other thread, process or container uses this name
    beside = path.with_name(f".{path.name}.{os.urandom(8).hex()}.part")
    _PARTIAL.add(beside)
    try:
        with _advice("write", path):
            path.parent.mkdir(parents=True, exist_ok=True)
            yield beside
            with open(beside, "rb") as file:
                os.fsync(file.fileno())
            os.replace(beside, path)
    finally:
        with suppress(OSError):  # the temporary file exists only after an error or an interrupt
            beside.unlink()
        _PARTIAL.discard(beside)


def remove_partial() -> None:
    """Remove the temporary files of this process before a signal ends it."""
    for path in list(_PARTIAL):
        with suppress(OSError):
            path.unlink()


def refuse_unwritable(folder: Path) -> None:
    """Create a folder, and raise CacheError if it cannot be written to."""
    with _advice("write to", folder):
        folder.mkdir(parents=True, exist_ok=True)
        check_room(folder)


def check_room(folder: Path) -> None:
    """Write a small temporary file to a folder.  Raises OSError if this fails."""
    import tempfile  # late, since its import takes a while

    with tempfile.TemporaryFile(dir=folder) as file:
        file.write(bytes(LEAST_ROOM))
        file.flush()
        os.fsync(file.fileno())


def clear_abandoned(folder: Path) -> list[Path]:
    """Remove partial files of killed processes, and return the paths of these files.

    Files younger than an hour are not removed, since a process may be writing them.
    """
    removed = []
    for path in Path(folder).rglob(".*.part"):
        with suppress(OSError):
            if time.time() - path.stat().st_mtime > ABANDONED:
                path.unlink()
                removed.append(path)
    return removed


@contextmanager
def _advice(verb: str, path: Path) -> Iterator[None]:
    """Context manager that converts errors of the operating system to CacheError.

    If a disk is full, HDF5 reports "Permission denied" or "HDF error", or raises RuntimeError.
    Therefore, the context manager tries again to write to the folder.  The error of this attempt
    shows the true cause.
    """
    try:
        yield
    except (OSError, RuntimeError) as error:
        if not isinstance(error, OSError) and not str(error).startswith("NetCDF: "):
            raise
        cause: Exception = error
        if verb == "write" and getattr(error, "errno", None) not in NO_WRITING:
            try:
                check_room(path.parent)
            except OSError as other:
                cause = other
        raise CacheError(advice(verb, path, cause)) from error


def advice(verb: str, path: str | Path, error: Exception) -> str:
    """Return the message for an operating system error, with the failed action, the path, the
    reason and the remedy."""
    reason = getattr(error, "strerror", None) or error
    return (
        f"cannot {verb} {path}: {reason}; make room or set permissions there, or choose another "
        "folder for results, and run again: finished points are kept"
    )
