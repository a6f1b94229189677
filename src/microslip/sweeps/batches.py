"""From a configuration to results: requests, batches of them, and their answers from the store.

A request is a plain dict that says what to compute, with numbers as canonical strings; together
with the digest of the solver it names a result. A job gets a batch of requests and computes those
that the store does not hold, so how points are cut into batches never decides what is computed.
"""

import functools
import importlib.metadata
import logging
import math
import platform
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import NamedTuple

from microslip.config.axes import DRIVES
from microslip.config.extended import solver_names
from microslip.config.records import HISTORIES_OF_SWEEP, Configuration, Sweep
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint, number, sha256
from microslip.foundation.errors import CacheError, SolverError
from microslip.motions.body_contacts import contacts_of, contacts_text
from microslip.sweeps import evaluate
from microslip.sweeps.store import Store, read

log = logging.getLogger(__name__)

RECORD_FORMAT = 1
"""Raised when the content of a record changes without any change in the solver."""

STARTS = ("stress-free", "full-rotation", "full-slip")
"""Initial states of Figure 5."""
FOLDERS = {
    "point": "points",
    "history": "histories",
    "field": "histories",
    "period": "periods",
    "trial": "trials",
    "choice": "trials",
    "probe": "probes",
    "scaling": "scaling",
    "run": "runs",
    "patches": "patches",
    "propulsion": "propulsion_lines",
}
"""Folders of the store by kind of request.  Those of trials and scaling hold measured times."""


class PointRequests:
    """Requests for all points of a records.Sweep, each made when it is asked for.

    The order is that of the dataset: what pulls, Poisson's ratio, amplitude, velocity, the last one
    fastest; a force stands in the place of the velocity.
    """

    def __init__(self, sweep: Sweep):
        motion, pressure = solver_names(sweep)
        self._common: dict = {
            "kind": "point",
            "motion": motion,
            "model": sweep.model,
            "tolerance": None if sweep.tolerance is None else number(sweep.tolerance),
            "cells": sweep.cells,
            "steps": sweep.steps,
        }
        if pressure != "hertz":  # which goes without saying, as it did before there were others
            self._common["pressure"] = pressure
        if sweep.contacts is not None:
            self._common["contacts"] = contacts_text(contacts_of(sweep.contacts))
        amplitudes = [None] if sweep.amplitude is None else [number(a) for a in sweep.amplitude]
        pulls = {name: [number(v) for v in values] for name, values, _ in sweep.drives}
        last: dict[str, list] = {"velocity": [number(velocity) for velocity in sweep.velocity]}
        if not sweep.velocity:
            last = {"force": pulls.pop("force")}
            self._common["velocity"] = None
        rest: dict[str, list] = {
            "poisson": [number(nu) for nu in sweep.poisson],
            "amplitude": amplitudes,
        }
        self._axes = pulls | rest | last

    def __len__(self) -> int:
        return math.prod(map(len, self._axes.values()))

    @property
    def last(self) -> tuple[str, list[str]]:
        """Key and values of the axis that changes fastest."""
        return list(self._axes.items())[-1]

    @property
    def rows(self) -> list[dict]:
        """Requests without the last axis, in their order."""
        *names, _ = self._axes
        values = product(*(self._axes[name] for name in names))
        return [self._common | dict(zip(names, place, strict=True)) for place in values]

    def __iter__(self) -> Iterator[dict]:
        axis, values = self.last
        return (row | {axis: value} for row in self.rows for value in values)


def history_requests(configuration: Configuration, name: str) -> list[dict]:
    """List the requests for the single runs that go into the dataset of the sweep `name`; none for
    one of `extended`."""
    steady = {"motion": "continuous-bore"}
    kinds: dict[str, list[dict]] = {
        "transverse": [{"kind": "history", "motion": "transverse", "start": STARTS[0]}],
        "field": [{"kind": "field"} | steady],
        "transients": [{"kind": "history", "start": start} | steady for start in STARTS],
    }
    counts, found = ("cells", "steps", "periods"), []
    for run in HISTORIES_OF_SWEEP.get(name, ()):
        settings = configuration.histories[run]
        numbers = {k: number(v) for k, v in settings.items() if k not in counts}
        found += [kind | settings | numbers for kind in kinds[run]]
    return found


def key_of(request: dict) -> str:
    """Name of the result that answers a request with the code that is running."""
    return result_key(request, source_digest.of_request(request))


def result_key(request: dict, digest: str) -> str:
    """Name of the result that answers a request with the code that has this digest.

    It is a hash of the physics, the tolerance, the model and resolution asked for, and the digest.
    The versions of NumPy, SciPy and Numba are not part of it: they change results by rounding
    errors, and each result records them.
    """
    content = {"request": request, "source": digest, "format": RECORD_FORMAT}
    return sha256(canonical_json(content))


# Batches: what a job answers


