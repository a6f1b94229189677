"""Stamps of products: the inputs of a dataset, page or figure, and the checksums of its files.

The names of a product do not depend on its content.  Its stamp, `.made/NAME.json` in the folder of
results, tells whether it is up to date.  The stamp is written last.
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
"""Name of a file in the folder of results that is newer than all products to be made again."""
WHEN = 1_000_000_000
"""Date of AGAIN, in seconds since 1970; products to be made again are dated one second earlier."""
BEGINNINGS = {".nc": b"\x89HDF", ".png": b"\x89PNG", ".pdf": b"%PDF"}
"""First bytes of an undamaged file, by suffix; checked for files without a stamp."""


def stamp_of(product: str) -> str:
    """Path of the stamp of a product inside the folder of results."""
    return f"{FOLDER}/{product}.json"


def write(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> None:
    """Write a stamp; made_of: inputs of the outputs as a text, see app.plan."""
    sums = {Path(file).name: _checksum(file) for file in outputs}
    files.write_atomically(Path(stamp), canonical_json({"made_of": made_of, "sums": sums}).encode())


def read(stamp: str | Path) -> dict:
    """Content of a stamp, made_of and sums; {} if it is missing or damaged."""
    try:
        content = json.loads(Path(stamp).read_bytes())
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) and isinstance(content.get("sums"), dict) else {}


def fits(stamp: str | Path, made_of: str, outputs: Iterable[str | Path]) -> bool:
    """True if the outputs exist, are undamaged and have these inputs."""
    content = read(stamp)
    if content.get("made_of") != made_of:
        return False
    try:
        return content["sums"] == {Path(file).name: _checksum(file) for file in outputs}
    except OSError:
        return False


def is_damaged(path: str | Path) -> bool:
    """True if a dataset, page or figure differs from its stamp, or without a stamp from its format.

    False for a missing file.  Raises CacheError if the file cannot be read.
    """
    path = Path(path)
    try:
        if not path.exists():
            return False
        checksum = _stamped(path)
        if checksum is not None:
            return _checksum(path) != checksum
        begins = BEGINNINGS.get(path.suffix, b"")
        with open(path, "rb") as file:
            return file.read(len(begins)) != begins
    except OSError as error:
        raise CacheError(files.advice("read", path, error)) from error


def set_aside(outputs: Iterable[str | Path]) -> None:
    """Rename damaged files and files of the user, so that the outputs do not overwrite them."""
    for path in map(Path, outputs):
        if path.is_file() and _checksum(path) != _stamped(path):
            aside = path.with_name(f"{path.name}.damaged")
            os.replace(path, aside)
            log.warning("%s differs from the output of the workflow: renamed to %s", path, aside)


def date(paths: Iterable[str | Path], right: bool) -> None:
    """Set the dates of files for Snakemake, which makes a file again if it is older than AGAIN.

    right: False dates the files before AGAIN; True dates files from the future to now, since
    Snakemake refuses a file that is older than its inputs.
    """
    for path in filter(os.path.exists, paths):
        if not right:
            os.utime(path, (WHEN - 1, WHEN - 1))
        elif os.stat(path).st_mtime > time.time():
            os.utime(path)


def write_again(path: str | Path, dated: bool) -> None:
    """Write the file AGAIN with new content, without which Snakemake ignores its date."""
    files.write_atomically(Path(path), os.urandom(16).hex().encode())
    if dated:
        os.utime(path, (WHEN, WHEN))


def _stamped(path: Path) -> str | None:
    """Checksum of a file in its stamp; None without a stamp."""
    folder, inner = (path.parent, "")
    if path.parent.name in ("figures", "summaries"):
        folder, inner = path.parent.parent, "figures/" * (path.parent.name == "figures")
    if path.suffix == ".html" and folder == path.parent:
        inner = "pages/"
    return read(folder / stamp_of(f"{inner}{path.stem}")).get("sums", {}).get(path.name)


def _checksum(file: str | Path) -> str:
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
