"""Requests of a configuration, batches of requests, and the records of their results.

A request is a plain dict of physical and numerical settings, with numbers as canonical strings.  A
result is named by a hash of its request and of the solver's digest.  A job receives a batch of
requests and computes only the results that are missing from the store.  It does not matter which
batch computed the others.
"""

import functools
import importlib.metadata
import logging
import platform
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise, product
from pathlib import Path
from typing import NamedTuple

from microslip.config.axes import DRIVES
from microslip.config.extended import solver_names
from microslip.config.records import HISTORIES_OF_SWEEP, Configuration, Sweep
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint, number, sha256
from microslip.foundation.errors import CacheError, SolverError
from microslip.sweeps import evaluate
from microslip.sweeps.store import Store, read

log = logging.getLogger(__name__)

RECORD_FORMAT = 1
"""Version of the content of records.  Increase it if this content changes without a change of the
solver."""

STARTS = ("stress-free", "full-rotation", "full-slip")
"""Initial states in Figure 5."""
FOLDERS = {
    "point": "points",
    "history": "histories",
    "field": "histories",
    "period": "periods",
    "trial": "trials",
    "choice": "trials",
    "probe": "probes",
    "run": "runs",
    "patches": "patches",
}
"""Folders of the store, keyed by kind of request.  Records of trials contain measured
times."""


# Requests


class Batch(NamedTuple):
    """Requests of a job: each row is combined with each value on an axis.

    Attributes
    ----------
    rows : list of dict
        Requests without the axis, or complete requests if there is no axis.
    axis : str
        Key of the axis; empty if there is no axis.
    values : sequence of str
        Values along the axis.
    """

    rows: list[dict]
    axis: str = ""
    values: Sequence[str] = ()

    @property
    def requests(self) -> list[dict]:
        """All requests, row by row."""
        if not self.axis:
            return self.rows
        return [row | {self.axis: value} for row in self.rows for value in self.values]

    @property
    def name(self) -> str:
        """Hash of the requests and of the code that computes their results."""
        code = sorted({source_digest.of_request(row) for row in self.rows})
        return fingerprint(code, self._asdict(), RECORD_FORMAT)[:20]


def points_of(sweep: Sweep) -> Batch:
    """Return the requests for all points of a sweep.

    The requests are in the order of the dataset's dimensions: drive, Poisson's ratio, amplitude,
    velocity (or force).  The last dimension changes fastest and is the axis of the batch.
    """
    motion, pressure = solver_names(sweep)
    common: dict = {
        "kind": "point",
        "motion": motion,
        "model": sweep.model,
        "tolerance": None if sweep.tolerance is None else number(sweep.tolerance),
        "cells": sweep.cells,
        "steps": sweep.steps,
    }
    if pressure != "hertz":  # omitted if default, so that names of older results remain valid
        common["pressure"] = pressure
    axes: dict[str, list] = {name: [*map(number, values)] for name, values, _ in sweep.drives}
    axes["poisson"] = [*map(number, sweep.poisson)]
    axes["amplitude"] = [None] if sweep.amplitude is None else [*map(number, sweep.amplitude)]
    if sweep.velocity:
        axes["velocity"] = [*map(number, sweep.velocity)]
    else:
        common["velocity"] = None
        axes["force"] = axes.pop("force")  # now the last axis
    *names, last = axes
    places = product(*(axes[name] for name in names))
    rows = [common | dict(zip(names, place, strict=True)) for place in places]
    return Batch(rows, last, axes[last])


def history_requests(configuration: Configuration, name: str) -> list[dict]:
    """Requests for the single runs in the dataset of the sweep `name`; the list is empty for
    extended sweeps."""
    transverse, steady = {"motion": "transverse"}, {"motion": "continuous-bore"}
    kinds: dict[str, list[tuple[str, dict]]] = {
        "transverse": [("history", transverse | {"start": STARTS[0]})],
        "field": [("field", steady)],
        "transients": [("history", steady | {"start": start}) for start in STARTS],
    }
    return [
        evaluate.request_of(kind, **place, **configuration.histories[run])
        for run in HISTORIES_OF_SWEEP.get(name, ())
        for kind, place in kinds[run]
    ]


