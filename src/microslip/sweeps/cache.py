"""The store of results: one file for each result, found by the hash of what it answers.

A file holds one line of JSON, {"checksum": ..., "record": ...}, written beside its place, flushed
to disk and renamed, so a reader sees all of it or nothing. On reading, the text must be exactly
what its record writes, checksum included; any other file counts as absent and is written anew.
"""

import json
import logging
from pathlib import Path

from microslip.foundation.canonical import canonical_json, sha256
from microslip.sweeps import sealed_files
from microslip.sweeps.sealed_files import CacheError, advice, refuse_no_folder, write_atomically

log = logging.getLogger(__name__)


class Store:
    """Results under one folder. Several processes may read and write it at the same time."""

    def __init__(self, folder: str | Path):
        """folder: str or Path. It is made when the first result is written."""
        refuse_no_folder(folder)
        self.folder = Path(folder)
        self._tried = False

    def path(self, group: str, key: str) -> Path:
        """Path of the result `key`; group is a subfolder that keeps motions apart."""
        return self.folder / group / key[:2] / f"{key}.json"

    def read(self, group: str, key: str) -> dict | None:
        """Return the record (dict) stored under `key`, or None if there is none to be trusted.

        A damaged file is reported through logging. Raises CacheError if reading is not allowed.
        """
        path = self.path(group, key)
        try:
            text = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise CacheError(advice("read", path, error)) from error
        record = record_in(text)
        if record is None or record.get("key") != key:
            log.warning("damaged result %s: computed again", path)
            return None
        return record

    def write(self, group: str, key: str, record: dict) -> Path:
        """Store `record`, a dict of plain JSON values without NaN, and return its path.

        The same key always holds the same answer, so a file that is there is replaced. Raises
        CacheError on a full disk, a read-only folder and the like; no partial file stays behind.
        """
        path = self.path(group, key)
        write_atomically(path, line_of({**record, "key": key}))
        return path

    def try_writing(self) -> None:
        """Raise CacheError where nothing can be stored, before work is put into it; tries once."""
        if self._tried:
            return
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            sealed_files.check_room(self.folder)
        except OSError as error:
            raise CacheError(advice("write to", self.folder, error)) from error
        self._tried = True


def line_of(record: dict) -> bytes:
    """The line, bytes, that holds a record with its checksum."""
    checksum = sha256(canonical_json(record))
    return f"{canonical_json({'checksum': checksum, 'record': record})}\n".encode()


def record_in(text: bytes) -> dict | None:
    """The record in such a line; None if it is anything else than what its record writes."""
    try:
        record = json.loads(text)["record"]
        return record if line_of(record) == text else None
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
