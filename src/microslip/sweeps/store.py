"""Records on disk: one file for each result, and files of many.

A file holds records as lines of JSON, then a line with the checksum of all these.  It is written
beside its place, flushed to disk and renamed, so that a reader finds all of it or nothing.  A file
that does not fit its checksum counts as absent.
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
"""How the checksum line ends if equal requests may get other results, see evaluate.is_final."""


def write(path: str | Path, records: Iterable[dict], final: bool = True) -> None:
    """Write records, dicts of plain JSON values without NaN, to a file: all of them or nothing.

    Raises CacheError where the system refuses.
    """
    content = "".join(f"{canonical_json(record)}\n" for record in records).encode()
    checksum = hashlib.sha256(content).hexdigest().encode()
    files.write_atomically(Path(path), content + checksum + (b"\n" if final else NOT_FINAL))


def read(path: str | Path) -> list[dict]:
    """Records of a file in their order; raises CacheError, one line, if it cannot be used."""
    content = _checked(path)
    if content is None:
        raise CacheError(f"{path} is damaged; run again: it is made again from finished points")
    return [json.loads(line) for line in content[0].splitlines()]


def is_final(path: str | Path) -> bool:
    """Whether a file is whole and its records are final; False where there is none."""
    try:
        content = _checked(path)
    except CacheError:
        return False
    return content is not None and content[1]


def _checked(path: str | Path) -> tuple[bytes, bool] | None:
    """Lines of a file without that of the checksum, and whether it is final; None if damaged."""
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise CacheError(files.advice("read", path, error)) from error
    end = content.rfind(b"\n", 0, -1) + 1
    lines, final = content[:end], not content.endswith(NOT_FINAL)
    checksum = hashlib.sha256(lines).hexdigest().encode() + (b"\n" if final else NOT_FINAL)
    return (lines, final) if content[end:] == checksum else None


class Store:
    """Results under one folder.  Several processes may read and write it at the same time."""

    def __init__(self, folder: str | Path):
        """folder: it is made when the first result is written."""
        files.refuse_no_folder(folder)
        self.folder = Path(folder)
        self._tried = False

    def path(self, group: str, key: str) -> Path:
        """Path of the result `key`; group is a subfolder that keeps motions apart."""
        return self.folder / group / key[:2] / f"{key}.json"

    def read(self, group: str, key: str) -> dict | None:
        """The record stored under `key`; None if there is none, or none that is whole.

        A damaged file is reported through logging.  Raises CacheError if reading is not allowed.
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
        """Store `record`; raises CacheError where the system refuses."""
        write(self.path(group, key), [{**record, "key": key}])

    def try_writing(self) -> None:
        """Raise CacheError where nothing can be stored, before work is put into it; tries once."""
        if not self._tried:
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
                files.check_room(self.folder)
            except OSError as error:
                raise CacheError(files.advice("write to", self.folder, error)) from error
            self._tried = True
