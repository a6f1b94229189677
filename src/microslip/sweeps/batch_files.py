"""Batches: the records of a job in one file, one a line, in the order of its requests.

A file is what a job of the workflow declares and what datasets are made of.  Each line is as in the
file of a single result, see microslip.sweeps.cache; the last one is the checksum of all before it.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable
from pathlib import Path

from microslip.sweeps.cache import line_of, record_in
from microslip.sweeps.sealed_files import CacheError, advice, write_atomically

NOT_FINAL = b" not final\n"
"""How the last line of a batch ends whose results need not last."""


def write_batch(path: Path, records: Iterable[dict], final: bool = True) -> None:
    """Write records to the file of a batch, all of them or nothing.

    Each line is as in the file of a single result; the last one is the checksum of all before it.
    final: whether equal requests have these results for ever; the next run makes it again if not.
    Raises CacheError as `writing_beside` does.
    """
    content = b"".join(line_of(record) for record in records)
    write_atomically(path, with_checksum(content, final))


def read_batch(path: Path) -> list[dict] | None:
    """The records in the file of a batch, in their order, a list; None if it is damaged.

    Raises CacheError if there is no such file or reading is not allowed.
    """
    content, _ = _batch_content(path)
    lines = content.splitlines(keepends=True)
    records = [record for record in map(record_in, lines) if record is not None]
    return records if records and len(records) == len(lines) else None


def why_not_whole(path: str | Path) -> str:
    """Why the file of a batch has to be made again, in a few words; "" if it has not.

    Raises CacheError as `read_batch` does.
    """
    content, final = _batch_content(path)
    if not content:
        return "it is damaged"
    return "" if final else "it has points that failed"


class Records:
    """Records in the files of batches, found by their keys wherever they lie.

    The places of all records and the content of one file are in memory, so that memory hardly grows
    with the number of records.  A file is read again only after a record of another one.

    Parameters
    ----------
    paths : iterable of paths
        Files of batches, in any order.

    Raises
    ------
    CacheError
        One line that says what to do, for a file that is damaged.
    """

    def __init__(self, paths: Iterable[str | Path]):
        self._places: dict[str, tuple[str | Path, int, int]] = {}
        self._read: tuple[str | Path | None, bytes] = (None, b"")
        for path in paths:
            content, _ = _batch_content(path)
            if not content:
                raise CacheError(
                    f"{path} is damaged; run again: it is made again from finished points"
                )
            begin = 0
            for line in content.splitlines(keepends=True):
                if match := KEY.match(line):
                    self._places[match[1].decode()] = path, begin, len(line)
                begin += len(line)

    def get(self, key: str) -> dict | None:
        """The record with this key, None if there is none."""
        if key not in self._places:
            return None
        path, begin, length = self._places[key]
        if path != self._read[0]:
            self._read = path, Path(path).read_bytes()
        return json.loads(self._read[1][begin : begin + length])["record"]


KEY = re.compile(rb'{"checksum":"[0-9a-f]{64}","record":{"key":"([0-9a-f]{64})"')
"""How the line of a record begins."""


def with_checksum(content: bytes, final: bool = True) -> bytes:
    """Lines, bytes, and one more that holds their checksum, and whether they are final."""
    checksum = hashlib.sha256(content).hexdigest().encode()
    return content + checksum + (b"\n" if final else NOT_FINAL)


def without_checksum(text: bytes) -> tuple[bytes, bool]:
    """The arguments of `with_checksum`: lines as bytes, empty if damaged, and `final`."""
    end = text.rfind(b"\n", 0, -1) + 1
    final = not text.endswith(NOT_FINAL)
    return (text[:end], final) if with_checksum(text[:end], final) == text else (b"", False)


def _batch_content(path: str | Path) -> tuple[bytes, bool]:
    try:
        return without_checksum(Path(path).read_bytes())
    except OSError as error:
        raise CacheError(advice("read", path, error)) from error
