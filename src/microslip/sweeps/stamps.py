"""Stamps of products: fingerprint of the inputs of a dataset, page or figure, and file checksums.

The files of a product have plain names, which do not change with their content.  Its stamp
`.made/NAME.json` in the folder of results shows whether they are up to date.  A job writes the
stamp last.
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
"""Name of a file in the folder of results that is newer than every outdated file."""
WHEN = 1_000_000_000
"""Date of AGAIN (s since 1970, in 2001).  Outdated files are dated one second before."""
HDF5 = b"\x89HDF"
"""First bytes of a netCDF file."""


def stamp_of(product: str) -> str:
    """Path of the stamp of a product inside the folder of results."""
    return f"{FOLDER}/{product}.json"


def write(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> None:
    """Write a stamp; made_of: fingerprint of the inputs, see app.plan."""
    sums = {Path(file).name: _checksum(file) for file in outputs}
    files.write_atomically(Path(stamp), canonical_json({"made_of": made_of, "sums": sums}).encode())


def read(stamp: str | Path) -> dict:
    """Content of a stamp: made_of and sums; empty if the stamp is missing or damaged."""
    try:
        content = json.loads(Path(stamp).read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) and isinstance(content.get("sums"), dict) else {}


def fits(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> bool:
    """True if all outputs exist with the checksums of the stamp, and were made of `made_of`."""
    content = read(stamp)
    if content.get("made_of") != made_of:
        return False
    try:
        return content["sums"] == {Path(file).name: _checksum(file) for file in outputs}
    except OSError:
        return False


def is_damaged(dataset: Path) -> bool:
    """True if a netCDF file differs from its stamp; without a stamp, if it is no netCDF file.

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
    """Rename the files of a product that differ from its stamp, before a job writes new ones.

    Such a file is damaged, or the user has put it there and may still need it.
    """
    for path in map(Path, outputs):
        if path.is_file() and _checksum(path) != _stamped(stamp, path):
            aside = path.with_name(f"{path.name}.damaged")
            os.replace(path, aside)
            log.warning("%s differs from what the workflow made: renamed to %s", path, aside)


def date(paths: Iterable[str | Path], right: bool) -> None:
    """Date outdated files (not right) back, and set a date in the future to the current time.

    Snakemake runs the job again for a file older than its input AGAIN.  It refuses files that are
    older than an input, even an ancient one.
    """
    for path in filter(os.path.exists, paths):
        if not right:
            os.utime(path, (WHEN - 1, WHEN - 1))
        elif os.stat(path).st_mtime > time.time():
            os.utime(path)


def write_again(path: str | Path, dated: bool) -> None:
    """Write the file AGAIN with new content, since Snakemake ignores the date of unchanged files.

    dated: True to give it the date WHEN.
    """
    files.write_atomically(Path(path), os.urandom(16).hex().encode())
    if dated:
        os.utime(path, (WHEN, WHEN))


def _stamped(stamp: str | Path, path: Path) -> str | None:
    """Checksum of a file according to a stamp; None without one."""
    return read(stamp).get("sums", {}).get(path.name)


def _checksum(file: str | Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