def divide(points: Batch, size: int) -> list[Batch]:
    """Divide points into batches, in order.  A batch contains whole rows, or parts of long rows.

    size: mean number of points in a batch.
    """
    parts = cut(points.values, size) if len(points.values) > size else [points.values]
    blocks = cut(points.rows, max(size // len(points.values), 1))
    return [Batch(block, points.axis, part) for block in blocks for part in parts]


def cut(items: Sequence, mean: int) -> list[list]:
    """Divide items into lists of consecutive items, with about `mean` items each.

    The lists are equal within an eighth of their length, or within one item.  Inside this margin,
    hashes of the items decide, so that an additional item changes few lists if they are long.
    """
    count = max(round(len(items) / max(mean, 1)), 1)
    margin = len(items) // (16 * count)
    ends = [0]
    for index in range(1, count):
        even = index * len(items) // count
        near = range(even - margin, even + margin + 1)
        ends.append(min(near, key=lambda end: fingerprint(items[end])) if margin else even)
    return [list(items[start:end]) for start, end in pairwise([*ends, len(items)]) if start < end]


# Results


def key_of(request: dict) -> str:
    """Return the name under which a request's result is stored, a hash of the request and the code.

    Results differ by rounding errors between versions of NumPy, SciPy and Numba.  These versions
    are recorded in each result, but they are not part of the name.
    """
    digest = source_digest.of_request(request)
    content = {"request": request, "source": digest, "format": RECORD_FORMAT}
    return sha256(canonical_json(content))


def group(request: dict) -> str:
    """Subfolder of the store for the result of a request."""
    motion = request["motion"] if "motion" in request else request["model"]
    return "/".join([FOLDERS[request["kind"]], motion.partition(":")[0]])  # without numbers


def answer(request: dict, store: Store) -> tuple[dict, float]:
    """Return the record of a request, and the CPU time of the solver in seconds.

    The record is read from the store (0 seconds), or computed and stored.  It has the keys key,
    request, result and versions.  A result that is not final (see evaluate.is_final) is not stored.
    Raises CacheError if the record cannot be stored.
    """
    key = key_of(request)
    record = store.read(group(request), key)
    if record is not None:
        return record, 0.0
    store.try_writing()
    started = time.process_time()
    result = evaluate.computed(request)
    seconds = time.process_time() - started
    # Times are omitted so that equal requests have equal records, except in measurements of time.
    record = {"key": key, "request": request, "result": result, "versions": versions()}
    edited = source_digest.LOADED.edited()
    if edited:
        raise SourcesEdited(edited, record)
    if evaluate.is_final(result):
        store.write(group(request), key, record)
    return record, seconds


class SourcesEdited(CacheError):
    """The code on disk differs from the running code.

    A result could come from either version of the code, so the result is not stored.

    Attributes
    ----------
    record : dict
        The computed record.
    """

    def __init__(self, file: str, record: dict | None = None):
        super().__init__(file, record)  # for pickle
        self.record = record

    def __str__(self) -> str:
        return (
            f"{self.args[0]} was edited while its code was running, so that the result is not "
            "stored; run again: finished points are stored"
        )


def run_batch(requests: Sequence[dict], store: Store) -> tuple[list[dict], dict]:
    """Return the records for the requests, and the statistics of the batch (see `gather`).  The
    records depend only on the requests and the solver."""
    return gather(answer(request, store) for request in requests)


def gather(answers: Iterable[tuple[dict, float]]) -> tuple[list[dict], dict]:
    """Collect records, and compute the statistics of the batch.  The statistics are the number of
    records, the number of computed records, the CPU time, and whether all records are final.

    Points that did not converge are logged.  Raises SolverError if the solver failed at all points.
    """
    records, seconds = map(list, zip(*answers, strict=True))
    results = [record["result"] for record in records]
    for record, result in zip(records, results, strict=True):
        if not result.get("converged", True):
            log.info("not converged: %s: %s", label(record["request"]), result["reason"])
    if all(result.get("crashed") for result in results):
        first = f"{label(records[0]['request'])}: {results[0]['reason']}"
        raise SolverError(f"every point of this batch failed ({len(records)}), first {first}")
    return records, {
        "points": len(records),
        "computed": sum(took > 0 for took in seconds),
        "solver_seconds": sum(seconds),
        "final": all(map(evaluate.is_final, results)),
    }


def records_in(paths: Iterable[str | Path]) -> Iterator[dict]:
    """Iterate over the records in batch files.  Raises CacheError for a damaged file."""
    for path in paths:
        yield from read(path)


def lookup(records: Iterable[dict]) -> Callable[[dict], dict]:
    """Return a function that maps a request to its record in `records`."""
    by_key = {record["key"]: record for record in records}
    return lambda request: by_key[key_of(request)]


def label(request: dict) -> str:
    """Describe a request in a few words, for messages."""
    names = ["pressure", "poisson", "amplitude", "velocity", *DRIVES, "start"]
    if request["kind"] != "point":
        names += ["model", "method", "cells", "angles", "steps"]
    place = ", ".join(f"{name} {request[name]}" for name in names if request.get(name) is not None)
    return f"{request.get('motion', request['kind'])} at {place}"


@functools.cache
def versions() -> dict[str, str]:
    """Versions of Python and of the numerical libraries, by name."""
    libraries = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **libraries}
