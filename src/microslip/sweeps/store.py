"""Store records on disk, in one file for each result or in files with many results.

A file contains records as lines of JSON, followed by their checksum.  Files are written atomically.
A file with a wrong checksum counts as missing.
"""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Iterable
from pathlib import Path

from microslip.foundation import files
from microslip.foundation.canonical import canonical_json
from microslip.foundation.errors import CacheError

log = logging.getLogger(__name__)

NOT_FINAL = b" not final\n"
"""End of the checksum line if at least one record is not final (see evaluate.is_final)."""


def write(path: str | Path, records: Iterable[dict], final: bool = True) -> None:
    """Write all records to a file in one atomic step.  Records are dicts of plain JSON values
    without NaN.

    Raises CacheError if the file cannot be written.
    """
    content = "".join(f"{canonical_json(record)}\n" for record in records).encode()
    checksum = hashlib.sha256(content).hexdigest().encode()
    files.write_atomically(Path(path), content + checksum + (b"\n" if final else NOT_FINAL))


def read(path: str | Path) -> list[dict]:
    """Read the records of a file in their order.  Raises CacheError if the file is missing or
    damaged."""
    content = _checked(path)
    if content is None:
        raise CacheError(f"{path} is damaged; run again: it is made again from finished points")
    return [json.loads(line) for line in content[0].splitlines()]


def is_final(path: str | Path) -> bool:
    """True if a file is undamaged and all its records are final."""
    try:
        content = _checked(path)
    except CacheError:
        return False
    return content is not None and content[1]


def _checked(path: str | Path) -> tuple[bytes, bool] | None:
    """Return a file's lines without the checksum, and whether the records are final.  Return None
    if the file is damaged."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise CacheError(files.advice("read", path, error)) from error
    end = content.rfind(b"\n", 0, -1) + 1
    lines, final = content[:end], not content.endswith(NOT_FINAL)
    checksum = hashlib.sha256(lines).hexdigest().encode() + (b"\n" if final else NOT_FINAL)
    return (lines, final) if content[end:] == checksum else None


class Store:
    """Results in a folder.  Several processes may read and write them at the same time."""

    def __init__(self, folder: str | Path):
        """folder: folder of results.  It is created when the first result is stored."""
        files.refuse_no_folder(folder)
        self.folder = Path(folder)
        self._tried = False

    def path(self, group: str, key: str) -> Path:
        """Path of the result `key`.  group: subfolder for a kind of request and a motion, see
        batches.group."""
        return self.folder / group / key[:2] / f"{key}.json"

    def read(self, group: str, key: str) -> dict | None:
        """Read the record `key`.  Return None if the file is missing or damaged.

        A damaged file is logged.  Raises CacheError if the operating system cannot read the file.
        """
        path = self.path(group, key)
        try:
            content = _checked(path)
        except CacheError as error:
            if isinstance(error.__cause__, FileNotFoundError):
                return None
            raise
        records = [json.loads(line) for line in content[0].splitlines()] if content else []
        if len(records) != 1 or records[0].get("key") != key:
            log.warning("damaged result %s: computed again", path)
            return None
        return records[0]

    def write(self, group: str, key: str, record: dict) -> None:
        """Store `record`.  Raises CacheError if the file cannot be written."""
        write(self.path(group, key), [{**record, "key": key}])

    def try_writing(self) -> None:
        """Raise CacheError if the folder cannot be written to.  The check is made only once, before
        any computation."""
        if not self._tried:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                files.check_room(self.folder)
            except OSError as error:
                raise CacheError(files.advice("write to", self.folder, error)) from error
            self._tried = True
