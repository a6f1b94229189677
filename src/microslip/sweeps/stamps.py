"""Stamps of products: a fingerprint of the inputs of a dataset, page or figure, and the checksums
of its files.

The files of a product have plain names, which do not change with their content.  The stamp of a
product, `.made/NAME.json` in the folder of results, shows whether its files are up to date.  A job
writes the stamp last.
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
"""Modification time of AGAIN in seconds since 1970; it is in 2001.  Outdated files are dated one
second earlier."""
HDF5 = b"\x89HDF"
"""First bytes of a netCDF file, which is in HDF5 format."""


def stamp_of(product: str) -> str:
    """Path of the stamp of a product inside the folder of results."""
    return f"{FOLDER}/{product}.json"


def write(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> None:
    """Write a stamp; made_of: fingerprint of the inputs, see app.plan."""
    sums = {Path(file).name: _checksum(file) for file in outputs}
    files.write_atomically(Path(stamp), canonical_json({"made_of": made_of, "sums": sums}).encode())


def read(stamp: str | Path) -> dict:
    """Read the content of a stamp, made_of and sums.  The dict is empty if the stamp is missing or
    damaged."""
    try:
        content = json.loads(Path(stamp).read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) and isinstance(content.get("sums"), dict) else {}


def fits(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> bool:
    """True if all outputs exist with the checksums of the stamp, and the stamp has this
    `made_of`."""
    content = read(stamp)
    if content.get("made_of") != made_of:
        return False
    try:
        return content["sums"] == {Path(file).name: _checksum(file) for file in outputs}
    except OSError:
        return False


def is_damaged(dataset: Path) -> bool:
    """True if a netCDF file differs from its stamp.  If there is no stamp, True if the file is not
    in netCDF format.

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

    Such a file is damaged, or it comes from the user, who may still need it.
    """
    for path in map(Path, outputs):
        if path.is_file() and _checksum(path) != _stamped(stamp, path):
            aside = path.with_name(f"{path.name}.damaged")
            os.replace(path, aside)
            log.warning("%s differs from what the workflow made: renamed to %s", path, aside)


def date(paths: Iterable[str | Path], right: bool) -> None:
    """Set the date of outdated files (`right` is False) back to 2001.  For other files, replace a
    date in the future by the current time.

    Snakemake runs a job again if its output file is older than the input AGAIN.  It rejects files
    that are older than an input, even if the input is marked as ancient.
    """
    for path in filter(os.path.exists, paths):
        if not right:
            os.utime(path, (WHEN - 1, WHEN - 1))
        elif os.stat(path).st_mtime > time.time():
            os.utime(path)


def write_again(path: str | Path, dated: bool) -> None:
    """Write the file AGAIN with new content, because Snakemake ignores the date of files with
    unchanged content.

    dated: True to give it the date WHEN.
    """
    files.write_atomically(Path(path), os.urandom(16).hex().encode())
    if dated:
        os.utime(path, (WHEN, WHEN))


def _stamped(stamp: str | Path, path: Path) -> str | None:
    """Checksum of a file according to a stamp; None if the stamp does not contain the file."""
    return read(stamp).get("sums", {}).get(path.name)


def _checksum(file: str | Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
