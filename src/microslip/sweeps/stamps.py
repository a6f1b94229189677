"""Stamps of products: what a dataset, page or figure was made of, and the checksums of its files.

A product has plain names that do not change with its content, so its stamp, `.made/NAME.json` in
the folder of results, says whether it is the right one.  The stamp is written last.
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
"""Name of a file in the folder of results that is newer than what has to be made again."""
WHEN = 1_000_000_000
"""Date (s since 1970, in 2001) of AGAIN; what has to be made again is dated one second before."""
HDF5 = b"\x89HDF"
"""First bytes of a netCDF file."""


def stamp_of(product: str) -> str:
    """Path of the stamp of a product inside the folder of results."""
    return f"{FOLDER}/{product}.json"


def write(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> None:
    """Write a stamp; made_of: what the outputs were made of, see app.plan."""
    sums = {Path(file).name: _checksum(file) for file in outputs}
    files.write_atomically(Path(stamp), canonical_json({"made_of": made_of, "sums": sums}).encode())


def read(stamp: str | Path) -> dict:
    """Content of a stamp: made_of and sums; empty where there is none or it is damaged."""
    try:
        content = json.loads(Path(stamp).read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) and isinstance(content.get("sums"), dict) else {}


def fits(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> bool:
    """Whether the outputs are there, whole, and made of this."""
    content = read(stamp)
    if content.get("made_of") != made_of:
        return False
    try:
        return content["sums"] == {Path(file).name: _checksum(file) for file in outputs}
    except OSError:
        return False


def is_damaged(dataset: Path) -> bool:
    """Whether a netCDF file differs from its stamp, or without a stamp is no netCDF file.

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
            log.warning("%s differs from what the workflow made: it is kept as %s", path, aside)


def date(paths: Iterable[str | Path], right: bool) -> None:
    """Date files back that have to be made again, and to now what has a date in the future.

    Snakemake makes again what is older than its input AGAIN, and refuses what is older than its
    inputs, ancient or not.
    """
    for path in filter(os.path.exists, paths):
        if not right:
            os.utime(path, (WHEN - 1, WHEN - 1))
        elif os.stat(path).st_mtime > time.time():
            os.utime(path)


def write_again(path: str | Path, dated: bool) -> None:
    """Write the file AGAIN with new content: Snakemake trusts its date only if that differs."""
    files.write_atomically(Path(path), os.urandom(16).hex().encode())
    if dated:
        os.utime(path, (WHEN, WHEN))


def _stamped(stamp: str | Path, path: Path) -> str | None:
    """Checksum of a file according to a stamp; None without one."""
    return read(stamp).get("sums", {}).get(path.name)


def _checksum(file: str | Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
