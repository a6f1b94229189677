"""Batch files and journals.  A batch file contains the records of a batch, and a journal contains
the records that a job has computed so far.

The first line of a batch file contains the name of the file and the names of the rows to which its
requests belong.  Each of the following lines is a record, and the last line is a checksum.  The
file is written atomically.  Batch files also serve as a cache: a job takes records from all
journals in the folder, and from all batch files that contain points of the same rows.  A journal
contains the records that a job has computed so far, so a killed job loses only the point in
progress.

A record is a dict with the keys `key`, `request`, `result` and `versions`.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import logging
import os
import platform
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, suppress
from functools import cache, partial
from itertools import chain
from pathlib import Path

from microslip.foundation import files, source_digest
from microslip.foundation.canonical import canonical_json
from microslip.foundation.errors import CacheError, SolverError
from microslip.sweeps.request import is_settled, key_of, label, row_of

log = logging.getLogger(__name__)

NOT_FINAL = b" not final\n"
"""End of the checksum line if the solver failed at a point or reached its time limit there.  The
next run computes such a point again."""
BETWEEN_FLUSHES = 1.0
"""Seconds between two flushes of a journal to disk.  Flushes limit the loss if the computer
crashes."""


Compute = Callable[[Sequence[dict]], Iterable[tuple[dict, float]]]
"""Type of functions that yield the record and the CPU time of each request."""


class SourcesEdited(CacheError):
    """Error raised if the code on disk differs from the running code.  It would be unclear which
    code computed a result."""

    def __init__(self, file: str):
        problem = f"{file} was edited while its code was running, and its result is not stored"
        super().__init__(f"{problem}; run again: finished points are stored")


# Files


def write(path: str | Path, records: Sequence[dict]) -> None:
    """Write the records of a batch to a file, either all of them or none.  Raises CacheError if the
    file cannot be written."""
    final = all(is_settled(record["result"]) for record in records)
    rows = sorted({row_of(record["request"]) for record in records})
    lines = [canonical_json({"name": Path(path).name, "rows": rows}), *map(canonical_json, records)]
    content = "".join(f"{line}\n" for line in lines).encode()
    files.write_atomically(Path(path), content + _checksum(content, final))


def read(path: str | Path) -> list[dict]:
    """Return the records of a batch file in the order of the file.  Raises CacheError if the file
    is missing or damaged."""
    return [json.loads(line) for line in _checked(path)[0].splitlines()[1:]]


def is_final(path: str | Path) -> bool:
    """Return True if a batch file is undamaged and no copy of another one, and all its records are
    final."""
    with suppress(CacheError):
        content, final = _checked(path)
        name = json.loads(content[: content.index(b"\n")]).get("name", Path(path).name)
        return final and name == Path(path).name
    return False


def records_in(paths: Iterable[str | Path]) -> Iterator[dict]:
    """Iterate over the records in batch files.  Raises CacheError for a damaged file."""
    return chain.from_iterable(map(read, paths))


def lookup(records: Iterable[dict]) -> Callable[[dict], dict]:
    """Return a function that maps a request to its record in `records`."""
    by_key = {record["key"]: record for record in records}
    return lambda request: by_key[key_of(request)]


def _checksum(content: bytes, final: bool) -> bytes:
    return hashlib.sha256(content).hexdigest().encode() + (b"\n" if final else NOT_FINAL)


def _checked(path: str | Path) -> tuple[bytes, bool]:
    """Return the content of a file without its checksum, and whether the records are final.

    Raises CacheError if the file is missing or damaged.
    """
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise CacheError(files.advice("read", path, error)) from error
    end, final = content.rfind(b"\n", 0, -1) + 1, not content.endswith(NOT_FINAL)
    if content[end:] != _checksum(content[:end], final) or not end:
        raise CacheError(f"{path} is damaged; run again: finished points are kept")
    return content[:end], final


class Job(ExitStack):
    """Context manager for a job that writes a batch file.  The journal is closed on exit.

    The job takes records from other batch files and journals in the folder.  The job appends each
    computed record to its own journal.  This journal is removed after its records have been written
    to a batch file.

    Attributes
    ----------
    path : Path
        File of the batch.
    records : dict of str to dict
        Records of the job and final records from the folder, keyed by the name of the result.
    seconds : list of float
        CPU time of each computed record.
    """

    def __init__(self, path: str | Path):
        """path: path of the batch file."""
        super().__init__()
        self.path = Path(path)
        self.records: dict[str, dict] = {}
        self.seconds: list[float] = []
        self._read: set[Path] = set()
        for file in self._glob("*.journal"):
            self._add(_lines_of(file))
        self._journal: int | None = None
        self._flushed = 0.0

    def solve(self, requests: Sequence[dict], compute: Compute | None = None) -> list[dict]:
        """Return the records in the order of the requests.  Only missing records are computed.

        compute: function that yields (record, CPU time) for each request, in any order.  The
        default calls `computed` for the requests one by one.  Raises CacheError if the folder of
        the batch file cannot be written.
        """
        files.refuse_unwritable(self.path.parent)
        for record, took in (compute or partial(map, computed))(self.missing(requests)):
            self.records[record["key"]] = record
            self.seconds.append(took)
            if is_settled(record["result"]):
                self._append(record)
        return [self.records[key_of(request)] for request in requests]

    def missing(self, requests: Sequence[dict]) -> list[dict]:
        """Return the requests that have no record in the folder.  Each request is listed once."""
        self._find(requests)
        by_key = {key_of(request): request for request in requests}
        return [request for key, request in by_key.items() if key not in self.records]

    def finish(self, records: Sequence[dict]) -> dict:
        """Write the given records to the batch file, and remove the journals that this file
        replaces.

        Returns statistics: the number of records, the number of computed records, and the CPU time
        of the computed records.  Points that did not converge are logged.  Raises SolverError if
        the solver failed at all points.
        """
        results = [record["result"] for record in records]
        for record, result in zip(records, results, strict=True):
            if not result.get("converged", True):
                log.info("not converged: %s: %s", label(record["request"]), result["reason"])
        if all(result.get("crashed") for result in results):
            first = f"{label(records[0]['request'])}: {results[0]['reason']}"
            raise SolverError(f"every point of this batch failed ({len(records)}), first {first}")
        write(self.path, records)
        keys = {record["key"] for record in records}
        for file in self._glob("*.journal"):
            if keys.issuperset(self._add(_lines_of(file))):
                with suppress(OSError):
                    file.unlink()
        return {"points": len(records), "computed": len(self.seconds), "seconds": sum(self.seconds)}

    def _glob(self, pattern: str) -> list[Path]:
        return sorted(self.path.parent.glob(pattern))

    def _find(self, requests: Iterable[dict]) -> None:
        """Read the batch files that contain points of the same rows as the requests.  The first
        line of a file lists its rows."""
        rows = {row_of(request) for request in requests}
        for file in set(self._glob("*.jsonl")) - self._read:
            try:
                with open(file, "rb") as lines:
                    if rows.isdisjoint(json.loads(lines.readline())["rows"]):
                        continue
                self._add(read(file))
            except (CacheError, OSError, ValueError, KeyError, TypeError):
                log.warning("%s is damaged: its points are computed again", file)
            self._read.add(file)

    def _add(self, records: Iterable[dict]) -> set[str]:
        """Add all final records among `records`, and return the keys of the added records."""
        final = {r["key"]: r for r in records if is_settled(r["result"])}
        self.records.update(final)
        return set(final)

    def _append(self, record: dict) -> None:
        """Append a record to the journal.  Raises CacheError if the journal cannot be written."""
        path = self.path.with_suffix(f".{uuid.uuid4().hex[:8]}.journal")
        try:
            if self._journal is None:
                self._journal = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
                self.callback(os.close, self._journal)
            os.write(self._journal, f"{canonical_json(record)}\n".encode())
            if time.monotonic() - self._flushed > BETWEEN_FLUSHES:
                os.fsync(self._journal)
                self._flushed = time.monotonic()
        except OSError as error:
            raise CacheError(files.advice("write", path, error)) from error


def _lines_of(journal: Path) -> Iterator[dict]:
    """Yield the records of a journal.  An incomplete line is skipped."""
    with suppress(OSError):
        for line in journal.read_bytes().splitlines():
            with suppress(ValueError):
                yield json.loads(line)


# Results


def computed(request: dict) -> tuple[dict, float]:
    """Compute a request.  Returns the record of the request and the CPU time of the solver in
    seconds.

    The name of the result contains a digest of the code.  Raises SourcesEdited if the digest of the
    imported code has changed during the computation.
    """
    loaded = len(sys.modules)
    from microslip.sweeps import evaluate  # late, since it imports the solver

    started = time.process_time()
    result = evaluate.computed(request)
    seconds = time.process_time() - started
    if len(sys.modules) != loaded and source_digest.is_edited():
        raise SourcesEdited("the solver")
    # Times are omitted so that equal requests have equal records, except in measurements of time.
    key = key_of(request)
    return {"key": key, "request": request, "result": result, "versions": versions()}, seconds


def solve(requests: Sequence[dict], path: str | Path) -> dict:
    """Write the batch file for the requests.  Only records that are missing in the folder are
    computed.

    Returns the statistics of `Job.finish`.  Raises CacheError if the file cannot be written.
    """
    with Job(path) as job:
        return job.finish(job.solve(requests))


@cache
def versions() -> dict[str, str]:
    """Return the versions of Python and of the numerical libraries, keyed by name."""
    libraries = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **libraries}
