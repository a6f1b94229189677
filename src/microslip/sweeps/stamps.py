"""Stamps that show whether the files of a product are up to date.

A product is a dataset, page or figure.  Its stamp, `.made/NAME.json` in the folder of results,
contains a fingerprint of the inputs and the checksums of the files.  The names of the files do not
depend on their content.  A job writes the stamp last.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import time
from collections.abc import Iterable
from pathlib import Path

from microslip.foundation import files
from microslip.foundation.canonical import canonical_json
from microslip.foundation.errors import CacheError

log = logging.getLogger(__name__)

FOLDER = ".made"
AGAIN = ".again"
"""Name of a marker file in the folder of results.  The file is newer than every outdated file."""
WHEN = 1_000_000_000
"""Modification time of the marker file in seconds since 1970, a date in 2001.  Outdated files are
dated one second earlier."""
HDF5 = b"\x89HDF"
"""First bytes of a netCDF file, which is in HDF5 format."""


def stamp_of(product: str) -> str:
    """Path of a product's stamp, relative to the folder of results."""
    return f"{FOLDER}/{product}.json"


def write(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> None:
    """Write a stamp.  made_of: fingerprint of the inputs, see app.plan."""
    sums = {Path(file).name: _checksum(file) for file in outputs}
    files.write_atomically(Path(stamp), canonical_json({"made_of": made_of, "sums": sums}).encode())


def read(stamp: str | Path) -> dict:
    """Read a stamp, with the keys `made_of` and `sums`.  The dict is empty if the stamp is missing
    or damaged."""
    try:
        content = json.loads(Path(stamp).read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) and isinstance(content.get("sums"), dict) else {}


def fits(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> bool:
    """True if the stamp has the fingerprint `made_of`, and all outputs exist with the stamp's
    checksums."""
    content = read(stamp)
    if content.get("made_of") != made_of:
        return False
    try:
        return content["sums"] == {Path(file).name: _checksum(file) for file in outputs}
    except OSError:
        return False


def is_damaged(dataset: Path) -> bool:
    """True if the checksum of a netCDF file differs from the stamp.  Without a stamp, True if the
    file is not in netCDF format.

    Raises CacheError if the file cannot be read.
    """
    try:
        checksum = _stamped(dataset.parent / stamp_of(dataset.stem), dataset)
        if checksum is not None:
            return _checksum(dataset) != checksum
        with open(dataset, "rb") as file:
            return file.read(len(HDF5)) != HDF5
    except OSError as error:
        raise CacheError(files.advice("read", dataset, error)) from error


def set_aside(stamp: str | Path, outputs: Iterable[str | Path]) -> None:
    """Rename a product's files if their checksums differ from the stamp, before a job writes new
    files.

    Such a file is damaged, or it was changed by the user and may still be needed.
    """
    for path in map(Path, outputs):
        if path.is_file() and _checksum(path) != _stamped(stamp, path):
            aside = path.with_name(f"{path.name}.damaged")
            os.replace(path, aside)
            log.warning("%s differs from what the workflow made: renamed to %s", path, aside)


def date(paths: Iterable[str | Path], right: bool) -> None:
    """Correct the dates of files.  If `right` is False, the files are outdated and get a date in
    2001.  Otherwise, a date in the future is replaced by the current time.

    Snakemake runs a job again if its output file is older than the marker file.  It also rejects a
    file that is older than one of its inputs, even if this input is marked as ancient.
    """
    for path in filter(os.path.exists, paths):
        if not right:
            os.utime(path, (WHEN - 1, WHEN - 1))
        elif os.stat(path).st_mtime > time.time():
            os.utime(path)


def write_again(path: str | Path, dated: bool) -> None:
    """Write new content to the marker file, because Snakemake ignores the date of files with
    unchanged content.

    dated: True to set the file's date to WHEN.
    """
    files.write_atomically(Path(path), os.urandom(16).hex().encode())
    if dated:
        os.utime(path, (WHEN, WHEN))


def _stamped(stamp: str | Path, path: Path) -> str | None:
    """Checksum of a file according to a stamp.  None if the stamp does not list the file."""
    return read(stamp).get("sums", {}).get(path.name)


def _checksum(file: str | Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