class Batch(NamedTuple):
    """Requests of a job: each row at each value of the axis along it.

    Attributes
    ----------
    rows : list of dict
        Requests without the axis, or whole requests where there is none.
    axis : str
        Key of the axis; empty if there is none.
    values : sequence of str
        Values along it.
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
        """Name that follows from the requests and the code that answers them."""
        code = sorted({source_digest.of_request(row) for row in self.rows})
        return fingerprint(code, self._asdict(), RECORD_FORMAT)[:20]


def batches_of_points(requests: PointRequests, size: int) -> list[Batch]:
    """Batches of whole rows, or of parts of rows longer than a job, in the order of the points.

    size: mean number of points in a batch.
    """
    axis, values = requests.last
    parts = cut(values, size) if len(values) > size else [values]
    blocks = cut(requests.rows, max(size // len(values), 1))
    return [Batch(block, axis, part) for block in blocks for part in parts]


def cut(items: Sequence, mean: int) -> list[list]:
    """Lists of `mean` items on average.

    Each cut depends on the item after it alone, so that an item more changes one list.
    """
    parts: list[list] = []
    for item in items:
        if not parts or mean <= 1 or int(fingerprint(item)[:8], 16) % mean == 0:
            parts.append([])
        parts[-1].append(item)
    return parts


def group(request: dict) -> str:
    """Name the subfolder of the store that a request's result goes to."""
    motion = request["motion"] if "motion" in request else request["model"]
    return "/".join([FOLDERS[request["kind"]], motion.partition(":")[0]])  # numbers apart


def answer(request: dict, store: Store, time_limit: float | None = None) -> tuple[dict, float]:
    """Record that answers a request, and the CPU seconds that the solver took for it.

    It comes from the store if that has it (0 seconds), else it is computed and stored.  A record
    has key, request, result and versions.  A result that is not final, see evaluate.is_final, is
    not stored.  time_limit: of a point, as for microslip.solve.  Raises CacheError if the record
    cannot be stored.
    """
    key = key_of(request)
    record = store.read(group(request), key)
    if record is not None:
        return record, 0.0
    store.try_writing()
    started = time.process_time()
    result = evaluate.computed(request, time_limit)
    seconds = time.process_time() - started
    # Times are left out, so that equal requests have equal records, except where they ask for one.
    record = {"key": key, "request": request, "result": result, "versions": versions()}
    edited = source_digest.LOADED.edited()
    if edited:
        raise SourcesEdited(edited, record)
    if evaluate.is_final(result):
        store.write(group(request), key, record)
    return record, seconds


class SourcesEdited(CacheError):
    """The code on disk is no longer the one that is running.

    A result may then be of either code, so it is not kept under the name of one.

    Attributes
    ----------
    record : dict
        What was computed, by code that was loaded before the edit or after it.
    """

    def __init__(self, file: str, record: dict | None = None):
        super().__init__(file, record)  # as processes hand it on
        self.record = record

    def __str__(self) -> str:
        return (
            f"{self.args[0]} was edited while its code was running, so what it computes is not "
            "kept; run again: finished points are kept"
        )


def run_batch(requests: Sequence[dict], store: Store) -> tuple[list[dict], dict]:
    """Records that answer the requests, and `statistics` of them.

    The records depend on the requests and the solver alone.
    """
    answers = [answer(request, store) for request in requests]
    records = [record for record, _ in answers]
    return records, statistics(records, [took for _, took in answers])


def statistics(records: Sequence[dict], seconds: Sequence[float]) -> dict:
    """Counts, CPU seconds and finality of answers; logs points that did not converge.

    Raises SolverError where the solver failed at all of them.
    """
    results = [record["result"] for record in records]
    for record, result in zip(records, results, strict=True):
        if not result.get("converged", True):
            log.info("not converged: %s: %s", label(record["request"]), result["reason"])
    if records and all(result.get("crashed") for result in results):
        first = f"{label(records[0]['request'])}: {results[0]['reason']}"
        raise SolverError(f"every point of this batch failed ({len(records)}), first {first}")
    counts = {"points": len(records), "computed": sum(took > 0 for took in seconds)}
    final = all(map(evaluate.is_final, results))
    return counts | {"solver_seconds": sum(seconds), "final": final}


def records_in(paths: Iterable[str | Path]) -> Iterator[dict]:
    """Records in the files of batches, one by one in their order; raises CacheError."""
    for path in paths:
        yield from read(path)


def lookup(records: Iterable[dict]) -> Callable[[dict], dict]:
    """A function that finds the record that answers a request among these."""
    found = {record["key"]: record for record in records}
    return lambda request: found[key_of(request)]


def label(request: dict) -> str:
    """Describe a request in a few words, for messages."""
    names = ["pressure", "poisson", "amplitude", "velocity", *DRIVES, "start"]
    if request["kind"] != "point":
        names += ["model", "method", "cells", "angles", "steps"]
    given = ", ".join(f"{name} {request[name]}" for name in names if request.get(name) is not None)
    return f"{request.get('motion', request['kind'])} at {given}"


@functools.cache
def versions() -> dict[str, str]:
    """Versions of Python and of the numerical libraries that compute a result, as a dict."""
    found = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **found}
