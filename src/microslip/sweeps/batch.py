"""Files with the records of batches, and journals of the jobs that compute them.

A batch file contains the names of the rows of its requests in the first line, then a record in
each line, and a checksum at the end.  It is written in one atomic step.  Batch files are also the
cache: a job takes records from all batch files in the folder that share a row with its batch, and
from all journals.  A journal contains the records that a job has computed so far; a job that is
killed loses only the point in progress.

A record has the keys key, request, result and versions.
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
"""End of the checksum line if the solver failed at a point or reached its time limit.  Such a point
is computed again by the next run."""
BETWEEN_FLUSHES = 1.0
"""Seconds between two flushes of a journal to disk, for a crash of the computer."""


Compute = Callable[[Sequence[dict]], Iterable[tuple[dict, float]]]
"""Function that yields the record and the CPU time of each request."""


class SourcesEdited(CacheError):
    """The code on disk differs from the running code, so that a result could come from either."""

    def __init__(self, file: str):
        problem = f"{file} was edited while its code was running, and its result is not stored"
        super().__init__(f"{problem}; run again: finished points are stored")


# Files


def write(path: str | Path, records: Sequence[dict]) -> None:
    """Write the records of a batch to a file in one atomic step.  Raises CacheError if the file
    cannot be written."""
    final = all(is_settled(record["result"]) for record in records)
    rows = sorted({row_of(record["request"]) for record in records})
    lines = [canonical_json({"rows": rows}), *map(canonical_json, records)]
    content = "".join(f"{line}\n" for line in lines).encode()
    files.write_atomically(Path(path), content + _checksum(content, final))


def read(path: str | Path) -> list[dict]:
    """Read the records of a batch file in their order.  Raises CacheError if the file is missing or
    damaged."""
    content, _ = _checked(path)
    return [json.loads(line) for line in content.splitlines()[1:]]


def is_final(path: str | Path) -> bool:
    """True if a batch file is undamaged and all its records are final."""
    with suppress(CacheError):
        return _checked(path)[1]
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
    """Return the content of a file without the checksum, and whether the records are final.

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
    """A job that writes a batch file: a context manager, which closes the journal.

    It takes records from other batch files and journals in the folder.  It appends each computed
    record to a journal of its own, which stays until its records are in a batch file.

    Attributes
    ----------
    path : Path
        File of the batch.
    records : dict of str to dict
        Records of the job and final records of the folder, by key.
    seconds : list of float
        CPU time of each computed record.
    """

    def __init__(self, path: str | Path):
        """path: file of the batch.  Raises CacheError if its folder cannot be written."""
        super().__init__()
        self.path = Path(path)
        files.refuse_unwritable(self.path.parent)
        self.records: dict[str, dict] = {}
        self.seconds: list[float] = []
        self._read: set[Path] = set()
        for file in self._glob("*.journal"):
            self._add(_lines_of(file))
        self._journal: int | None = None
        self._flushed = 0.0

    def solve(self, requests: Sequence[dict], compute: Compute | None = None) -> list[dict]:
        """Return the records of requests, in their order.  Only missing records are computed.

        compute: function that yields (record, CPU time) of requests, in any order; the default
        calls `computed` for one request after the other.
        """
        self._find(requests)
        keys = [key_of(request) for request in requests]
        missing = dict(zip(keys, requests, strict=True))  # two requests can be equal
        missing = {key: request for key, request in missing.items() if key not in self.records}
        for record, took in (compute or partial(map, computed))(list(missing.values())):
            self.records[record["key"]] = record
            self.seconds.append(took)
            if is_settled(record["result"]):
                self._append(record)
        return [self.records[key] for key in keys]

    def finish(self, records: Sequence[dict]) -> dict:
        """Write the batch file with these records, and remove the journals that it replaces.

        Returns the statistics: the number of records, the number of computed records, and their CPU
        time.  Points that did not converge are logged.  Raises SolverError if the solver failed at
        all points.
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
        statistics = {"points": len(records), "computed": len(self.seconds)}
        return statistics | {"seconds": sum(self.seconds)}

    def _glob(self, pattern: str) -> list[Path]:
        return sorted(self.path.parent.glob(pattern))

    def _find(self, requests: Iterable[dict]) -> None:
        """Read the batch files that share a row with the requests.  The rows are in the first line
        of a file."""
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
        """Add the final ones of these records, and return their keys."""
        final = {r["key"]: r for r in records if is_settled(r["result"])}
        self.records.update(final)
        return set(final)

    def _append(self, record: dict) -> None:
        """Append a record to the journal.  Raises CacheError if it cannot be written."""
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
    """Records of a journal, whose last line can be incomplete."""
    with suppress(OSError):
        for line in journal.read_bytes().splitlines():
            with suppress(ValueError):
                yield json.loads(line)


# Results


def computed(request: dict) -> tuple[dict, float]:
    """Compute a request.  Return its record, and the CPU time of the solver in seconds.

    Raises SourcesEdited if code that was imported during the computation differs from the code that
    names the result.
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
    """Write the batch file of these requests.  Only records that the folder lacks are computed.

    Returns the statistics of `Job.finish`.  Raises CacheError if the file cannot be written.
    """
    with Job(path) as job:
        return job.finish(job.solve(requests))


@cache
def versions() -> dict[str, str]:
    """Versions of Python and of the numerical libraries, by name."""
    libraries = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **libraries}
