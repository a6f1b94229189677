"""Batches: the records of a job in one file, one a line, in the order of its requests.

A file is what a job of the workflow declares and what datasets are made of.  Each line is as in the
file of a single result, see microslip.sweeps.cache; the last one is the checksum of all before it.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from microslip.sweeps.cache import line_of, record_in
from microslip.sweeps.sealed_files import CacheError, advice, write_atomically

NOT_FINAL = b" not final\n"
"""How the last line of a batch ends whose results need not last."""


def write_batch(path, records, final=True):
    """Write records to the file of a batch, all of them or nothing.

    Each line is as in the file of a single result; the last one is the checksum of all before it.
    final: whether equal requests have these results for ever; the next run makes it again if not.
    Raises CacheError as `writing_beside` does.
    """
    content = b"".join(line_of(record) for record in records)
    write_atomically(path, content + _last_line(content, final))


def read_batch(path):
    """The records in the file of a batch, in their order, a list; None if it is damaged.

    Raises CacheError if there is no such file or reading is not allowed.
    """
    content, _ = _batch_content(path)
    records = content and [record_in(line) for line in content.splitlines(keepends=True)]
    return records if records and None not in records else None


def why_not_whole(path):
    """Why the file of a batch has to be made again, in a few words; "" if it has not.

    Raises CacheError as `read_batch` does.
    """
    content, final = _batch_content(path)
    if not content:
        return "it is damaged"
    return "" if final else "it has points that failed"


def _batch_content(path):
    """What a batch holds above its last line, empty if that does not fit; whether it is final."""
    try:
        text = Path(path).read_bytes()
    except OSError as error:
        raise CacheError(advice("read", path, error)) from error
    end = text.rfind(b"\n", 0, -1) + 1
    final = not text.endswith(NOT_FINAL)
    return (text[:end], final) if text[end:] == _last_line(text[:end], final) else (b"", False)


def _last_line(content, final):
    checksum = hashlib.sha256(content).hexdigest().encode()
    return checksum + (b"\n" if final else NOT_FINAL)
